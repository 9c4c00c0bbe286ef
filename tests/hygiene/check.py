"""check.py: what every hygiene check shares: the files of the tree, and the test of the test.

A check is a function of the tree's root that returns one line per finding. A program runs it as
    python3 CHECK.py ROOT           exit status 1 and the findings, if there are any
    python3 CHECK.py ROOT --self    runs it on small trees with one defect each, which it must report, and on a sound one
"""
import pathlib
import subprocess
import sys
import tempfile

SKIP = {"build", "out", ".git", "__pycache__", ".library"}
SKIPPED = 77  # exit status that ctest shows as "Skipped"


def files(root, *patterns):
    """Files below root that git would see, sorted; patterns as in Path.match."""
    root = pathlib.Path(root)
    if (root / ".git").exists():
        listed = subprocess.run(["git", "-C", str(root), "ls-files", "-co", "--exclude-standard", "-z"],
                                capture_output=True, text=True, check=True).stdout.split("\0")
        found = [root / name for name in listed if name and (root / name).is_file()]
    else:
        found = [path for path in root.rglob("*")
                 if path.is_file() and not SKIP & set(path.relative_to(root).parts)]
    return sorted(path for path in found if not patterns or any(path.match(pattern) for pattern in patterns))


def relative(path, root):
    return path.relative_to(root).as_posix()


def main(check, broken, sound):
    """broken: list of (tree, words the finding must hold); a tree maps file names to text or bytes. sound: a tree."""
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    if sys.argv[-1] != "--self":
        findings = check(pathlib.Path(sys.argv[1]).resolve())
        print("\n".join(findings) if findings else "nothing found")
        sys.exit(1 if findings else 0)
    failures = 0
    for tree, words in [*broken, (sound, None)]:
        with tempfile.TemporaryDirectory() as folder:
            for name, content in tree.items():
                path = pathlib.Path(folder, name)
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_bytes(content if isinstance(content, bytes) else content.encode())
            findings = check(pathlib.Path(folder).resolve())
        good = not findings if words is None else len(findings) == 1 and words in findings[0]
        failures += not good
        print("ok  " if good else "FAIL", "expected:", words or "no finding", "| found:", findings)
    sys.exit(1 if failures else 0)
