"""Links in *.md: every relative one leads to a file or folder of the tree, and #anchors to a heading of that file."""
import re

from check import files, main, relative

LINK = re.compile(r"!?\[[^\]\n]*\]\(<?([^)\s>]+)>?(?:\s+\"[^\"]*\")?\)")


def without_code(text):
    text = re.sub(r"^(```|~~~).*?^\1", "", text, flags=re.M | re.S)
    return re.sub(r"`[^`\n]*`", "", text)


def anchors(text):
    """Anchors of headings, as web hosts of git make them."""
    out = set()
    for heading in re.findall(r"^#{1,6}\s+(.*?)\s*$", re.sub(r"^(```|~~~).*?^\1", "", text, flags=re.M | re.S), re.M):
        plain = re.sub(r"[^\w\- ]", "", re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).replace("`", "").lower())
        out.add(plain.replace(" ", "-"))
    return out


def check(root):
    findings = []
    for path in files(root, "*.md"):
        for target in LINK.findall(without_code(path.read_text(encoding="utf-8"))):
            if re.match(r"[a-z]+:", target):
                continue
            place, _, anchor = target.partition("#")
            goal = path if not place else path.parent / place
            if not goal.exists():
                findings.append(f"{relative(path, root)}: link to {target}, which does not exist")
            elif anchor and goal.suffix == ".md" and anchor not in anchors(goal.read_text(encoding="utf-8")):
                findings.append(f"{relative(path, root)}: link to {target}, but there is no such heading")
    return findings


SOUND = {"README.md": "[a](docs/a.md#one-two) [b](https://example.org/x) `[c](nowhere)` [d](docs)\n",
         "docs/a.md": "# One, two\n```\n[x](nowhere)\n```\n[up](../README.md)\n"}
BROKEN = [
    ({"README.md": "see [a](docs/a.md)\n"}, "docs/a.md, which does not exist"),
    ({"README.md": "![picture](docs/a.png)\n"}, "docs/a.png, which does not exist"),
    ({"README.md": "[a](#nowhere)\n# Somewhere\n"}, "no such heading"),
]

if __name__ == "__main__":
    main(check, BROKEN, SOUND)
