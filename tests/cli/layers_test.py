"""tools/check_layers finds violations of the layers."""

import subprocess
import sys
import unittest

from cli_support import ROOT, CliTest

SCRIPT = ROOT / "tools" / "check_layers"


class LayersTest(CliTest):
    def check(self, code):
        run = subprocess.run([sys.executable, SCRIPT, self.dir], text=True, capture_output=True)
        self.assertEqual(run.returncode, code, run.stdout + run.stderr)
        return run.stdout

    def source(self, name, *includes):
        self.write(f"src/sinew/{name}", "".join(f"#include {i}\n" for i in includes))

    def test_lower_rooms_and_own_headers_are_fine(self):
        self.source("base/error.h", "<string>")
        self.source("forces/springs.h", '"sinew/base/error.h"')
        self.source("forces/springs.cpp", '"sinew/forces/springs.h"', "<immintrin.h>")
        self.assertEqual(self.check(0), "")

    def test_higher_room(self):
        self.source("solver/verlet.h")
        self.source("forces/springs.cpp", "<vector>", '"sinew/solver/verlet.h"')
        out = self.check(1)
        self.assertIn("src/sinew/forces/springs.cpp:2:", out)
        self.assertIn("forces (3) may not include solver (4)", out)

    def test_room_of_the_same_number(self):
        self.source("io/medit.h")
        self.source("model/model.h", '"sinew/io/medit.h"')
        self.assertIn("model (2) may not include io (2)", self.check(1))

    def test_unknown_rooms(self):
        self.source("attic/old.h")
        self.source("base/a.h", '"sinew/cellar/b.h"')
        out = self.check(1)
        self.assertIn("src/sinew/attic/old.h: no such room", out)
        self.assertIn("src/sinew/base/a.h:1:", out)

    def test_private_headers_in_a_public_header(self):
        self.source("base/simd.h", "<immintrin.h>", "<mpi.h>", "<cuda_runtime.h>")
        self.assertEqual(self.check(1).count("in a public header"), 3)

    def test_short_paths_and_missing_files(self):
        self.source("base/a.h", '"b.h"', '"sinew/base/none.h"')
        out = self.check(1)
        self.assertIn("write the full path", out)
        self.assertIn("no such file", out)

    def test_an_empty_tree_is_a_mistake(self):
        self.check(2)

    def test_this_repository(self):
        run = subprocess.run([sys.executable, SCRIPT], text=True, capture_output=True)
        self.assertEqual(run.returncode, 0, run.stdout)


if __name__ == "__main__":
    unittest.main()
