"""docs/case.md: its blocks together are a case that runs, and it names every key of the schema. Its table of sensors is held
against the sensors themselves in tests/measure."""
import json
import re
import unittest

from calx import CASE, SOURCE, CalxTest, cup, needs

PAGE = (SOURCE / "docs/case.md").read_text(encoding="utf-8")


class CaseDocument(CalxTest):
    def schema(self):
        result = self.calx("check", "--print-schema")
        self.assertEqual(result.code, 0, result.err)
        return json.loads(result.out)

    def test_blocks_are_a_case(self):
        for plugin in ("hertz-mindlin", "wall-charge", "travel", "vibration", "stokes-drag", "powder-drag", "load-cell-lag",
                       "centroid"):
            needs("calx." + plugin)
        blocks = re.findall(r"^```jsonc\n(.*?)^```", PAGE, re.S | re.M)
        path = self.write("{" + ",\n".join(blocks) + "}")
        self.runs(path.name)
        last = self.rows("cup mass")[-1]
        # 40 balls and one that lies there from the start, and four pairs of 5e-5 kg for the 2e-4 kg asked for.
        self.assertEqual(last[2], "45", "grains in the cup")
        # The resolved case holds every key that a user may give, but for what takes over another case.
        text = re.sub(r" //.*", "", "".join(blocks))
        for key in self.schema()["properties"]:
            self.assertIn(f'"{key}"' if key not in ("$schema", "extends", "relative_to") else f'`"{key}"`',
                          text if key not in ("$schema", "extends", "relative_to") else PAGE)

    def test_every_condition_is_named(self):
        options = self.schema()["$defs"]["condition"]["anyOf"]
        for key in next(o for o in options if "properties" in o)["properties"]:
            self.assertIn(f"`{key}`", PAGE)

    def test_sensor_kinds(self):
        table = self.calx("check", "--sensors")
        self.assertEqual(table.code, 0, table.err)
        listed = [line.split()[0] for line in table.out.splitlines()[1:]]
        kinds = self.schema()["properties"]["sensors"]["items"]["properties"]["kind"]["anyOf"]
        self.assertEqual([k["const"] for k in kinds[:-1]], listed)
        self.assertRegex("org.example.chart", kinds[-1]["pattern"])
        self.assertNotRegex("part-lod", kinds[-1]["pattern"])
        self.assertEqual(re.findall(r"^\| `([a-z-]+)` \|", PAGE, re.M), listed)

    def test_misspelt_kind(self):
        case = cup({"/sensors/0": {"name": "load", "kind": "part-lod", "part": "cup", "every": 0.01}})
        self.refuses(CASE, case, r'case\.json /sensors/0/kind: unknown kind of sensor "part-lod"; did you mean "part-load"\?',
                     "Built in are mass, cycle-mass, .* mass-ledger; others are named by their plugin's id")


if __name__ == "__main__":
    unittest.main()
