"""sinew materials: its output, which docs/tissues.md and the completions must match."""

import json
import re
import unittest

from cli_support import INPUT, ROOT, USAGE, CliTest

SCENE = """
duration = 0.001
[body.organ]
shape = "box"
cells = [1, 1, 1]
material = "{}"
"""


class MaterialsTest(CliTest):
    def library(self):
        return json.loads(self.run_sinew("materials", "--json").stdout)

    def rows(self):
        """The rows of the table, as lists of cells."""
        lines = self.run_sinew("materials").stdout.splitlines()
        return [re.split(r"  +", line) for line in lines[2:lines.index("")]]

    def test_table_has_every_material(self):
        names = [t["name"] for t in self.library()]
        self.assertEqual([row[0] for row in self.rows()], names)
        for name in ("liver", "fat", "muscle", "skin", "kidney", "brain", "silicone-gel"):
            self.assertIn(name, names)

    def test_one_with_its_sources(self):
        text = self.run_sinew("materials", "liver").stdout
        liver = next(t for t in self.library() if t["name"] == "liver")
        self.assertIn("5.5 kPa, reported: 2.6 to 7.4 kPa", text)
        for source in liver["sources"]:
            self.assertIn(f"({source['year']})", text)
        self.assertLessEqual(max(map(len, text.splitlines())), 96)
        self.assertEqual(json.loads(self.run_sinew("materials", "liver", "--json").stdout), liver)

    def test_unknown_names(self):
        wrong = self.run_sinew("materials", "livr", code=USAGE)
        self.assertEqual(wrong.stdout, "")
        self.assertIn("there is no material 'livr'; did you mean 'liver'?", wrong.stderr)
        self.write("scene.toml", SCENE.format("musle"))
        wrong = self.run_sinew("run", "scene.toml", "--no-output", code=INPUT)
        self.assertIn("scene.toml:6:12: 'material' in [body.organ]: there is no material 'musle'; "
                      "did you mean 'muscle'?", wrong.stderr)

    def test_every_material_runs(self):
        for tissue in self.library():
            self.write("scene.toml", SCENE.format(tissue["name"]))
            run = self.run_sinew("run", "scene.toml", "--no-output", "--json")
            mass = json.loads(run.stdout)["bodies"][0]["mass"]
            self.assertAlmostEqual(mass / (0.1 * 0.1 * 0.4 * tissue["density"]), 1.0, places=9)

    def test_document_says_the_same(self):
        page = (ROOT / "docs" / "tissues.md").read_text(encoding="utf-8")
        for name, *cells in self.rows():
            self.assertIn(f"\n| `{name}` | {' | '.join(cells)} |\n", page)
        for tissue in self.library():
            for s in tissue["sources"]:
                doi = f" doi:[{s['doi']}](https://doi.org/{s['doi']})" if s["doi"] else ""
                self.assertIn(f"\n- {s['authors']} ({s['year']}). {s['title']}. {s['journal']}.{doi}\n",
                              page)

    def test_completions_know_the_names(self):
        for shell in ("bash", "zsh", "fish"):
            script = (ROOT / "completions" / f"sinew.{shell}").read_text(encoding="utf-8")
            self.assertIn(" ".join(t["name"] for t in self.library()), script, shell)


if __name__ == "__main__":
    unittest.main()
