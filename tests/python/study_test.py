"""sinew.study: designs, resume, failures, engines, sensitivity."""

import importlib.util
import json
import os
import pathlib
import signal
import subprocess
import sys
import textwrap
import time
import unittest

import numpy as np
import sinew
from python_support import BEAM, PythonTest, beam
from sinew.study import (Dask, Local, Morris, Range, Slurm, Sobol, Study, Table, design_of)

HERE = str(pathlib.Path(__file__).resolve().parent)
VARY = {"beam.young": Range(50e3, 200e3, grid=3), "beam.poisson": [0.3, 0.45]}


# Measures for the tests: importable by the workers.
def lowest(result):
    return {"lowest": result.summary["probes"]["tip"]["displacement"][1]}


def dies_once(result):
    """Ends its process at the first run of one point."""
    mark = pathlib.Path(os.environ["SINEW_TEST_MARK"])
    if result.summary["model_hash"] and not mark.exists():
        mark.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return {}


def dies_always(result):
    os.kill(os.getpid(), signal.SIGKILL)


@unittest.skipIf(importlib.util.find_spec("h5py") is None, "h5py is not installed")
class FieldsTest(PythonTest):
    def test_fields_of_every_run(self):
        import h5py
        study = Study(beam(duration=0.02), {"beam.young": [50e3, 100e3]})
        study.run(self.dir / "study")  # first without: the rows alone
        table = study.run(self.dir / "study", fields=True)
        self.assertEqual(len(table.finished), 2)
        result = sinew.run(beam(duration=0.02), set={"beam.young": 100e3})
        with h5py.File(self.dir / "study" / "fields.h5") as file:
            self.assertEqual(sorted(file), ["000000", "000001"])
            run = file["000001"]
            self.assertEqual(run.attrs["beam.young"], 100e3)
            np.testing.assert_array_equal(run["positions"], result.positions)
            np.testing.assert_array_equal(run["rest_positions"], result.rest_positions)
        before = (self.dir / "study/runs/000001.npz").stat().st_mtime_ns
        study.run(self.dir / "study", fields=True)
        self.assertEqual((self.dir / "study/runs/000001.npz").stat().st_mtime_ns, before)


class ReportTest(PythonTest):
    def test_lists_and_names_are_places_of_their_own(self):
        study = Study(beam(duration=0.01), {"beam.cells": [[1, 1, 4], [2, 2, 8]],
                                            "beam.law": ["neo-hookean", "lloyd"]})
        table = study.run(self.dir / "study")
        page = sinew.report.of_study(study, table, "Meshes", "tip.uy")
        if importlib.util.find_spec("matplotlib") is not None:
            for label in ("[2, 2, 8]", "lloyd"):
                self.assertIn(f"<!-- {label} -->", page)  # matplotlib names what it draws

    def test_a_page_of_a_study(self):
        study = Study(beam(duration=0.02), {"beam.young": Range(50e3, 200e3, grid=3),
                                            "beam.poisson": [0.3, 0.7]})
        table = study.run(self.dir / "study")
        page = sinew.report.of_study(study, table, "A <study>", "tip.uy",
                                     {"beam.young": {"mean": 1.0, "spread": 0.1}})
        self.assertIn("A &lt;study&gt;", page)
        self.assertIn("3 of 6 runs finished", page)
        self.assertIn("<h2>Failed</h2>", page)
        self.assertIn("<h2>Effects on tip.uy</h2>", page)
        if importlib.util.find_spec("matplotlib") is not None:
            self.assertEqual(page.count("<svg"), 2)
            self.assertEqual(page, sinew.report.of_study(
                study, table, "A <study>", "tip.uy",
                {"beam.young": {"mean": 1.0, "spread": 0.1}}))


