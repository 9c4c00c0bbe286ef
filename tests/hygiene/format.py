"""Layout: clang-format 14 with the .clang-format files of the tree leaves every source as it is. Law texts and the C
headers of the boundary are laid out by hand. Other versions lay out differently: without version 14 this is skipped."""
import concurrent.futures
import os
import pathlib
import shutil
import subprocess
import sys

from check import SKIPPED, files, main, relative

FOLDERS = ("core", "plugins", "hosts", "tests", "abi/cpp")


def formatter():
    for name in ("clang-format-14", "clang-format"):
        if shutil.which(name):
            version = subprocess.run([name, "--version"], capture_output=True, text=True, check=True).stdout
            if "version 14." in version:
                return name
    return None


def wanted(name):
    return name.startswith(tuple(folder + "/" for folder in FOLDERS)) and not name.endswith(".law.h")


def check(root):
    program = formatter()

    def one(path):
        run = subprocess.run([program, "--dry-run", "-Werror", str(path)], capture_output=True, text=True, check=False)
        return None if run.returncode == 0 else f"{relative(path, root)}: run {program} -i on it"

    paths = [path for path in files(root, "*.hpp", "*.cpp", "*.h", "*.c") if wanted(relative(path, root))]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        return [line for line in pool.map(one, paths) if line]


STYLE = (pathlib.Path(__file__).parent / "../../.clang-format").read_text()
SOUND = {".clang-format": STYLE, "core/a.cpp": "int a(int b) { return b; }\n", "core/a.law.h": "int  a ;\n",
         "abi/include/calx/abi.h": "int  a ;\n"}
BROKEN = [
    ({".clang-format": STYLE, "core/a.cpp": "int a( int b ){return b;}\n"}, "core/a.cpp: run clang-format"),
    ({".clang-format": STYLE, "abi/cpp/calx/a.hpp": "int  a;\n"}, "abi/cpp/calx/a.hpp: run clang-format"),
]

if __name__ == "__main__":
    if formatter() is None:
        print("clang-format 14 is not installed")
        sys.exit(SKIPPED)
    main(check, BROKEN, SOUND)
