"""The words of the live view's page are those of the program: laws, steppers, shapes of obstacles."""

import re
import unittest

from cli_support import ROOT, SCENES, CliTest


def page(name):
    return (ROOT / "web" / "src" / name).read_text(encoding="utf-8")


def words(text):
    return re.findall(r'"([\w-]+)"', text)


class PageWordsTest(CliTest):
    def known(self, key, scene="beam.toml"):
        """The words that the program accepts for a key, from the error for another one."""
        run = self.run_sinew("run", SCENES / scene, "--no-output", "--set", f"{key}=no-such-word",
                             code=3)
        listed = re.search(r"expected one of ([^;\n]*)", run.stderr)
        self.assertIsNotNone(listed, run.stderr)
        return words(listed[1])

    def test_laws(self):
        offered = words(re.search(r"const LAWS = \[([^\]]*)\]", page("panel.ts"))[1])
        # The constants of the law uniform have no sliders, so the panel does not offer it.
        self.assertEqual(set(offered) | {"uniform"}, set(self.known("beam.law")))

    def test_steppers(self):
        listed = re.search(r"const STEPPERS[^=]*= \[(.*?)\n\];", page("panel.ts"), re.DOTALL)[1]
        offered = set(re.findall(r'\["([\w-]+)"', listed))
        # "live" is a word of the protocol; rest states have no motion to show.
        self.assertEqual((offered - {"live"}) | {"static"}, set(self.known("stepper")))

    def test_shapes_of_obstacles(self):
        # The page draws every shape by its triangles, but for those that it knows by name.
        by_name = set(re.findall(r'\.shape === "([\w-]+)"', page("spheres.ts")))
        self.assertTrue(by_name)
        self.assertLessEqual(by_name, set(self.known("obstacle.ball.shape", "press.toml")))


if __name__ == "__main__":
    unittest.main()