class DesignTest(PythonTest):
    def test_grid(self):
        points = design_of("grid", VARY, 0, 0)
        self.assertEqual(len(points), 6)
        self.assertEqual(points[0], {"beam.young": 50e3, "beam.poisson": 0.3})
        self.assertEqual(points[-1], {"beam.young": 200e3, "beam.poisson": 0.45})

    def test_latin_and_sobol(self):
        vary = {"a": Range(0, 1), "b": Range(1, 100, log=True), "c": ["x", "y"]}
        points = design_of("latin", vary, 50, 1)
        self.assertEqual(points, design_of("latin", vary, 50, 1))
        self.assertEqual(sorted(int(50 * p["a"]) for p in points), list(range(50)))
        self.assertEqual(sorted(int(50 * np.log10(p["b"]) / 2) for p in points), list(range(50)))
        self.assertEqual(sum(p["c"] == "x" for p in points), 25)
        if importlib.util.find_spec("scipy") is not None:
            a = [p["a"] for p in design_of("sobol", vary, 64, 1)]
            self.assertEqual(sorted(int(64 * x) for x in a), list(range(64)))

    def test_mistakes(self):
        for bad in (lambda: Range(1, 1), lambda: Range(0, 1, log=True), lambda: Range(0, np.inf),
                    lambda: design_of("latin", {}, 5, 0), lambda: design_of("latin", VARY, 0, 0),
                    lambda: design_of("random", VARY, 5, 0),
                    lambda: design_of("grid", {"a": []}, 5, 0), lambda: Sobol(3), lambda: Morris(1)):
            self.assertRaises(sinew.UsageError, bad)


class SensitivityTest(PythonTest):
    # Ishigami and Homma 1990: known indices.
    VARY = {k: Range(-np.pi, np.pi) for k in "abc"}

    @staticmethod
    def table(points):
        rows = [{"run": i, "status": "finished", "error": "",
                 "y": np.sin(p["a"]) + 7 * np.sin(p["b"])**2 + 0.1 * p["c"]**4 * np.sin(p["a"])}
                for i, p in enumerate(points)]
        return Table(rows)

    @unittest.skipIf(importlib.util.find_spec("scipy") is None, "scipy is not installed")
    def test_sobol(self):
        sobol = Sobol(2048, seed=3)
        table = self.table(sobol.points(self.VARY))
        self.assertEqual(len(table), 2048 * 5)
        found = sobol.analyse(self.VARY, table, "y")
        for key, first, total in (("a", 0.3139, 0.5576), ("b", 0.4424, 0.4424), ("c", 0.0, 0.2437)):
            self.assertAlmostEqual(found[key].first, first, delta=0.02)
            self.assertAlmostEqual(found[key].total, total, delta=0.02)
        table.rows[5]["status"] = "failed"
        self.assertTrue(np.isfinite(sobol.analyse(self.VARY, table, "y")["a"].first))

    def test_morris(self):
        morris = Morris(20, seed=1)
        rows = [{"run": i, "status": "finished", "error": "", "y": 3 * p["a"] - 2 * p["b"]}
                for i, p in enumerate(morris.points({k: Range(0, 1) for k in "abc"}))]
        found = morris.analyse({k: Range(0, 1) for k in "abc"}, Table(rows), "y")
        for key, mean in (("a", 3), ("b", 2), ("c", 0)):
            self.assertAlmostEqual(found[key].mean, mean)
            self.assertAlmostEqual(found[key].spread, 0)


