"""Text of sources: ASCII, no tabs or trailing blanks, and none of the words that must not stand in the tree."""
import re

from check import files, main, relative

SOURCES = ("*.hpp", "*.cpp", "*.h", "*.c", "*.cmake", "CMakeLists.txt", "CMakePresets.json", "*.py", "*.sh", "*.js",
           "*.css", "*.in", "*.txt")
BUILD = re.compile(r"(^|/)(CMakeLists\.txt|CMakePresets\.json|[^/]+\.(cmake|sh))$")
EVERYWHERE = re.compile("")
# Word, why it may not stand there, files it is looked for in. Words are in parts so that this file does not report itself.
FORBIDDEN = [
    (re.compile("(/hom" "e|/roo" "t|/wor" "k)/[A-Za-z]"), "path of one machine", EVERYWHERE),
    (re.compile(r"\b(TO" r"DO|FIX" r"ME|XX" r"X)\b"), "note to come back later", EVERYWHERE),
    (re.compile("-ff" "ast-math|-Of" "ast|-funsafe" "-math"), "flag that changes values", BUILD),
    (re.compile("-mar" "ch=native"), "flag that ties a build to one machine", BUILD),
]
# This file refuses such flags by name.
EXEMPT = {"abi/cmake/CalxAddPlugin.cmake": "flag that changes values"}


def check(root):
    findings = []
    for path in files(root, *SOURCES):
        name = relative(path, root)
        text = path.read_bytes()
        bad = next((k for k, byte in enumerate(text) if byte > 126 or byte < 32 and byte not in (9, 10)), None)
        if bad is not None:
            line = text[:bad].count(b"\n") + 1
            findings.append(f"{name}:{line}: byte 0x{text[bad]:02x} is not printable ASCII")
            continue
        for number, line in enumerate(text.decode("ascii").split("\n"), 1):
            if line.endswith((" ", "\t")):
                findings.append(f"{name}:{number}: blank at the end of the line")
            if "\t" in line:
                findings.append(f"{name}:{number}: tab")
            for pattern, why, where in FORBIDDEN:
                found = where.search(name) and pattern.search(line)
                if found and EXEMPT.get(name) != why:
                    findings.append(f"{name}:{number}: \"{found[0]}\": {why}")
    return findings


SOUND = {"core/a.cpp": "int a;  // built with -ff" "ast-math\n", "core/CMakeLists.txt": "add_library(a a.cpp)\n",
         "abi/cmake/CalxAddPlugin.cmake": "if(flags MATCHES \"-ff" "ast-math\")\n"}
BROKEN = [
    ({"core/a.cpp": "// 20 \u00b0C\n"}, "core/a.cpp:1: byte 0xc2"),
    ({"core/a.cpp": b"int a;\r\n"}, "byte 0x0d"),
    ({"core/a.cpp": "int a; \n"}, "blank at the end"),
    ({"core/a.cpp": "\tint a;\n"}, "tab"),
    ({"core/a.cpp": "int a;\n// TO" "DO later\n"}, "core/a.cpp:2"),
    ({"CMakeLists.txt": "set(CMAKE_CXX_FLAGS -Of" "ast)\n"}, "changes values"),
    ({"tests/run.sh": "cd /hom" "e/someone/calx\n"}, "path of one machine"),
    ({"CMakeLists.txt": "set(CMAKE_CXX_FLAGS -march" "=native)\n"}, "one machine"),
]

if __name__ == "__main__":
    main(check, BROKEN, SOUND)
