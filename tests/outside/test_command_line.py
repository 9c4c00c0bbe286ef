"""Options and the commands that do not run a case: help, version, check, plugin list, describe and schema."""
import json
import os
import re
import subprocess
import unittest

from calx import CASE, PLUGIN, PLUGINS, SOURCE, USAGE, CalxTest, cup, needs

try:
    import jsonschema
except ImportError:
    jsonschema = None

COMMANDS = ["run", "check", "report", "plugin", "bench"]


def check_schema(schema, where="#"):
    """What a JSON Schema must be, as far as the schemas here use it."""
    assert isinstance(schema, dict), where
    if "type" in schema:
        types = schema["type"] if isinstance(schema["type"], list) else [schema["type"]]
        assert set(types) <= {"object", "array", "string", "number", "integer", "boolean", "null"}, where
    for key in ("properties", "$defs", "patternProperties"):
        for name, item in schema.get(key, {}).items():
            check_schema(item, f"{where}/{key}/{name}")
    for key in ("anyOf", "oneOf", "allOf", "prefixItems"):
        for k, item in enumerate(schema.get(key, [])):
            check_schema(item, f"{where}/{key}/{k}")
    for key in ("items", "additionalProperties"):
        if not isinstance(schema.get(key, True), bool):
            check_schema(schema[key], f"{where}/{key}")
    assert set(schema.get("required", [])) <= set(schema.get("properties", schema.get("required", []))), where
    for key in ("minimum", "maximum", "minItems", "maxItems"):
        assert isinstance(schema.get(key, 0), (int, float)), where
    if jsonschema and where == "#":
        jsonschema.Draft202012Validator.check_schema(schema)


def references(schema):
    if isinstance(schema, dict):
        if "$ref" in schema:
            yield schema["$ref"]
        for item in schema.values():
            yield from references(item)
    elif isinstance(schema, list):
        for item in schema:
            yield from references(item)


