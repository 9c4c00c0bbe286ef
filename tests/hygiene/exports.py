"""Built plugins: python3 exports.py PLUGIN_FOLDER [--self COMPILER]. A library defines one dynamic symbol, its entry, and
needs nothing but the C and mathematics libraries, so that it loads beside any C++ runtime and hides nothing in a host."""
import pathlib
import subprocess
import sys
import tempfile

ENTRY = "calx_plugin_entry"
LIBRARIES = ("libc.so", "libm.so", "ld-linux", "ld64.so")


def judge(library):
    symbols = subprocess.run(["nm", "-D", "--defined-only", "--format=posix", str(library)], capture_output=True,
                             text=True, check=True).stdout
    names = [line.split()[0] for line in symbols.splitlines()]
    headers = subprocess.run(["objdump", "-p", str(library)], capture_output=True, text=True, check=True).stdout
    needed = [line.split()[1] for line in headers.splitlines() if line.strip().startswith("NEEDED")]
    out = []
    if names != [ENTRY]:
        out.append(f"{library.name}: defines {', '.join(names) or 'nothing'}; expected {ENTRY} alone")
    out += [f"{library.name}: needs {name}" for name in needed if not name.startswith(LIBRARIES)]
    return out


def self_test(compiler):
    cases = [(f"const int {ENTRY} = 1;", [], None),
             (f"const int {ENTRY} = 1; int helper(void) {{ return 1; }}", [], "defines"),
             ("int helper(void) { return 1; }", [], "expected"),
             (f"const int {ENTRY} = 1;", ["-Wl,--no-as-needed", "-lgcc_s"], "needs libgcc_s")]
    good = True
    with tempfile.TemporaryDirectory() as folder:
        for number, (text, flags, words) in enumerate(cases):
            source, library = pathlib.Path(folder, "a.c"), pathlib.Path(folder, f"a{number}.so")
            source.write_text(text + "\n")
            subprocess.run([compiler, "-shared", "-fPIC", "-o", str(library), str(source), *flags], check=True)
            found = judge(library)
            ok = not found if words is None else len(found) == 1 and words in found[0]
            good &= ok
            print("ok  " if ok else "FAIL", "expected:", words or "no finding", "| found:", found)
    return good


if __name__ == "__main__":
    if "--self" in sys.argv:
        sys.exit(0 if self_test(sys.argv[-1]) else 1)
    libraries = sorted(pathlib.Path(sys.argv[1]).glob("*.so"))
    findings = [line for library in libraries for line in judge(library)]
    if not libraries:
        findings = [f"no plugin in {sys.argv[1]}"]
    print("\n".join(findings) if findings else f"{len(libraries)} plugins: one symbol each")
    sys.exit(1 if findings else 0)
