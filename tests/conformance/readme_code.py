"""readme_code.py SOURCE CALX: the code blocks of abi/README.md and abi/kinds.md cannot drift from what is built and run: lines of
c and cpp blocks stand, in that order, in one source of the example laws, of the templates or of readme/, which other tests build; json is
the example's manifest; every calx command and option of sh blocks is known."""
import json
import pathlib
import re
import subprocess
import sys

SOURCE, CALX = pathlib.Path(sys.argv[1]), sys.argv[2]


def blocks(path):
    for match in re.finditer(r"^```(\w+)\n(.*?)^```", path.read_text(), re.S | re.M):
        yield path.name, match[1], match[2]


def squeezed(line):
    return re.sub(r"\s+", " ", line.rstrip("\\ \n")).strip()


def built():
    for folder in ("examples/third_party_law", "examples/third_party_hertz", "abi/template", "tests/conformance/readme"):
        for path in sorted((SOURCE / folder).rglob("*")):
            if path.suffix in (".c", ".h", ".cpp", ".hpp"):
                yield [squeezed(line) for line in path.read_text().splitlines()]


def stands(text, sources):
    wanted = [squeezed(line) for line in text.splitlines() if squeezed(line) not in ("", "...")]
    for source in sources:
        rest = iter(source)
        if all(any(line == have for have in rest) for line in wanted):
            return True
    return False


def options(command):
    run = subprocess.run([CALX, *command, "--help"], capture_output=True, text=True, check=False)
    return run.stdout if run.returncode == 0 else None


def shell_faults(text):
    for line in text.splitlines():
        words = line.split("#")[0].split()
        if words[:1] != ["calx"]:
            continue
        command = words[1:3] if words[1] == "plugin" else words[1:2]
        known = options(command)
        if known is None:
            yield f"{line}: no such command"
            continue
        for word in words[2:]:
            if word.startswith("-") and not re.search(rf"(^|[\s,]){re.escape(word.split('=')[0])}\b", known):
                yield f"{line}: no option {word}"


def faults(name, language, text, sources):
    if language in ("c", "cpp"):
        if not stands(text, sources):
            yield f"{name}: the block that begins with {text.splitlines()[0]!r} stands in no source that is built"
    elif language == "json":
        example = json.loads((SOURCE / "examples/third_party_law/spring.plugin.json.in").read_text())
        if text.startswith('"'):  # a piece of a manifest or a case
            json.loads("{" + text + "}")
        elif json.loads(text) != example:
            yield f"{name}: the manifest is not that of examples/third_party_law"
    elif language == "jsonc":
        json.loads("{" + re.sub(r"//.*", "", text) + "}")
    elif language == "sh":
        yield from (f"{name}: {fault}" for fault in shell_faults(text))
    else:
        yield f"{name}: nobody tests blocks of {language}"


def main():
    sources = list(built())
    # Test of the test: a line that nobody wrote, an option that is not there.
    assert not stands("#define spring_pair_LIST(X)\nint nothing;\n", sources)
    assert list(shell_faults("calx plugin list --no-such\n")) and not list(shell_faults("calx plugin list\n"))
    found = [fault for page in ("README.md", "kinds.md") for block in blocks(SOURCE / "abi" / page)
             for fault in faults(*block, sources)]
    count = sum(1 for page in ("README.md", "kinds.md") for _ in blocks(SOURCE / "abi" / page))
    assert count >= 8, count
    print("\n".join(found) or f"{count} blocks")
    sys.exit(1 if found else 0)


main()
