"""check_vectorised.py COMPILE_COMMANDS SOURCE...: fails when a law's loop over contacts is not vectorised by gcc.

Recompiles each source with the command of the build and -fopt-info-vec, for one of the instruction sets of native.h
(x86-64-v3: 32-byte vectors; all three would take three times as long), and counts the reports at CALX_LAW_BATCH lines:
two loops each, without and with energy outputs. Skips (exit 77) where the compiler is not gcc for x86-64 or the build is
not optimised.
"""
import json
import platform
import re
import shlex
import subprocess
import sys

WANTED = {32: 2}  # reports by vector width

commands = {c["file"]: c for c in json.load(open(sys.argv[1]))}
bad = 0
for source in sys.argv[2:]:
    command = commands[source]
    words = [w for w in shlex.split(command["command"]) if not w.endswith("ccache")]
    words = words[: words.index("-o")] + ["-o", "/dev/null", "-c", source, "-fopt-info-vec", "-DCALX_NO_CLONES", "-march=x86-64-v3"]
    version = subprocess.run([words[0], "--version"], capture_output=True, text=True).stdout
    if "Free Software Foundation" not in version or platform.machine() != "x86_64" or "-O3" not in words or any("fsanitize" in w for w in words):
        print("skipped: needs an optimised gcc build without sanitizers")
        sys.exit(77)
    done = subprocess.run(words, cwd=command["directory"], capture_output=True, text=True)
    if done.returncode:
        sys.exit(done.stderr)
    for number, line in enumerate(open(source), 1):
        law = re.match(r"CALX_LAW_BATCH\((\w+)\)", line)
        if not law:
            continue
        for width, least in WANTED.items():
            found = len(re.findall(rf":{number}:1: optimized: loop vectorized using {width} byte", done.stderr))
            if found < least:
                print(f"{source}:{number}: {law[1]}: {found} of {least} loops vectorised with {width} bytes")
                bad += 1
sys.exit(bool(bad))
