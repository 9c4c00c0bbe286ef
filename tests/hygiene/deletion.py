"""Any folder of plugins/, and all of them, can be deleted and CMake still configures a copy of the tree.
Takes one configure for each; a build is left out because a plugin is one target of its own."""
import pathlib
import shutil
import subprocess
import sys
import tempfile

from check import files, main, relative

GENERATOR = ["-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release"]


def configure(source, build):
    """The first error of CMake, or None."""
    run = subprocess.run(["cmake", "-S", str(source), "-B", str(build), *GENERATOR], capture_output=True, text=True,
                         check=False)
    if run.returncode == 0:
        return None
    lines = run.stderr.splitlines()
    start = next((k for k, line in enumerate(lines) if line.startswith("CMake Error")), 0)
    return " ".join(line.strip() for line in lines[start:start + 6])


def check(root):
    findings = []
    with tempfile.TemporaryDirectory() as folder:
        source, build, aside = (pathlib.Path(folder, name) for name in ("source", "build", "aside"))
        for path in files(root):
            copy = source / relative(path, root)
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(path, copy)
        problem = configure(source, build)
        if problem:
            return [f"the whole tree does not configure: {problem}"]
        plugins = sorted(path for path in (source / "plugins").iterdir() if path.is_dir())
        aside.mkdir()
        for plugin in plugins:
            shutil.move(plugin, aside / plugin.name)
            problem = configure(source, build)
            if problem:
                findings.append(f"without plugins/{plugin.name}: {problem}")
            shutil.move(aside / plugin.name, plugin)
        for plugin in plugins:
            shutil.move(plugin, aside / plugin.name)
        problem = configure(source, build)
        if problem and not findings:
            findings.append(f"without any plugin: {problem}")
    return findings


TREE = """cmake_minimum_required(VERSION 3.20)
project(small LANGUAGES NONE)
file(GLOB lists CONFIGURE_DEPENDS plugins/*/CMakeLists.txt)
foreach(list ${lists})
  get_filename_component(folder ${list} DIRECTORY)
  add_subdirectory(${folder})
endforeach()
add_custom_target(test_a)
"""
SOUND = {"CMakeLists.txt": TREE + "if(TARGET a)\n  add_dependencies(test_a a)\nendif()\n",
         "plugins/a/CMakeLists.txt": "add_custom_target(a)\n", "plugins/b/CMakeLists.txt": "add_custom_target(b)\n"}
BROKEN = [
    ({**SOUND, "CMakeLists.txt": TREE + "add_dependencies(test_a a)\n"}, "without plugins/a: CMake Error"),
    ({**SOUND, "CMakeLists.txt": "project(\n"}, "the whole tree does not configure"),
]

if __name__ == "__main__":
    if shutil.which("cmake") is None or shutil.which("ninja") is None:
        sys.exit("cmake and ninja are needed")
    main(check, BROKEN, SOUND)
