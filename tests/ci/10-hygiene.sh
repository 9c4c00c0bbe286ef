#!/usr/bin/env bash
# Rules of the tree: includes, text, links, layout; each check also proves that it can fail. Needs no build.
source "$(dirname "$0")/common.sh"
export PYTHONDONTWRITEBYTECODE=1
status=0
for check in includes text links format; do
  for mode in "" --self; do
    echo "== $check $mode"
    python3 "tests/hygiene/$check.py" "$root" $mode || { code=$?; [[ $code -eq 77 ]] || status=1; }
  done
done
exit $status
