"""Plugins that are missing, built for another Calx, or fail: exit code 4, and which plugin, where and why."""
import os
import re
import shutil
import subprocess
import unittest

from calx import EPAM, PLUGIN, PLUGINS, SOURCE, CalxTest, cup, needs

MANIFEST = """{"calx_plugin": 1, "library": "lib.so", "abi": {"major": 1, "minor": 0}, "version": "1.0.0",
 "vendor": "test", "license": "MIT", "requires": [],
 "plugins": [{"id": "test.force", "kind": "calx.particle-force/1", "summary": "A force for tests."}]}"""


def build_force(folder, macros):
    """A particle force "test.force" in a folder of its own; macros: what it does wrong, as C text before the body."""
    folder.mkdir(exist_ok=True)
    text = '#define BAD_ID "test.force"\n' + macros + '\n#include "bad_plugin.h"\n'
    (folder / "force.c").write_text(text)
    subprocess.run([os.environ["CC"], "-std=c99", "-O1", "-shared", "-fPIC", f"-I{SOURCE}/abi/include",
                    f"-I{SOURCE}/tests/bad_plugins", "force.c", "-o", "lib.so", "-lm"], cwd=folder, check=True)
    (folder / "lib.plugin.json").write_text(MANIFEST)
    return folder


class BadPlugin(CalxTest):
    def with_force(self, macros):
        build_force(self.dir / "mine", macros)
        return self.write(cup({"/forces": [{"plugin": "test.force"}]}))

    def refuses_force(self, macros, *texts):
        path = self.with_force(macros)
        words = (path.name, "--plugin-path", "mine")
        line = self.fails(PLUGIN, r"case\.json /forces/0", r"test\.force", *texts, result=self.calx("check", *words))
        self.assertEqual(line, self.fails(PLUGIN, result=self.calx("run", *words)))
        self.assertFalse((self.dir / "case.out").exists())
        return line

    def copied(self, *left_out):
        """The build's plugins in a folder of the test, without some files."""
        folder = self.dir / "plugins"
        folder.mkdir()
        for path in PLUGINS.iterdir():
            if path.is_file() and path.name not in left_out:
                shutil.copy(path, folder)
        return folder

    def test_missing(self):
        line = self.refuses(PLUGIN, cup({"/contacts/0/law": "calx.hertz-midlin"}), r"case\.json /contacts/0",
                            "no plugin calx.hertz-midlin", r'did you mean "calx\.hertz-mindlin"\?')
        self.assertIn(str(PLUGINS.resolve()), line)
        self.refuses(PLUGIN, cup({"/parts/0/geometry": "org.example.cone"}), "/parts/0", "no plugin org.example.cone")
        self.refuses(PLUGIN, cup({"/parts/0/geometry": "calx.hertz-mindlin"}), "/parts/0", "calx.contact-law/1", "calx.geometry/1")

    def test_no_plugins_at_all(self):
        (self.dir / "empty").mkdir()
        path = self.write(cup())
        line = self.fails(PLUGIN, "no plugin calx.hertz-mindlin", result=self.calx("run", path, plugins=["empty"]))
        self.assertIn(str(self.dir / "empty"), line)

    def test_deleted_library(self):
        needs("calx.epam")
        folder = self.copied("calx-epam.so")
        case = cup({"/contacts/0/law": "calx.epam", "/contacts/0/parameters": EPAM})
        line = self.fails(PLUGIN, r"/contacts/0", r"calx\.epam refused", r"calx-epam\.so",
                          result=self.calx("run", self.write(case), plugins=[folder]))
        self.assertRegex(line, "does not exist|no such file|No such file|is missing|cannot be")
        # All others work without it, and the list says what is wrong.
        self.runs(self.write(cup()), plugins=[folder])
        listed = self.calx("plugin", "list", plugins=[folder])
        self.assertEqual(listed.code, 0, listed.err)
        self.assertRegex(listed.out + listed.err, r"calx-epam")

    def test_deleted_plugin(self):
        needs("calx.epam")
        folder = self.copied("calx-epam.so", "calx-epam.plugin.json")
        case = cup({"/contacts/0/law": "calx.epam", "/contacts/0/parameters": EPAM})
        line = self.fails(PLUGIN, "/contacts/0", "no plugin calx.epam of the kind calx.contact-law/1 found in",
                          result=self.calx("run", self.write(case), plugins=[folder]))
        self.assertIn(str(folder), line)
        self.runs(self.write(cup()), plugins=[folder])

    def test_other_abi(self):
        self.refuses_force("#define BAD_MAJOR 2", "refused", r"ABI 2\b|ABI major 2|major 2", "1")
        self.refuses_force("#define BAD_DRAFT 99", "draft", "99")
        self.refuses_force("#define BAD_MAGIC 0x12345678u", "refused", "magic|not a Calx plugin|byte order")

    def test_fails_to_create(self):
        self.refuses_force('#define BAD_CREATE return host->fail(host, CALX_E_MEMORY, "no room for the table")',
                           "no room for the table")
        self.refuses_force("#define BAD_CREATE return CALX_E_INTERNAL", "create")
        self.refuses_force('#define BAD_INIT return host->fail(host, CALX_E_IO, "the licence file is gone")', "the licence file is gone")

    def test_finds_the_case_wrong(self):
        path = self.with_force('#define BAD_CREATE return host->fail(host, CALX_E_CONFIG, "gain: must be below 2")')
        self.fails(3, r"case\.json /forces/0", "gain: must be below 2", result=self.calx("run", path.name, "--plugin-path", "mine"))

    def test_not_a_library(self):
        path = self.with_force("")
        (self.dir / "mine" / "lib.so").write_text("not a library")
        self.fails(PLUGIN, r"test\.force refused", r"lib\.so", result=self.calx("run", path.name, "--plugin-path", "mine"))
        (self.dir / "mine" / "lib.plugin.json").write_text("{")
        line = self.fails(PLUGIN, r"no plugin test\.force", r"lib\.plugin\.json", result=self.calx("run", path.name, "--plugin-path", "mine"))
        self.assertRegex(line, "line 1|JSON")

    def test_pinned_library(self):
        path = self.write(cup({"/plugins": {"calx.box": {"sha256": "0" * 64}}}))
        line = self.fails(PLUGIN, r"calx\.box refused", "0" * 64, "pins", result=self.calx("run", path))
        found = re.search(r"has SHA-256 ([0-9a-f]{64})", line)
        self.write(cup({"/plugins": {"calx.box": {"sha256": found[1].upper()}}}))
        self.runs(path)

    def test_plugin_path(self):
        path = self.with_force("")
        self.assertRegex(self.calx("run", path.name).err, r"no plugin test\.force")
        self.runs(path.name, "--plugin-path", "mine")
        self.assertIn("test.force", [p["id"] for p in self.summary()["provenance"]["plugins"]])
        # The folder above was named, as a newcomer does.
        (self.dir / "project" / "build").mkdir(parents=True)
        (self.dir / "mine").rename(self.dir / "project" / "build" / "plugins")
        for near in ("project", "project/build"):
            line = self.fails(PLUGIN, r"/forces/0: no plugin test\.force", result=self.calx("run", path.name, "--plugin-path", near))
            self.assertRegex(line, r"project/build/plugins holds it: --plugin-path \S+project/build/plugins$")
        doctor = self.calx("plugin", "doctor", "test.force", "--plugin-path", "project/build/plugins")
        self.assertIn("Nothing is wrong with it", doctor.out)
        self.fails(6, r'calx\.bxo: no such file, .* did you mean "calx\.box"\?', result=self.calx("plugin", "doctor", "calx.bxo"))
        self.fails(6, 'plugin folder "yours" does not exist', result=self.calx("run", path.name, "--plugin-path", "yours"))


    def test_safe_mode(self):
        """Only what came with Calx: no folder of the user's, no law text beside the case."""
        path = self.with_force("/* a good one */")
        mine = {"CALX_PLUGIN_PATH": str(self.dir / "mine")}
        self.assertEqual(self.calx("check", path.name, env=mine).code, 0)
        self.fails(PLUGIN, r"no plugin test\.force .* found in ", result=self.calx("check", path.name, "--safe-mode", env=mine))
        shutil.copytree(self.dir / "mine", self.dir / ".local/share/calx/plugins")
        self.assertEqual(self.calx("check", path.name).code, 0)
        self.fails(PLUGIN, r"no plugin test\.force ", result=self.calx("check", path.name, "--safe-mode"))
        self.assertEqual(self.calx("plugin", "new", "beside", "--kind", "contact-law-text").code, 0)
        self.assertEqual(self.calx("check", "beside/try.json").code, 0)
        self.fails(PLUGIN, r"no plugin org\.example\.beside ", result=self.calx("run", "beside/try.json", "--safe-mode"))
        self.assertEqual(self.calx("check", self.write(cup(), "own.json").name, "--safe-mode").code, 0)
        self.fails(2, "--safe-mode excludes --plugin-path", result=self.calx("check", path.name, "--safe-mode", "--plugin-path", "mine"))


if __name__ == "__main__":
    unittest.main(verbosity=2)
