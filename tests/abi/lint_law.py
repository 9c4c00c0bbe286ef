"""lint_law.py FILE...: checks law texts against dialect 1 (ABI.md section 4); exit 1 if anything is found.

lint_law.py --expect FILE: succeeds only when the lines reported are exactly those whose comment holds BROKEN.
"""
import os
import re
import sys

FORBIDDEN = set(
    """if else while for do switch case goto return break continue static extern volatile register auto union enum asm
    sizeof inline float double long short char int unsigned signed bool size_t printf malloc pow sqrt sqrtf fabs fabsf
    fmin fmax exp log sin cos tan""".split()
)
LIMIT = 64 * 1024


def blank(text):
    """Comments and strings as blanks of equal height, so that line numbers hold."""
    return re.sub(r'/\*.*?\*/|"(\\.|[^"\\\n])*"', lambda m: re.sub(r"[^\n]", " ", m.group()), text, flags=re.S)


def check(path):
    raw = open(path, "rb").read()
    found = set()
    if len(raw) > LIMIT:
        found.add((1, f"{len(raw)} bytes; a law text has at most {LIMIT}"))
    for number, line in enumerate(raw.split(b"\n"), 1):
        if any(byte > 126 or (byte < 32 and byte != 9) for byte in line):
            found.add((number, "not ASCII"))
    text = raw.decode("latin-1")
    code = blank(text)
    # Every name the text defines begins with the file's stem, as do its symbols; the shared texts of the ABI use calx_.
    symbols = re.findall(r"CALX_(?:LAW|FORCE)_DECLARE\w*\((\w+)", code)
    stem = re.sub(r"\.law\.h$", "", os.path.basename(path))
    stems = (stem,) if symbols else ("calx_", "CALX_")
    for symbol in symbols:
        if not symbol.startswith(stem):
            found.add((1, f"{symbol}: a symbol begins with the file's stem, {stem}"))
    defining = re.compile(r"#\s*define\s+(\w+)|CALX_FN\s+\w+\s+(?:CALX_ID\()?(\w+)|typedef\s+struct\s+(?:CALX_ID\()?(\w+)")
    for number, line in enumerate(code.split("\n"), 1):
        for match in defining.finditer(line):
            name = next(group for group in match.groups() if group)
            if not name.startswith(stems):
                found.add((number, f"{name}: a name the law defines begins with {stems[0]}"))
        if re.match(r"\s*#\s*(?!define\b)", line):
            found.add((number, "only #define is allowed"))
        for word in re.findall(r"[A-Za-z_]\w*", line):
            if word in FORBIDDEN:
                found.add((number, f"{word} is not in the dialect"))
            if "__" in word:
                found.add((number, f"{word}: two underscores belong to the compiler"))
        if "//" in line:
            found.add((number, "comments are /* */"))
        if "[" in line or "]" in line:
            found.add((number, "no array and no index"))
        if re.search(r"\((?:const )?(?:real|void)\s*\*?\)", line):
            found.add((number, "no cast"))
        if "++" in line or "--" in line:
            found.add((number, "no ++ and no --"))
        arithmetic = re.sub(r"\bX\(.*", "", line)  # list rows hold plain numbers
        for literal in re.finditer(r"(?<![\w.])(\d+\.\d*(?:[eE][-+]?\d+)?|\.\d+|\d+[eE][-+]?\d+)\w*", arithmetic):
            if not re.search(r"R\(\s*-?$", arithmetic[: literal.start()]):
                found.add((number, f"bare literal {literal.group()}: write R({literal.group()})"))
    if symbols and len(re.findall(r"CALX_(?:LAW|FORCE)_EVAL\(", code)) != len(symbols):
        found.add((1, "each declared symbol needs one CALX_LAW_EVAL or CALX_FORCE_EVAL"))
    forces = re.findall(r"CALX_FORCE_DECLARE\((\w+)", code)
    for symbol in symbols:
        for part in ("row_LIST",) if symbol in forces else ("pair_LIST", "prop_LIST", "state_LIST", "NEEDS"):
            if not re.search(rf"#\s*define\s+{symbol}_{part}\b", code):
                found.add((1, f"{symbol}_{part} is not defined"))
    return sorted(found)


def main():
    expect = sys.argv[1] == "--expect"
    failed = False
    for path in sys.argv[2 if expect else 1 :]:
        found = check(path)
        for number, what in found:
            print(f"{path}:{number}: {what}")
        if expect:
            wanted = {n for n, line in enumerate(open(path), 1) if "BROKEN" in line}
            got = {n for n, _ in found}
            for n in sorted(wanted ^ got):
                print(f"{path}:{n}: {'not reported' if n in wanted else 'reported without need'}")
            failed = failed or wanted != got or not wanted
        else:
            failed = failed or bool(found)
    sys.exit(failed)


main()
