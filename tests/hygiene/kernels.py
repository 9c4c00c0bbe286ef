"""Hot loops built for more than the plain instruction set: python3 kernels.py OBJECT... A function that the linker may
share with the rest of the program would carry instructions there that a lesser processor lacks, so each object defines
its table and nothing else for others to see."""
import re
import subprocess
import sys


def judge(name, symbols):
    seen = [line.split() for line in symbols.splitlines()]
    shared = [words[0] for words in seen if words[1] not in "tTrRbBdD" or (words[1].isupper() and "kernels_" not in words[0])]
    return [f"{name}: shares {symbol}" for symbol in shared]


def self_test():
    good = judge("a.o", "_ZN4calx10kernels_v4E D 0 8\n_ZL4findv t 0 10\n") == []
    good &= judge("a.o", "_ZN4calx10kernels_v4E D 0 8\n_ZN4calx3dotE W 0 10\n") == ["a.o: shares _ZN4calx3dotE"]
    return good and judge("a.o", "_ZN4calx4openE T 0 10\n") == ["a.o: shares _ZN4calx4openE"]


def main():
    if not self_test():
        sys.exit("the check does not find what it should")
    faults = []
    for name in sys.argv[1:]:
        symbols = subprocess.run(["nm", "--defined-only", "--format=posix", name], capture_output=True, text=True, check=True)
        if not re.search("kernels_", symbols.stdout):
            faults.append(f"{name}: no table of kernels")
        faults += judge(name, symbols.stdout)
    print("\n".join(faults) or f"{len(sys.argv) - 1} objects keep to themselves")
    sys.exit(bool(faults))


main()
