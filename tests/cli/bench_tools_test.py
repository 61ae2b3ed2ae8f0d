"""tools/count_instructions and tools/bench_tables.py report correctly."""

import contextlib
import importlib.util
import io
import json
import subprocess
import sys
import unittest
from importlib.machinery import SourceFileLoader

from cli_support import ROOT, CliTest

TABLES = ROOT / "tools" / "bench_tables.py"


def load(path):
    loader = SourceFileLoader("tool", str(path))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("tool", loader))
    loader.exec_module(module)
    return module


def counts(**kernels):
    return {"compiler": "g++ 12", "target": "AVX2",
            "instructions": {name: {"per": "tet", "count": n} for name, n in kernels.items()}}


class CountTest(CliTest):
    def setUp(self):
        super().setUp()
        self.tool = load(ROOT / "tools" / "count_instructions")

    def compare(self, now, recorded):
        out = io.StringIO()
        with contextlib.redirect_stdout(out):
            return self.tool.compare(now, recorded), out.getvalue()

    def test_growth_fails_and_less_is_said(self):
        before = counts(a=100.0, b=100.0, c=100.0)
        grown, text = self.compare(counts(a=102.9, b=103.1, c=96.0, d=1.0), before)
        self.assertEqual(grown, 2)  # b, and d that is not recorded
        self.assertIn("+3.1 %  TOO MANY", text)
        self.assertIn("-4.0 %  fewer", text)
        self.assertIn("not recorded", text)

    def test_reads_what_callgrind_and_the_program_say(self):
        self.tool.run = lambda program: (
            "compiler g++ 12\ntarget AVX2\nstep 500 tet\n", {"step": 1000})
        self.assertEqual(self.tool.measure("program"), counts(step=2.0))

    def test_another_compiler_is_not_compared(self):
        other = dict(counts(a=1.0), compiler="clang 19")
        self.tool.measure = lambda program: other
        self.tool.RECORD = self.write("instructions.json", json.dumps(counts(a=1.0)))
        self.tool.shutil.which = lambda name: name
        out = io.StringIO()
        sys.argv, before = ["count_instructions", "program"], sys.argv
        self.addCleanup(setattr, sys, "argv", before)
        with contextlib.redirect_stdout(out), self.assertRaises(SystemExit) as ended:
            self.tool.main()
        self.assertEqual(ended.exception.code, self.tool.SKIPPED)
        self.assertIn("NOT CHECKED: built by clang 19", out.getvalue())


class TablesTest(CliTest):
    def fill(self, page, code=0):
        run = subprocess.run([sys.executable, TABLES, self.dir / "bench.json", page], text=True,
                             capture_output=True)
        self.assertEqual(run.returncode, code, run.stderr)

    def test_fills_the_page_and_fills_it_again(self):
        self.run_sinew("bench", "--meshes", "1", "--threads", "1", "--seconds", "0", "-q", "--json",
                       "bench.json", "--filter", "step")
        page = self.write("page.md", "before\n<!-- figures -->\n<!-- /figures -->\nafter\n")
        self.fill(page)
        text = page.read_text()
        self.assertIn("| W(1) | 20 | ", text)
        self.assertTrue(text.startswith("before\n<!-- figures -->\n\n### The machine\n"))
        self.assertTrue(text.endswith("\n<!-- /figures -->\nafter\n"))
        self.fill(page)
        self.assertEqual(page.read_text(), text)
        self.fill(self.write("other.md", "no marks\n"), code=1)


if __name__ == "__main__":
    unittest.main()
