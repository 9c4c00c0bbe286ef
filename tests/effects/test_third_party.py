"""An effect of a stranger, built outside of the tree in a temporary folder, joins by lying on the plugin path."""
import json
import os
import pathlib
import subprocess
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(os.environ["CALX_SOURCE"], "tests", "outside")))
from calx import CASE, SOURCE, CalxTest, cup  # noqa: E402

MANIFEST = """{"calx_plugin": 1, "library": "@CALX_PLUGIN_LIBRARY@",
 "abi": {"major": 1, "minor": 0}, "version": "1.0.0", "vendor": "Example", "license": "MIT",
 "plugins": [{"id": "org.example.glue", "kind": "calx.contact-law/1", "summary": "A constant pull.",
  "effect": {
   "parameters": [{"name": "pull", "unit": "N", "off": 0, "scale": 1e-4, "sign": "positive", "range": [0, 1], "doc": "pull"}],
   "roles": [{"name": "powder", "kind": "material", "used_by": "sources", "doc": "material of the grains"}],
   "touches": ["static-angle"],
   "edits": [{"op": "append", "to": "/contacts/{powder}|{powder}/laws",
              "value": {"law": "org.example.glue", "parameters": {"pull": "{pull}"}}}]}}], "requires": []}
"""
TEXT = """#define glue_pair_LIST(X) X(pull, "N", 0, 1, 0, 0, "pull")
#define glue_prop_LIST(X)
#define glue_state_LIST(X)
#define glue_NEEDS CALX_NEED_NORMAL
CALX_LAW_DECLARE(glue)
CALX_LAW_EVAL(glue) {
  out->fx = -p->pull * c->nx;
  out->fy = -p->pull * c->ny;
  out->fz = -p->pull * c->nz;
}
"""
SOURCE_TEXT = """#define CALX_TERM glue
#define CALX_TERM_TEXT "glue.law.h"
#define CALX_TERM_BYTES "glue.law.h.inc"
#define CALX_TERM_SHA256 "glue.law.h.sha256.inc"
#include <calx/law_term.hpp>
const calx_descriptor calx::LawTerm::descriptor =
    calx::law_term("org.example.glue", "Glue", "1.0.0", "Example", "MIT", "A constant pull.");
CALX_PLUGIN(calx::LawTerm)
"""
LISTS = """cmake_minimum_required(VERSION 3.20)
project(glue LANGUAGES C CXX)
set(CMAKE_BUILD_TYPE Release)
include(${CALX_ABI}/cmake/CalxAddPlugin.cmake)
calx_add_plugin(glue SOURCES glue.cpp LAWS ${CMAKE_CURRENT_SOURCE_DIR}/glue.law.h MANIFEST glue.plugin.json.in)
"""


class ThirdPartyEffect(CalxTest):
    def setUp(self):
        super().setUp()
        folder = self.dir / "glue"
        folder.mkdir()
        for name, text in (("glue.plugin.json.in", MANIFEST), ("glue.law.h", TEXT), ("glue.cpp", SOURCE_TEXT),
                           ("CMakeLists.txt", LISTS)):
            (folder / name).write_text(text)
        for words in (["-S", folder, "-B", folder / "build", f"-DCALX_ABI={SOURCE}/abi"], ["--build", folder / "build"]):
            done = subprocess.run(["cmake", *words], text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
            self.assertEqual(done.returncode, 0, done.stdout)
        self.path = ("--plugin-path", folder / "build" / "plugins")

    def results(self, pull):
        effects = {} if pull is None else {"/effects": [{"effect": "org.example.glue", "parameters": {"pull": pull}}]}
        name = f"glue_{pull}"
        case = self.write(cup(effects), f"{name}.json").name
        self.runs(case, "-o", name, "--quiet", *self.path)
        return self.dir / name

    def test_joins(self):
        self.assertIn("[effect] A constant pull.", self.calx("plugin", "list", *self.path).out)
        without, off, on = (self.results(pull) for pull in (None, 0, 3e-4))
        series = [(folder / "series" / "energy.csv").read_text() for folder in (without, off, on)]
        # The elastic energy of the pull itself is not booked, so only what moves is compared with the run without it.
        self.assertEqual(series[0], series[1])
        self.assertNotEqual(series[0], series[2])
        case = json.loads((on / "case.json").read_text())
        self.assertEqual([law["law"] for law in case["contacts"][0]["laws"]], ["calx.hertz-mindlin", "org.example.glue"])
        self.assertTrue(case["effects"][0]["expanded"])
        summary = json.loads((on / "summary.json").read_text())
        self.assertEqual(summary["provenance"]["effects"], [{"effect": "org.example.glue", "version": "1.0.0",
                                                             "on": {"powder": "glass"}, "parameters": {"pull": 3e-4}}])
        self.assertIn('Effect org.example.glue 1.0.0 on powder "glass": pull = 3e-04 N.', summary["assumptions"])
        # The expanded case is a case: it gives the same bits again.
        self.runs(on / "case.json", "-o", "again", "--quiet", *self.path)
        self.assertEqual((self.dir / "again" / "series" / "energy.csv").read_text(), series[2])

    def test_not_on_the_path(self):
        case = self.write(cup({"/effects": [{"effect": "org.example.glue", "parameters": {"pull": 0}}]})).name
        self.fails(CASE, "/effects/0/effect: no effect \"org.example.glue\" among the plugins found",
                   result=self.calx("check", case))


if __name__ == "__main__":
    unittest.main(verbosity=2)
