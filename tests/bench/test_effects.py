"""What effects.py makes of numbers, that its scenes run and give sound figures, and that a hopper in mixed precision empties
as it does in double. Nothing is timed."""
import contextlib
import io
import json
import math
import os
import pathlib
import random
import statistics
import sys
import tempfile
import unittest
import xml.dom.minidom

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
try:
    import h5py  # noqa: F401 pylint: disable=unused-import
except ImportError:
    sys.exit(77)
import effects  # noqa: E402 pylint: disable=wrong-import-position
import effects_plot  # noqa: E402 pylint: disable=wrong-import-position
import effects_scenes  # noqa: E402 pylint: disable=wrong-import-position

CALX = os.environ["CALX"]


def plugins():
    """Ids that the build has: any folder of plugins/ may be deleted."""
    folder = pathlib.Path(CALX).parent.parent / "plugins"
    return {p["id"] for path in folder.glob("*.plugin.json") for p in json.loads(path.read_text())["plugins"]}


def ids(value):
    """Every calx.NAME in a case."""
    if isinstance(value, dict):
        return set().union(*(ids(v) for v in value.values()))
    if isinstance(value, list):
        return set().union(*(ids(v) for v in value))
    return {value} if isinstance(value, str) and value.startswith("calx.") else set()


def case(scene):
    lines = (HERE / "effects_cases" / f"{scene}.json").read_text(encoding="ascii").splitlines()
    return json.loads("\n".join(line for line in lines if not line.lstrip().startswith("//")))


class StatisticsTest(unittest.TestCase):
    def test_student(self):
        for freedom, level, t in ((1, 0.95, 12.706), (4, 0.99, 4.604), (9, 0.99, 3.250), (18, 0.99, 2.878), (120, 0.95, 1.980)):
            self.assertAlmostEqual(effects.student(freedom, level), t, places=3)

    def test_pairs_see_what_scatter_hides(self):
        off = [10.0, 20, 30, 40, 50]
        on = [value + 1 + 0.01 * (-1) ** k for k, value in enumerate(off)]
        paired, unpaired = effects.compare(off, on, True), effects.compare(off, on, False)
        for row in (paired, unpaired):
            self.assertAlmostEqual(row["difference"], 1.002)
            self.assertAlmostEqual(row["sd_off"], statistics.stdev(off))
        self.assertEqual((paired["verdict"], unpaired["verdict"]), ("differs", "within scatter"))
        # Welch with equal scatter and numbers: sqrt(2) sd / sqrt(n), 2 n - 2 degrees of freedom.
        self.assertAlmostEqual(unpaired["error"], math.sqrt(2 / 5) * statistics.stdev(off), places=2)
        self.assertAlmostEqual(unpaired["limit"] / unpaired["error"], effects.student(8), places=3)
        self.assertAlmostEqual(paired["limit"] / paired["error"], effects.student(4), places=3)

    def test_figures_without_scatter(self):
        self.assertEqual(effects.compare([1.0, 1.0], [1.0, 1.0], False)["verdict"], "within scatter")
        self.assertEqual(effects.compare([1.0, 1.0], [1.001, 1.001], False)["verdict"], "differs")

    def test_one_row_in_a_hundred_differs_by_chance(self):
        draw = random.Random(1)
        for paired in (False, True):
            wrong = sum(effects.compare([draw.gauss(5, 1) for _ in range(6)], [draw.gauss(5, 1) for _ in range(6)],
                                        paired)["verdict"] == "differs" for _ in range(600))
            self.assertTrue(0 < wrong < 18, wrong)
        seen = sum(effects.compare([draw.gauss(5, 1) for _ in range(6)], [draw.gauss(9, 1) for _ in range(6)],
                                   False)["verdict"] == "differs" for _ in range(100))
        self.assertGreater(seen, 90)

    def test_table_and_picture(self):
        equal = effects.compare([1.0, 2.0, 1.5], [1.1, 2.2, 1.4], False)
        moved = effects.compare([1.0, 1.01, 1.02], [9.0, 9.01, 9.02], False)
        rows = [{"scene": "bed", "figure": "a < b", "unit": "mm", **equal},
                {"scene": "bed", "figure": "moved", "unit": "g", **moved}]
        lines = effects.table(rows, "rest").splitlines()
        cells = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]
        self.assertEqual(cells[2][:5] + cells[2][-1:], ["bed", "a < b", "mm", "3", "1.5", "within scatter"])
        self.assertEqual((cells[3][6], cells[3][7], cells[3][-1]), ("9.01", "8", "differs"))
        self.assertEqual({len(line) for line in lines}, {len(lines[0])})
        picture = xml.dom.minidom.parseString(effects_plot.plot(rows, "rest"))
        self.assertEqual(len(picture.getElementsByTagName("circle")), 2)