class StudyTest(PythonTest):
    def setUp(self):
        super().setUp()
        before = os.environ.get("PYTHONPATH", "")
        os.environ["PYTHONPATH"] = os.pathsep.join([HERE, before])
        os.environ["SINEW_TEST_MARK"] = str(self.dir / "mark")
        self.addCleanup(os.environ.__setitem__, "PYTHONPATH", before)

    def study(self, **options):
        return Study(beam(duration=0.05), VARY, **options)

    def check(self, table):
        """Every row has the bits of a run alone."""
        self.assertEqual([row["run"] for row in table], list(range(6)))
        for row in table:
            point = {key: row[key] for key in VARY}
            self.assertEqual(row["state_hash"], sinew.run(beam(duration=0.05), set=point).state_hash)

    def test_local(self):
        seen = []
        table = self.study(measure=lowest).run(self.dir / "s", workers=2,
                                               progress=lambda *now: seen.append(now))
        self.check(table)
        self.assertEqual((seen[0][:2], seen[-1][:2]), ((0, 6), (6, 6)))
        self.assertTrue(np.array_equal(table.column("lowest"), table.column("tip.uy")))
        self.assertEqual(len((self.dir / "s" / "table.csv").read_text().splitlines()), 7)
        again = self.study(measure=lowest).run(self.dir / "s", workers=2)
        self.assertEqual(again.rows, table.rows)  # nothing was done again
        with self.assertRaisesRegex(sinew.UsageError, "no column 'tip.uz2'"):
            table.column("tip.uz2")

    def test_numbers_of_numpy(self):
        table = Study(beam(duration=0.01), {"limit_sweeps": np.array([3, 4])}).run(self.dir / "s",
                                                                                workers=2)
        self.assertEqual([row["limit_sweeps"] for row in table], [3, 4])
        self.assertEqual(len(table.finished), 2)

    def test_a_file(self):
        file = self.write("beam.toml", "duration = 0.05\n" + BEAM)
        self.check(Study(file, VARY).run(self.dir / "s", workers=2))

    def test_another_study_is_not_overwritten(self):
        self.study().run(self.dir / "s", workers=2)
        with self.assertRaisesRegex(sinew.UsageError, "other points"):
            self.study().run(self.dir / "s", design="latin", samples=3)
        with self.assertRaisesRegex(sinew.UsageError, "other scene or settings"):
            Study(beam(duration=0.06), VARY).run(self.dir / "s")
        with self.assertRaisesRegex(sinew.UsageError, "other scene or settings"):
            self.study(measure=lowest).run(self.dir / "s")
        with self.assertRaisesRegex(sinew.UsageError, "no lambda"):
            self.study(measure=lambda result: {}).run(self.dir / "u")
        cube = 0.1 * np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], float)
        def one_tet(size):
            scene = sinew.Scene(duration=0.01)
            scene.body("t", nodes=size * cube, tets=[[0, 1, 2, 3]])
            scene.pin("p", select={"nodes": [0]})
            return Study(scene, {"t.young": [1e4]})
        one_tet(1.0).run(self.dir / "v")
        with self.assertRaisesRegex(sinew.UsageError, "other scene"):
            one_tet(2.0).run(self.dir / "v")  # the same text, another mesh
        mesh = self.write("t.mesh", "MeshVersionFormatted 1\nDimension 3\nVertices\n4\n0 0 0 0\n"
                          "0.1 0 0 0\n0 0.1 0 0\n0 0 0.1 0\nTetrahedra\n1\n1 2 3 4 0\nEnd\n")
        file = self.write("t.toml", "duration = 0.01\n[body.t]\nmesh = \"t.mesh\"\n"
                          "[pin.p]\nselect = { nodes = [0] }\n")
        Study(file, {"t.young": [1e4]}).run(self.dir / "w")
        mesh.write_text(mesh.read_text().replace("0 0 0.1 0", "0 0 0.2 0"))
        with self.assertRaisesRegex(sinew.UsageError, "other scene"):
            Study(file, {"t.young": [1e4]}).run(self.dir / "w")
        (self.dir / "t").mkdir()
        (self.dir / "t" / "mine.txt").touch()
        with self.assertRaisesRegex(sinew.UsageError, "not empty"):
            self.study().run(self.dir / "t")

    def test_failures_are_kept_apart_and_named(self):
        vary = {"beam.young": [150e3, -1.0, 100e3]}
        table = Study(beam(duration=0.02), vary).run(self.dir / "s", workers=2)
        self.assertEqual([row["status"] for row in table], ["finished", "failed", "finished"])
        self.assertIn("young", table.failed.rows[0]["error"])
        self.assertIn("young", (self.dir / "s" / "failures.csv").read_text())
        self.assertEqual(len(table.finished), 2)
        with self.assertRaisesRegex(sinew.InputError, "yuong"):
            Study(beam(), {"beam.yuong": [1.0]}).run(self.dir / "t")

    def test_a_worker_that_dies_loses_nothing(self):
        self.check(self.study(measure=dies_once).run(self.dir / "s", workers=2))

    def test_a_run_that_always_brings_its_process_down(self):
        table = Study(beam(duration=0.02), {"beam.young": [1e5]},
                      measure=dies_always).run(self.dir / "s", workers=1)
        self.assertEqual(table.rows[0]["error"], "its process died")

    def test_killed_and_resumed(self):
        code = textwrap.dedent(f"""
            import sys
            sys.path.insert(0, {HERE!r})
            from python_support import beam
            from sinew.study import Study
            from study_test import VARY
            if __name__ == "__main__":
                Study(beam(duration=0.05), VARY).run({str(self.dir / 's')!r}, workers=1,
                      progress=lambda done, *_: print(done, flush=True))
        """)
        script = self.write("go.py", code)
        child = subprocess.Popen([sys.executable, str(script)], stdout=subprocess.PIPE, text=True,
                                 start_new_session=True)
        for line in child.stdout:
            if int(line) >= 2:
                break
        os.killpg(child.pid, signal.SIGKILL)
        child.stdout.close()
        child.wait()
        done = {f.name: f.read_bytes() for f in (self.dir / "s" / "runs").glob("*.json")}
        self.assertGreaterEqual(len(done), 2)
        table = self.study().run(self.dir / "s", workers=2)
        self.check(table)
        for name, bytes_before in done.items():
            self.assertEqual((self.dir / "s" / "runs" / name).read_bytes(), bytes_before)

    def test_slurm_script(self):
        text = Slurm(2).script(pathlib.Path("/x y"), [[0, 2], [1]])
        self.assertIn("0) numbers='0,2' ;;", text)
        self.assertIn("-m sinew.study --runs '/x y'", text)
        result = subprocess.run(["bash", "-n"], input=text, text=True, check=False)
        self.assertEqual(result.returncode, 0)

    def test_a_task_of_an_array(self):
        study = self.study()
        study._prepare(self.dir / "s", design_of("grid", VARY, 0, 0), study.task)
        for numbers in ("0,2,4", "1,3,5", "0,1"):
            subprocess.run([sys.executable, "-m", "sinew.study", "--runs",
                            str(self.dir / "s"), numbers],
                           check=True)
        self.check(study.run(self.dir / "s"))


