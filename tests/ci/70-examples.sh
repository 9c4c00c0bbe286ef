#!/usr/bin/env bash
# Every case below examples/ is listed in examples.txt and does what the list says: it runs to its end and writes its
# report, or it passes calx check. The first fill is also held against first_fill.py.
source "$(dirname "$0")/common.sh"
list=tests/ci/examples.txt
status=0

fail() {
  echo "FAIL $*"
  status=1
}

while read -r file; do
  grep -q '"calx_study"' "$file" && continue  # a study has a row of its own
  grep -qE "^(run|check) $file( |$)" "$list" || fail "$file: not in $list"
done < <(find examples -name '*.json' ! -name '*.plugin.json' ! -path '*.out/*')

# The first plugin a case names that has no folder in plugins/, where any may be deleted; nothing when all are there.
missing_plugin() {
  local id
  for id in $(grep -oE '"(law|plugin|geometry)": *"calx\.[a-z-]+"' "$1" | grep -oE 'calx\.[a-z-]+' | sort -u); do
    grep -q "\"$id\"" plugins/*/*.plugin.json.in || { echo "$id"; return; }
  done
}

while read -r command file options; do
  [[ -z $command || $command == \#* ]] && continue
  missing=$(missing_plugin "$file")
  if [[ -n $missing ]]; then
    echo "== $file is left out: there is no plugin $missing"
    continue
  fi
  echo "== $command $file $options"
  start=$SECONDS
  case $command in
    check)
      # shellcheck disable=SC2086  # options are words
      ./calx.sh check "$file" $options || fail "$file: calx check"
      ;;
    run)
      out=build/examples/$(basename "$file" .json)
      # shellcheck disable=SC2086
      if ./calx.sh run "$file" -o "$out" --overwrite --quiet $options; then
        grep -q '"status": *"done"' "$out/summary.json" || fail "$file: summary.json does not say done"
        [[ -s $out/report.html ]] || fail "$file: no report.html"
        [[ $file != */first_fill.json ]] || python3 tests/ci/first_fill.py "$out" || fail "$file: not as it must be"
      else
        fail "$file: calx run"
      fi
      ;;
    *) fail "$list: $command is neither run nor check" ;;
  esac
  echo "   $((SECONDS - start)) s"
done <"$list"
exit $status