class RunsTest(unittest.TestCase):
    def rows(self, feature, scene, *words, without=()):
        """{figure: row} with two seeds. without: figures that such a small scene has not."""
        missing = ids(case(scene)) - plugins()
        if missing:
            self.skipTest(f"there is no plugin {', '.join(sorted(missing))}")
        with contextlib.redirect_stdout(io.StringIO()) as text, contextlib.redirect_stderr(io.StringIO()):
            effects.main([feature, "--calx", CALX, "--seeds", "2", "--scenes", scene, "--json", *words])
        rows = [json.loads(line) for line in text.getvalue().splitlines()]
        names = [name for name, _, _, shown in effects_scenes.SCENES[scene] if (not shown or feature in shown) and
                 name not in without]
        self.assertEqual([row["figure"] for row in rows], names)
        for row in rows:
            self.assertEqual((row["scene"], row["seeds"]), (scene, 2))
            self.assertTrue(all(math.isfinite(row[key]) for key in ("off", "on", "difference", "error", "limit")), row)
            self.assertGreater(row["sd_off"], 0, row)
        return {row["figure"]: row for row in rows}

    def test_every_scene_has_a_case_that_lists_what_is_assumed(self):
        self.assertEqual(sorted(effects_scenes.SCENES), sorted(path.stem for path in (HERE / "effects_cases").glob("*.json")))
        for scene in effects_scenes.SCENES:
            self.assertGreater(len(case(scene)["assumptions"]), 0, scene)

    def test_mixed_precision_keeps_energy(self):
        rows = self.rows("precision", "gas", "--dry", "--set", "/sources/0/count=100")
        change = rows["sum of energies, change"]
        self.assertLess(max(abs(change["off"]), abs(change["on"])), 100)  # ppm
        self.assertNotEqual(change["difference"], 0)

    def test_a_bed_of_two_seeds_sleeps_and_is_as_dense(self):
        with tempfile.TemporaryDirectory() as folder:
            results = pathlib.Path(folder) / "results/a.jsonl"
            words = ["--results", str(results), "--set", "/sources/0/count=150", "--set",
                     "/regions/core/box={\"min\": [0, 0, 0.001], \"max\": [0.03, 0.03, 0.003]}"]
            rows = self.rows("rest", "bed", *words)
            lines = [json.loads(line) for line in results.read_text().splitlines()]
            self.assertEqual(sorted((line["seed"], line["feature"]) for line in lines),
                             [(1, ""), (1, "rest"), (2, ""), (2, "rest")])
            for line in lines:
                self.assertEqual((line["particles"], line["steps"], "asleep" in line), (150, 30000, line["feature"] == "rest"))
            for line in (line for line in lines if line["feature"]):
                asleep = line["asleep"]
                self.assertTrue(0.1 < asleep["steps_skipped"] < asleep["at_the_end"] <= asleep["most"] <= 1, asleep)
            # What has been run is taken from the file, and gives the same rows.
            self.assertEqual(self.rows("rest", "bed", *words), rows)
            self.assertEqual(self.rows("rest", "bed", "--recorded", "--seeds", "9", *words), rows)
            self.assertEqual(len(results.read_text().splitlines()), 4)
        floor = rows["load on the floor, of the weight"]
        self.assertAlmostEqual(floor["off"], 1, delta=0.01)
        self.assertAlmostEqual(floor["on"], 1, delta=0.01)  # a sleeper is out of balance by a tenth of its weight at most
        self.assertAlmostEqual(rows["height of the centre"]["on"] / rows["height of the centre"]["off"], 1, delta=0.05)

    def test_a_hopper_in_mixed_precision_empties_as_in_double(self):
        rows = self.rows("precision", "hopper", "--dry", "--set", "/sources/0/count=1000", "--set", "/time/end=0.75",
                         without=["angle of the retained wedge"])
        poured = 1e3 * 1000 * 2017 * math.pi / 6 * 2.5e-3 ** 3  # g
        self.assertGreater(rows["discharged 0.1 s after opening"]["off"], 0.2 * poured)
        # Two ways from one start differ as two seeds do, by 0.1 to 0.8 % of what is poured; these are means of two.
        for name, bound in (("discharged 0.1 s after opening", 0.015), ("discharged 0.2 s after opening", 0.02),
                            ("discharged 0.3 s after opening", 0.02), ("retained", 0.03)):
            self.assertLess(abs(rows[name]["difference"]), bound * poured, rows[name])

    def test_a_run_that_fails_is_named(self):
        if ids(case("gas")) - plugins():
            self.skipTest("plugins are missing")
        with self.assertRaises(SystemExit) as stop, contextlib.redirect_stderr(io.StringIO()):
            effects.main(["precision", "--calx", CALX, "--seeds", "2", "--scenes", "gas", "--dry", "--jobs", "1", "--set",
                          "/no_such_key=1"])
        self.assertIn("no_such_key", str(stop.exception))


if __name__ == "__main__":
    unittest.main()
