"""check_abi.py ROOT CC: do the headers of the tree keep ABI 1.0?

Compiles layout_v1.c, which asserts the place of every member and the value of every constant; looks whether it has a row
for each member that the reference knows; and lets abidiff compare anchor.c, compiled with the headers, with abi_1_0.xml,
the reference of release 1.0. With --self it does so for copies of the headers with one break each, all of which must be
found. Exit status 77 where abidiff (abigail-tools) is missing.

The reference was written by
    cc -std=c11 -g -shared -fPIC -fvisibility=hidden -I abi/include tests/abi/anchor.c -o anchor.so
    abidw --no-show-locs --no-corpus-path --no-comp-dir-path --type-id-style hash anchor.so > tests/abi/abi_1_0.xml
"""
import pathlib
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as xml

HERE = pathlib.Path(__file__).resolve().parent
REFERENCE = HERE / "abi_1_0.xml"


def run(*command):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False)
    return done.returncode, done.stdout + done.stderr


def layout_findings(include, cc):
    status, text = run(cc, "-std=c11", "-fsyntax-only", "-I", include, HERE / "layout_v1.c")
    return [line for line in text.splitlines() if "error:" in line] if status else []


def rows_missing():
    """Members of the reference without a row in layout_v1.c."""
    rows = (HERE / "layout_v1.c").read_text()
    findings = []
    for struct in xml.parse(REFERENCE).getroot().iter("class-decl"):
        name = struct.get("name")
        for member in struct.iter("var-decl"):
            row = f"AT({name}, {member.get('name')},"
            if not struct.get("is-declaration-only") and row not in rows:
                findings.append(f"layout_v1.c has no row for {name}.{member.get('name')}")
    return findings


def abidiff_findings(include, cc):
    with tempfile.TemporaryDirectory() as folder:
        library = pathlib.Path(folder, "anchor.so")
        status, text = run(cc, "-std=c11", "-g", "-shared", "-fPIC", "-fvisibility=hidden", "-I", include,
                           HERE / "anchor.c", "-o", library)
        if status:
            return [f"anchor.c does not compile: {text}"]
        status, text = run("abidiff", "--no-added-syms", REFERENCE, library)
        # Bits: 1 error, 2 usage, 4 change, 8 incompatible change.
        return [f"abidiff says {status}:\n{text}"] if status else []


# Name, file, text there, what a careless change makes of it, does layout_v1.c see it.
BREAKS = [
    ("a member put into the middle of the descriptor", "abi.h", "  const char* id;   /*",
     "  const char* homepage;\n  const char* id;   /*", True),
    ("two functions of the law's table that trade places", "contact_law.h",
     "  double(CALX_CALL* stable_dt)(const double* pair, double m_eff, double r_eff, double overlap);",
     "", True),
    ("a table of functions that grows", "motion.h",
     "  double(CALX_CALL* top_speed)(const calx_instance* self, double r);\n",
     "  double(CALX_CALL* top_speed)(const calx_instance* self, double r);\n"
     "  double(CALX_CALL* jerk)(const calx_instance* self);\n", True),
    ("a function that takes an int more", "contact_law.h", "(const double* pair, double r_i, double r_j);",
     "(const double* pair, double r_i, double r_j, int wet);", False),
    ("a wider number", "abi.h", "  uint32_t flags;                 /*", "  uint64_t flags;                 /*", True),
    ("a constant with another value", "contact_law.h", "#define CALX_IN_R_EFF 10", "#define CALX_IN_R_EFF 13", True),
]


def self_test(root, cc):
    failures = 0
    for name, header, old, new, seen_by_layout in BREAKS:
        with tempfile.TemporaryDirectory() as folder:
            include = pathlib.Path(folder, "include")
            shutil.copytree(root / "abi" / "include", include)
            path = include / "calx" / header
            text = path.read_text()
            if text.count(old) != 1:
                sys.exit(f"{header} has changed, so \"{name}\" can no longer be tried")
            text = text.replace(old, new)
            if not new:  # the function goes behind the next one
                anchor = "double(CALX_CALL* reach)(const double* pair, double r_i, double r_j);"
                text = text.replace(anchor, anchor + "\n" + old)
            path.write_text(text)
            layout, diff = layout_findings(include, cc), abidiff_findings(include, cc)
            seen_by_diff = "constant" not in name
            good = bool(layout) == seen_by_layout and bool(diff) == seen_by_diff
            failures += not good
            print("ok  " if good else "FAIL", name, *layout[:3], *diff, sep="\n     ")
    return failures


def main():
    if len(sys.argv) not in (3, 4):
        sys.exit(__doc__)
    root, cc = pathlib.Path(sys.argv[1]).resolve(), sys.argv[2]
    if not shutil.which("abidiff"):
        print("abidiff is missing: install abigail-tools")
        sys.exit(77)
    if sys.argv[-1] == "--self":
        sys.exit(1 if self_test(root, cc) else 0)
    include = root / "abi" / "include"
    findings = layout_findings(include, cc) + rows_missing() + abidiff_findings(include, cc)
    print("\n".join(findings) if findings else "ABI 1.0 is kept")
    sys.exit(1 if findings else 0)


if __name__ == "__main__":
    main()