class CommandLine(CalxTest):
    def test_help(self):
        top = self.calx("--help")
        self.assertEqual((top.code, top.err), (0, ""))
        for command in COMMANDS:
            self.assertRegex(top.out, rf"(?m)^  {command} +\w")
        for words in [[c] for c in COMMANDS] + [["plugin", c] for c in ("list", "describe", "schema")]:
            result = self.calx(*words, "--help")
            self.assertEqual((result.code, result.err), (0, ""), words)
            self.assertIn("Usage: calx " + " ".join(words), result.out)
            # Every option says what it is for.
            for option in re.findall(r"(?m)^  (-.*)$", result.out):
                self.assertRegex(option, r"^\S+(?: \S+)*? {2,}\S|^\S+ [A-Z]+\S*(?: \.\.\.)? +\w", words)
        run = self.calx("run", "--help").out
        for option in ("-o", "--set", "--threads", "--device", "--precision", "--until", "--resume", "--overwrite", "--seed",
                       "--plugin-path", "--quiet", "--json"):
            self.assertIn(option, run)

    def test_version(self):
        result = self.calx("--version")
        self.assertEqual(result.code, 0)
        self.assertRegex(result.out, r"^calx \d+\.\d+\.\d+ \(([0-9a-f]{9}\+?|unknown)\), ABI \d+\.\d+\n$")

    def test_the_git_stamp_follows_commits_and_edits(self):
        tree, source = self.dir / "tree", self.dir / "git_revision.cpp"
        tree.mkdir()

        def git(*words):
            who = ("-c", "user.name=a", "-c", "user.email=a@example.org", "-c", "commit.gpgsign=false")
            return subprocess.run(["git", *who, "-C", str(tree), *words], check=True, capture_output=True, text=True).stdout

        def stamp():
            subprocess.run(["cmake", "-D", f"SOURCE={tree}", "-D", f"OUTPUT={source}", "-P",
                            str(SOURCE / "core/base/git_revision.cmake")], check=True,
                           env={**os.environ, "GIT_CEILING_DIRECTORIES": str(self.dir)})
            return re.search('return "(.*)"', source.read_text()).group(1)

        self.assertEqual(stamp(), "unknown")
        git("init", "-q")
        for text in ("one", "two"):
            (tree / "file").write_text(text)
            git("add", "file")
            git("commit", "-q", "-m", text)
            commit = git("rev-parse", "HEAD")[:9]
            self.assertEqual(stamp(), commit)
        before = source.stat().st_mtime_ns
        self.assertEqual((stamp(), source.stat().st_mtime_ns), (commit, before))
        (tree / "file").write_text("edited")
        self.assertEqual(stamp(), commit + "+")

    def test_usage(self):
        path = self.write(cup())
        for words, text in ((["frobnicate"], r'calx: no command "frobnicate"; known are "run", "check"'),
                            (["rum"], r'calx: no command "rum"; did you mean "run"\? \(see calx --help\)'),
                            ([], r'calx: a command is needed: "run", "check"'),
                            (["plugin"], r'calx: a command is needed: "list", "describe", "schema", "check", "doctor", "new" \(see calx plugin --help\)'),
                            (["plugin", "lst"], r'no command "lst"; did you mean "list"\?'),
                            (["run"], r"calx: run: case is required \(see calx run --help\)"),
                            (["run", path, "--ovrwrite"], r"run: no option --ovrwrite; did you mean --overwrite\?"),
                            (["run", path, "--bogus=3"], r"run: no option --bogus \(see calx run --help\)"),
                            (["run", path, "other.json"], r"run: .*not expected: other\.json"),
                            (["run", path, "--threads", 0], r'--threads: "0" is not a whole number above 0'),
                            (["run", path, "--threads", "2.5"], r'--threads: "2.5" is not a whole number above 0'),
                            (["run", path, "--seed", "x"], r'--seed: "x" is not a whole number, 0 or more'),
                            (["run", path, "--until", -1], r'--until: "-1" is not a number, 0 or more'),
                            (["run", path, "--set", "time/end=1"], r"--set time/end=1: expected /json/pointer=value, for instance"),
                            (["run", path, "--set", "/time/end"], r"--set /time/end: expected /json/pointer=value"),
                            (["run", path, "--device", "cuda"], r"device kind cuda needs an NVIDIA driver"),
                            (["run", path, "--device", "gpu"], r"--device gpu: expected auto, cpu, opencl, cuda or host"),
                            (["run", path, "--precision", "half"], r'--precision half: .*"double"'),
                            (["run", path, "--arithmetic", "wild"], r'--arithmetic wild: .*"exact" or "fast"'),
                            (["check"], r"check: a case file is needed"),
                            (["bench", "--threads", "-3"], r'--threads: "-3" is not a whole number above 0')):
            with self.subTest(words):
                result = self.calx(*words)
                self.fails(USAGE, text, result=result)
                self.assertEqual(result.err.count("\n"), 1, result.err)
        self.assertFalse((self.dir / "case.out").exists())

    def test_check(self):
        result = self.calx("check", self.write(cup()), "--threads", 3)
        self.assertEqual((result.code, result.err), (0, ""))
        text = result.out
        limits = re.findall(r"(?m)^  ([ *]) (\w+) +(\S+) s  (.*)$", text)
        self.assertEqual({name for _, name, _, _ in limits}, {"rayleigh", "hertz", "law"})
        binding = [row for row in limits if row[0] == "*"]
        self.assertEqual(len(binding), 1)
        self.assertTrue(binding[0][3].endswith("<- binds"))
        least = min(float(row[2]) for row in limits)
        self.assertEqual(float(binding[0][2]), least)
        self.assertEqual(float(re.search(r"(?m)^Time step (\S+) s; limits:", text)[1]), least)
        # Rayleigh time of the ball by hand: pi r sqrt(rho / G) / (0.1631 nu + 0.8766), G = E / (2 (1 + nu)).
        rayleigh = 3.14159265 * 0.002 * (2500 / (1e7 / 2.5)) ** 0.5 / (0.1631 * 0.25 + 0.8766)
        self.assertAlmostEqual(float(next(row[2] for row in limits if row[1] == "rayleigh")), 0.1 * rayleigh, delta=1e-8)
        steps = int(re.search(r"(\d+) steps", text)[1])
        self.assertAlmostEqual(steps, 0.05 / least, delta=1.5)
        for pattern in (r'Source "pour": 0\.005027 kg, about 60 particles of "ball"',
                        r"Size: 0\.005027 kg, 60 particles, 60 spheres, ", r"Memory: below 1 MB", r"Cost: below 1 s on 3 threads",
                        r"(?m)^Device: cpu; .*double precision, exact arithmetic, 3 threads$", r"(?m)^  glass: density 2500, poisson 0\.25, young 1e\+07$",
                        r"(?m)^  glass-steel: calx\.hertz-mindlin$", r"rolling_friction = 0", r"cup: calx\.box, 10 surface elements",
                        r"calx\.box 1\.\d+\.\d+  sha256 [0-9a-f]{12}  /\S*/calx_box\.so", r"(?m)^  - every value is made up$"):
            self.assertRegex(text, pattern)
        self.assertFalse((self.dir / "case.out").exists(), "check must not write")
        above = self.calx("check", "case.json", "--set", f"/time/step={1.5 * least}").out
        self.assertRegex(above, rf"(?m)^Time step \S+ s \(given, above the advised {least:g} s; refused above \S+ s\); limits:$")
        below = self.calx("check", "case.json", "--set", f"/time/step={0.5 * least}").out
        self.assertRegex(below, r"(?m)^Time step \S+ s \(given\); limits:$")
        large = self.calx("check", "case.json", "--set", "/time/end=3600", "--threads", 1).out
        self.assertRegex(large, r"Cost: about \d+ min \d\d s on 1 threads?")

    def test_check_counts_the_particles_of_a_file(self):
        # One ball of 2 mm in radius as it is, one half as large: 1 + 1/8 of 2500 kg/m3 * 4/3 pi (2 mm)^3.
        (self.dir / "bed.csv").write_text("x_m,y_m,z_m,scale\n0,0,0.004,1\n0,0.006,0.004,0.5\n")
        source = {"name": "bed", "shape": "ball", "material": "glass", "file": "bed.csv"}
        text = self.calx("check", self.write(cup({"/sources": [source]}))).out
        self.assertRegex(text, r'Source "bed": 9\.425e-05 kg, 2 particles of "ball"')
        self.assertIn("Size: 9.425e-05 kg, 2 particles, 2 spheres", text)

    def test_check_goes_over_overrides(self):
        result = self.calx("check", self.write(cup()), "--set", "/sources/0/count=30", "--set", "/materials/glass/young=4e7")
        self.assertIn("about 30 particles", result.out)
        self.assertIn("young 4e+07", result.out)

    def test_check_says_what_particle_scaling_changes(self):
        case = self.write(cup({"/time/step": 1e-6, "/scale": {"factor": 2}}))
        text = self.calx("check", case).out
        for pattern in (r"(?m)^Scale: grains 2 times as large; kept: density, moduli, restitution, friction, strength of the bulk; "
                        r"the given time step is 2 times that of the case$",
                        r"(?m)^  ball: largest sphere 0\.002 m -> 0\.004 m in radius$", r"(?m)^Time step 2e-06 s \(given\)",
                        r"about 8 particles", r"(?m)^  - Particle scaling: grains 2 times the size that the case draws"):
            self.assertRegex(text, pattern)
        wrong = self.calx("check", case, "--set", "/scale/factor=0")
        self.assertEqual(wrong.code, CASE)
        self.assertIn("/scale/factor: ", wrong.err)
        self.assertNotIn("Scale", self.calx("check", self.write(cup())).out)

    def test_case_schema(self):
        schema = json.loads(self.calx("check", "--print-schema").out)
        check_schema(schema)
        self.assertRegex(schema["$schema"], "2020-12|draft-07")
        self.assertLessEqual(set(cup()), set(schema["properties"]))
        for reference in references(schema):
            here = schema
            for key in reference.lstrip("#/").split("/"):
                here = here[key]
        if jsonschema:
            jsonschema.validate(cup(), schema)

    def test_plugin_list(self):
        result = self.calx("plugin", "list")
        self.assertEqual((result.code, result.err), (0, ""))
        rows = dict(re.findall(r"(?m)^  ([a-z][\w.-]+) +\d+\.\d+\.\d+ +(calx\.[\w-]+/\d+) +\S", result.out))
        known = {}
        for path in PLUGINS.glob("*.plugin.json"):
            known.update({p["id"]: p["kind"] for p in json.loads(path.read_text())["plugins"]})
        self.assertEqual(rows, known)
        self.assertIn("calx.hertz-mindlin", rows)
        self.assertIn(str(PLUGINS.resolve()), result.out)

    def test_plugin_describe_and_schema(self):
        listed = re.findall(r"(?m)^  (calx\.[\w-]+) ", self.calx("plugin", "list").out)
        self.assertGreater(len(listed), 15)
        for name in listed:
            with self.subTest(name):
                described = self.calx("plugin", "describe", name)
                self.assertEqual((described.code, described.err), (0, ""))
                self.assertRegex(described.out, rf"^{re.escape(name)} \d+\.\d+\.\d+\n\S.*\.\n")
                if "calx.case-effect/1" in described.out:  # it has no library
                    self.fails(PLUGIN, "an effect of edits alone", result=self.calx("plugin", "schema", name))
                    continue
                self.assertRegex(described.out, r"(?m)^  sha256 +[0-9a-f]{64}$")
                schema = json.loads(self.calx("plugin", "schema", name).out)
                check_schema(schema)
                self.assertEqual(schema["type"], "object")
                self.assertIs(schema["additionalProperties"], False)
                self.assertIn(name, schema["title"])
        for command in ("describe", "schema"):
            self.fails(PLUGIN, r"no plugin calx\.hertz-midlin found in /\S+", r'did you mean "calx\.hertz-mindlin"\?',
                       result=self.calx("plugin", command, "calx.hertz-midlin"))

    def test_plugin_with_choices(self):
        needs("calx.epam")
        schema = json.loads(self.calx("plugin", "schema", "calx.epam").out)["properties"]
        text = self.calx("plugin", "describe", "calx.epam").out
        self.assertRegex(text, r"(?m)^  plasticity +1 +0 \.\. 0\.99 +required +lambda = 1 - k1/k2")
        self.assertEqual(schema["exponent"]["enum"], ["1", "1.5"])
        self.assertEqual(schema["plasticity"]["anyOf"][0], {"type": "number", "minimum": 0, "maximum": 0.99})


if __name__ == "__main__":
    unittest.main(verbosity=2)
