"""sinew validate: the quick suite holds, its reports are complete, mistakes are named."""

import json
import unittest
import xml.dom.minidom

from cli_support import INPUT, IO, ROOT, USAGE, CliTest

CASES = ROOT / "validation"
THRESHOLDS = 7
SMALL = ["patch", "shear", "hollow_sphere"]


class ValidateTest(CliTest):
    def test_quick_suite(self):
        run = self.run_sinew("validate", *SMALL, "--quick", "--dir", CASES, "--json", "--out", "v")
        result = json.loads(run.stdout)
        self.assertTrue(result["holds"])
        self.assertEqual(list(result["cases"]), SMALL)
        self.assertEqual(result, json.loads((self.dir / "v" / "validation.json").read_text()))
        page = (self.dir / "v" / "validation.html").read_text(encoding="utf-8")
        xml.dom.minidom.parseString(page.replace("<!DOCTYPE html>", ""))
        median = result["median_coarsest"]
        self.assertLess(median["neo-hookean"], median["fem"] / 3)
        for trial in result["cases"]["patch"]["trials"]:
            if trial["law"] in ("neo-hookean", "fem"):
                for value in trial["values"].values():
                    self.assertLess(abs(value["error"]), 1e-6)

    def test_tables(self):
        run = self.run_sinew("validate", "shear", "--quick", "--dir", CASES, "--law", "neo-hookean")
        self.assertIn("All thresholds hold.", run.stdout)
        self.assertIn("Wrote out/validation/validation.html", run.stdout)
        self.assertIn("shear, nu=0.3, 4, network", run.stderr)

    def test_list(self):
        run = self.run_sinew("validate", *SMALL, "--dir", CASES, "--list")
        for name in SMALL:
            self.assertIn(f"  {name}", run.stdout)

    def copy_case(self, change):
        for name in ("case.toml", "scene.toml", "reference.toml"):
            text = (CASES / "shear" / name).read_text(encoding="utf-8")
            self.write(f"cases/shear/{name}", change(name, text))

    def test_missed_threshold(self):
        self.copy_case(lambda name, text: text.replace("value = 2884", "value = 3884"))
        run = self.run_sinew("validate", "--dir", "cases", "--quick", "--law", "neo-hookean",
                             code=THRESHOLDS)
        self.assertIn("1 missed", run.stdout)

    def test_a_law_that_cannot_have_a_material_has_failed_there(self):
        self.copy_case(lambda name, text: text.replace("poisson=0.3", "poisson=0"))
        run = self.run_sinew("validate", "--dir", "cases", "--quick", "--law", "calibrated",
                             "--law", "lloyd")
        self.assertIn("1 of 1 failed", run.stdout)
        self.assertIn("cannot have Poisson's ratio 0", run.stdout)

    def test_mistakes(self):
        wrong = self.run_sinew("validate", "sheer", "--dir", CASES, code=USAGE)
        self.assertIn("there is no case 'sheer'; did you mean 'shear'?", wrong.stderr)
        self.run_sinew("validate", code=IO)
        self.copy_case(lambda name, text: text.replace('of = "', 'off = "').replace("axis", "axes"))
        wrong = self.run_sinew("validate", "--dir", "cases", code=INPUT)
        self.assertIn("unknown key 'axes'", wrong.stderr)
        self.copy_case(lambda name, text: text)
        (self.dir / "cases/shear/reference.toml").unlink()
        wrong = self.run_sinew("validate", "--dir", "cases", code=INPUT)
        self.assertIn("the case 'shear' has no reference values", wrong.stderr)


if __name__ == "__main__":
    unittest.main()