@unittest.skipIf(importlib.util.find_spec("distributed") is None, "distributed is not installed")
class DaskTest(StudyTest):
    """A real cluster of two workers; one is killed in the middle."""

    def start(self, *command):
        process = subprocess.Popen([sys.executable, "-m", *command], stdout=subprocess.DEVNULL,
                                   stderr=subprocess.DEVNULL, start_new_session=True)
        self.addCleanup(process.wait)
        self.addCleanup(lambda: process.poll() is None and os.killpg(process.pid, signal.SIGKILL))
        return process

    def cluster(self):
        file = self.dir / "scheduler.json"
        self.start("distributed.cli.dask_scheduler", "--port", "0", "--no-dashboard", "--host",
                   "127.0.0.1", "--scheduler-file", str(file))
        end = time.monotonic() + 60
        while not file.exists() and time.monotonic() < end:
            time.sleep(0.1)
        address = json.loads(file.read_text())["address"]
        workers = [self.start("distributed.cli.dask_worker", address, "--nthreads", "1",
                              "--no-dashboard", "--no-nanny", "--local-directory", str(self.dir))
                   for _ in range(2)]
        return address, workers

    def test_two_workers_one_killed(self):
        address, workers = self.cluster()
        def kill(done, count, left):
            if done == 2:
                os.killpg(workers[0].pid, signal.SIGKILL)
        self.check(self.study().run(self.dir / "s", on=address, progress=kill))

    def test_an_engine(self):
        address, _ = self.cluster()
        table = self.study().run(self.dir / "s", on=Dask(address))
        self.check(table)

    # Those of the local engine were run by the class above.
    test_local = test_a_file = test_numbers_of_numpy = test_another_study_is_not_overwritten = None
    test_failures_are_kept_apart_and_named = test_a_worker_that_dies_loses_nothing = None
    test_a_run_that_always_brings_its_process_down = test_killed_and_resumed = None
    test_slurm_script = test_a_task_of_an_array = None


class EngineTest(PythonTest):
    def test_words(self):
        with self.assertRaisesRegex(sinew.UsageError, "no engine 'cloud'"):
            Study(beam(duration=0.01), {"beam.young": [1e5]}).run(self.dir / "s", on="cloud")
        self.assertGreaterEqual(Local().workers, 1)


if __name__ == "__main__":
    unittest.main()
