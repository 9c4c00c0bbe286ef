"""check_dialects.py ROOT: compiles the ABI headers in every dialect they promise, with each compiler found.

Table headers: C99, C11, C++98, C++11, C++17, each header alone and all together. Law headers with a law text in both
precisions, and the table macros: C99, C11, C++11, C++17. Warnings are errors; every failure is printed.
"""
import glob
import os
import shutil
import subprocess
import sys
import tempfile

root = sys.argv[1]
include = os.path.join(root, "abi", "include")
headers = sorted(os.path.relpath(h, include) for h in glob.glob(include + "/calx/*.h"))
# Folder and symbol; a plugin may be deleted.
laws = {"hertz_mindlin": "hertz_mindlin", "linear": "linear_spring", "epam": "epam_n15"}
laws = {folder: symbol for folder, symbol in laws.items() if os.path.exists(f"{root}/plugins/{folder}")}

tables = "".join(f"#include <{h}>\n" for h in headers + headers)  # twice: the guards
law = ""
for bits in (32, 64):
    law += f"#undef CALX_BITS\n#define CALX_BITS {bits}\n"
    for header in ("prelude", "sliding", "rolling"):
        law += f"#include <calx/law/{header}.h>\n"
    for folder in laws:
        law += f'#include "{root}/plugins/{folder}/{folder}.law.h"\n'
    law += "#include <calx/law/native.h>\n#include <calx/law/rolling_native.h>\n"
    law += "".join(f"CALX_LAW_BATCH({symbol})\n" for symbol in laws.values())
law += "".join(f"CALX_LAW_TABLES({symbol})\n" for symbol in laws.values())
law += "void fill(calx_contact_law* t);\nvoid fill(calx_contact_law* t) {\n"
law += "".join(f"  CALX_LAW_FILL(*t, {symbol});\n" for symbol in laws.values()) + "}\n"

jobs = [(f"<{h}>", f"#include <{h}>\n", ("c99", "c++98")) for h in headers]
jobs.append(("all table headers", tables, ("c99", "c11", "c++98", "c++11", "c++17")))
jobs.append(("law headers", law, ("c99", "c++11", "c++17")))

compilers = {"c": [c for c in ("gcc", "clang") if shutil.which(c)],
             "c++": [c for c in ("g++", "clang++") if shutil.which(c)]}
if not compilers["c"] or not compilers["c++"]:
    sys.exit("no compiler found")
flags = ["-fsyntax-only", "-pedantic-errors", "-Wall", "-Wextra", "-Wshadow", "-Werror", "-Wno-unused-function",
         "-Wno-unused-const-variable", "-Wno-unused-variable", "-Wno-unknown-warning-option", "-fopenmp-simd", "-I", include]
failed = done = 0
with tempfile.TemporaryDirectory() as folder:
    for name, text, dialects in jobs:
        for dialect in dialects:
            language = "c++" if "++" in dialect else "c"
            path = os.path.join(folder, "probe." + ("cpp" if language == "c++" else "c"))
            with open(path, "w") as file:
                file.write(text + ("int calx_probe(void);\n" if language == "c" else ""))
            for compiler in compilers[language]:
                # C++98 has no <stdint.h> of its own; both compilers provide it, with long long in it.
                extra = ["-Wno-long-long"] if dialect == "c++98" else []
                # A literal of a law must not widen single precision.
                if name == "law headers":
                    extra += ["-Wdouble-promotion", "-Wfloat-conversion"]
                run = subprocess.run([compiler, "-std=" + dialect, *flags, *extra, path], capture_output=True, text=True)
                done += 1
                if run.returncode:
                    failed += 1
                    print(f"{name}, {compiler} -std={dialect}:\n{run.stderr[:3000]}")
print(f"{done} compilations, {failed} failed")
sys.exit(bool(failed))
