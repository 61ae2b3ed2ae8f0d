"""The Python of the documentation runs: the blocks of a page in order, in one namespace."""

import contextlib
import importlib.util
import io
import json
import os
import re
import subprocess
import sys
import unittest

import sinew
from python_support import ROOT, PythonTest


class DocsTest(PythonTest):
    def test_pages(self):
        before = os.getcwd()
        os.symlink(ROOT / "scenes", self.dir / "scenes")
        os.chdir(self.dir)
        self.addCleanup(os.chdir, before)
        pages = {"README.md": 1, "docs/python.md": 3, "docs/study.md": 2}
        if all(importlib.util.find_spec(name) for name in ("scipy", "matplotlib")):
            pages["docs/calibrate.md"] = 1
        for page, least in pages.items():
            text = (ROOT / page).read_text(encoding="utf-8")
            blocks = re.findall(r"(?<!-->\n)^```python\n(.*?)^```|"
                                r"^<!-- plot -->\n```python\n(.*?)^```", text, re.M | re.S)
            blocks = [a or b for a, b in blocks]
            if importlib.util.find_spec("matplotlib") is None:
                blocks = [block for block in blocks if "matplotlib" not in block]
            self.assertGreaterEqual(len(blocks), least)
            names = {"__name__": "__main__"}
            for block in blocks:
                with self.subTest(page, block=block[:60]), contextlib.redirect_stdout(io.StringIO()):
                    exec(compile(block, page, "exec"), names)  # pylint: disable=exec-used

    @unittest.skipUnless(all(importlib.util.find_spec(name) for name in ("scipy", "matplotlib")),
                         "scipy or matplotlib is not installed")
    def test_the_notebook(self):
        before = os.getcwd()
        os.symlink(ROOT / "scenes", self.dir / "scenes")
        os.chdir(self.dir)
        self.addCleanup(os.chdir, before)
        notebook = json.loads((ROOT / "docs/notebook.ipynb").read_text(encoding="utf-8"))
        # A file, since the workers of a study import the program that started them.
        code = "\n".join("".join(cell["source"]) for cell in notebook["cells"]
                         if cell["cell_type"] == "code")
        body = "".join("    " + line for line in code.splitlines(True))
        program = self.write("notebook.py", f"if __name__ == '__main__':\n{body}\n")
        done = subprocess.run([sys.executable, str(program)], cwd=self.dir, text=True, check=False,
                              capture_output=True, env={**os.environ, "MPLBACKEND": "Agg"})
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertIn("finished", done.stdout)
        self.assertIn("cube.young: ", done.stdout)

    def test_every_public_name_is_documented(self):
        for name in sinew.__all__:
            thing = getattr(sinew, name)
            if name == "__version__":
                continue
            self.assertTrue(thing.__doc__, name)
            members = vars(thing).items() if isinstance(thing, type) else ()
            for member, value in members:
                is_code = callable(value) or isinstance(value, (property, classmethod))
                if member.startswith("_") or not is_code:
                    continue
                value = value.fget if isinstance(value, property) else value
                self.assertTrue(getattr(value, "__doc__", None), f"{name}.{member}")


if __name__ == "__main__":
    unittest.main()
