"""Who includes whom: the #include lines and the DEPENDS lists of core/CMakeLists.txt against the table in
ARCHITECTURE.md, section "Who may include whom", which is read from there so that text and test cannot drift apart."""
import fnmatch
import re

from check import files, main, relative

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')
# Headers of the compiler and of POSIX; everything else that is not C++'s own belongs to the table.
SYSTEM = re.compile(r"^(sys/\w+|unistd|fcntl|dlfcn|signal|poll|xmmintrin|immintrin|stddef|stdint|math|string|stdio|"
                    r"stdlib|float|limits|errno|time|elf)\.h$")


def table(root):
    """{module: (modules it may include, [(library, file pattern)])} from ARCHITECTURE.md."""
    text = (root / "ARCHITECTURE.md").read_text()
    start = text.find("## Who may include whom")
    rows = {}
    for line in text[start:text.find("\n## ", start + 1)].splitlines():
        cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
        name = re.fullmatch(r"`(\w+)`", cells[0])
        if name and len(cells) == 4:
            libraries = []
            for part in cells[3].split(";"):
                words = re.findall(r"`([^`]+)`", part)
                libraries += [(words[0], pattern) for pattern in words[1:]]
            rows[name[1]] = (set(re.findall(r"`(\w+)`", cells[2])), libraries)
    return rows


def module_of(name):
    parts = name.split("/")
    return parts[1] if parts[0] == "core" else parts[0]


def cycle(rows):
    """Modules that can be reached from themselves."""
    def reach(name, seen):
        for other in rows[name][0]:
            if other in rows and other not in seen:
                seen.add(other)
                reach(other, seen)
        return seen
    return sorted(name for name in rows if name in reach(name, set()))


def judge(name, quote, target, rows, siblings):
    """What is wrong with one #include of file `name`, or None."""
    module = module_of(name)
    allowed, libraries = rows[module]
    first = target.split("/")[0]
    for library, pattern in libraries:
        if fnmatch.fnmatch(name.split("/")[-1], pattern) and library in (first, target):
            return None
    if quote == '"' and "/" not in target:
        generated = target.endswith(".inc")
        if module == "core" or not (generated or target in siblings):
            return f"{name}: \"{target}\" is not a file of this folder"
        return None
    if first == "calx":
        return None if module == "abi" or "abi" in allowed else f"{name}: {module} may not include abi ({target})"
    if quote == '"':
        if first == module and module not in ("plugins", "hosts"):
            return None
        if first in allowed and module != "plugins":
            return None
        return f"{name}: {module} may not include {first} ({target})"
    if "/" not in target and "." not in target or SYSTEM.match(target):
        return None
    return f"{name}: <{target}> has no place in this file; see the table of ARCHITECTURE.md"


def check(root):
    rows = table(root)
    if len(rows) < 3:
        return ["ARCHITECTURE.md: no table found in \"Who may include whom\""]
    findings = [f"ARCHITECTURE.md: {name} can reach itself through the table" for name in cycle(rows)]
    for path in files(root, "*.hpp", "*.cpp", "*.h", "*.c"):
        name = relative(path, root)
        if name.split("/")[0] not in ("abi", "core", "plugins", "hosts"):
            continue
        if module_of(name) not in rows:
            findings.append(f"{name}: module {module_of(name)} is not in the table of ARCHITECTURE.md")
            continue
        siblings = {other.name for other in path.parent.iterdir()}
        for line in path.read_text(encoding="utf-8", errors="replace").splitlines():
            found = INCLUDE.match(line)
            problem = found and judge(name, found[1], found[2], rows, siblings)
            if problem:
                findings.append(problem)
    lists = root / "core/CMakeLists.txt"
    if lists.exists():
        for name, depends in re.findall(r"^calx_module\((\w+) DEPENDS ([\w\s]+?)(?:LINKS|\))", lists.read_text(), re.M):
            if name in rows:
                findings += [f"core/CMakeLists.txt: {name} may not depend on {other}; see the table of ARCHITECTURE.md"
                             for other in depends.split() if other not in rows[name][0]]
    return findings


TABLE = """## Who may include whom
| module | holds | may include | other libraries |
|---|---|---|---|
| `abi` | the boundary | | |
| `base` | errors | `abi` | `spdlog` in `log.cpp` |
| `store` | columns | `base` | |
| `plugins` | laws | `abi` | |
| `hosts` | programs | `store` | |
## Next
"""
SOUND = {
    "ARCHITECTURE.md": TABLE,
    "core/CMakeLists.txt": "calx_module(store DEPENDS base LINKS x)\n",
    "core/base/log.cpp": '#include <spdlog/logger.h>\n#include <string>\n#include "base/log.hpp"\n',
    "core/store/a.cpp": '#include "base/log.hpp"\n#include <sys/stat.h>\n',
    "plugins/p/p.cpp": '#include <calx/plugin.hpp>\n#include "p.law.h"\n#include "p.law.h.inc"\n',
    "plugins/p/p.law.h": "#include <math.h>\n",
}


def with_file(name, text):
    return {**SOUND, name: text}


BROKEN = [
    (with_file("core/base/a.hpp", '#include "store/a.hpp"\n'), "base may not include store"),
    (with_file("core/store/a.cpp", "#include <spdlog/logger.h>\n"), "<spdlog/logger.h> has no place"),
    (with_file("core/store/a.cpp", "# include <calx/abi.h>\n"), "store may not include abi"),
    (with_file("plugins/p/p.cpp", '#include "base/log.hpp"\n'), "plugins may not include base"),
    (with_file("plugins/p/p.cpp", '#include "../q/q.hpp"\n'), "plugins may not include .."),
    (with_file("plugins/p/p.cpp", '#include "elsewhere.hpp"\n'), "is not a file of this folder"),
    (with_file("abi/include/calx/abi.h", "#include <boost/any.hpp>\n"), "<boost/any.hpp> has no place"),
    (with_file("core/extra/a.cpp", "\n"), "module extra is not in the table"),
    (with_file("core/CMakeLists.txt", "calx_module(base DEPENDS store)\n"), "base may not depend on store"),
    (with_file("ARCHITECTURE.md", ""), "no table found"),
    (with_file("ARCHITECTURE.md", TABLE.replace("the boundary | |", "the boundary | `abi` |")), "abi can reach itself"),
]

if __name__ == "__main__":
    main(check, BROKEN, SOUND)
