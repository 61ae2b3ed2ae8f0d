"""A study: its folder, what is done and what is left."""

from __future__ import annotations

import dataclasses
import hashlib
import json
import os
import pathlib
import pickle
import time
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from ..errors import UsageError
from ..scene import Path, Scene, source_of
from .. import _sinew
from .designs import Point, Range, Values, design_of
from .engines import Engine, engine_of
from .fields import need_h5py, write_fields
from .point import Measure, Task, field_file, row_file, write_row
from .sensitivity import Morris, Sobol
from .table import Table

# Called with the runs done, all runs, and the remaining seconds (negative: unknown).
Progress = Callable[[int, int, float], None]


class Study:
    """A scene and what is varied in it.

    Args:
        scene: a Scene, or the path of a scene file.
        vary: ranges or lists of values by key: {"liver.young": Range(1e3, 1e4)}.
        set: values that all runs share.
        measure: a function of the RunResult that gives more columns, {"name": number}. It has to
            be importable by other processes: a function of a module, no lambda.
    """

    def __init__(self, scene: Scene | Path, vary: Mapping[str, Values], *,
                 set: Mapping[str, Any] | None = None, measure: Measure | None = None) -> None:
        absolute: Scene | Path = scene if isinstance(scene, Scene) else os.path.abspath(os.fspath(scene))
        # Numbers of numpy become Python's, which JSON knows.
        self.vary = {key: v if isinstance(v, Range | str) else
                     [x.item() if isinstance(x, np.generic) else x for x in v]
                     for key, v in vary.items()}
        self.task = Task(absolute, dict(set or {}), measure)

    def run(self, folder: Path, *, design: str | Morris | Sobol = "grid", samples: int = 100,
            seed: int = 0, on: str | Engine = "local", workers: int = 0,
            fields: bool = False, progress: Progress | None = None) -> Table:
        """Does the runs that are not done yet, and gives the table of all.

        Args:
            folder: where the study lies: study.json, runs/, table.csv, failures.csv, fields.h5.
            design: "grid", "latin", "sobol", or an object of Morris or Sobol.
            samples: points of "latin" and "sobol".
            seed: of their random numbers.
            on: "local"; the address of a Dask scheduler, "tcp://host:8786"; "slurm"; or an Engine.
            workers: processes, or tasks of the job array; 0: as many as fit.
            fields: also fields.h5, the nodes' positions at the end of every run (needs h5py).

        Raises:
            UsageError: the folder holds another study, or a value of `vary` cannot be used.
            InputError: the scene cannot be used.
        """
        points = (design_of(design, self.vary, samples, seed) if isinstance(design, str)
                  else design.points(self.vary))
        place = pathlib.Path(folder).resolve()
        if fields:
            need_h5py()
        task = dataclasses.replace(self.task, fields=fields)
        # A mistake in the scene or a key is found here, not by every run.
        _sinew.duration_of(source_of(self.task.scene, {**self.task.settings, **points[0]}))
        self._prepare(place, points, task)
        rows = {number: row for number in range(len(points))
                if (row := self._row(place, number)) is not None and
                (not fields or row["status"] != "finished" or field_file(place, number).exists())}
        left = [(number, point) for number, point in enumerate(points) if number not in rows]
        for number, _ in left:  # of a study that kept no fields
            row_file(place, number).unlink(missing_ok=True)
        start, before = time.monotonic(), len(rows)
        if progress is not None:
            progress(len(rows), len(points), -1.0)
        if left:
            for row in engine_of(on, workers).rows(task, left, place):
                write_row(place, row)
                rows[row["run"]] = row
                if progress is not None:
                    per_run = (time.monotonic() - start) / (len(rows) - before)
                    progress(len(rows), len(points), per_run * (len(points) - len(rows)))
        table = Table(list(rows.values()))
        table.write(place / "table.csv")
        if fields:
            write_fields(place, table.rows, list(self.vary))
        if table.failed:
            table.failed.write(place / "failures.csv")
        else:
            (place / "failures.csv").unlink(missing_ok=True)
        return table

    def _identity(self) -> str:
        """Changes with the scene's text, its meshes and arrays, the settings and the measure."""
        scene, measure = self.task.scene, self.task.measure
        known = hashlib.sha256(repr(dict(self.task.settings)).encode())
        known.update(f"{measure.__module__}.{measure.__qualname__}".encode() if measure else b"")
        if isinstance(scene, Scene):
            known.update(scene.toml().encode())
            known.update(pickle.dumps((scene._bodies, scene._obstacles), protocol=4))
        else:
            known.update(pathlib.Path(scene).read_bytes())
        for file in _sinew.files_of(source_of(scene, self.task.settings)):
            if os.path.isfile(file):
                known.update(pathlib.Path(file).read_bytes())
        return known.hexdigest()

    def _prepare(self, place: pathlib.Path, points: list[Point], task: Task) -> None:
        plan = {"identity": self._identity(), "points": json.loads(json.dumps(points))}
        file = place / "study.json"
        if file.exists():
            known = json.loads(file.read_text(encoding="utf-8"))
            if known != plan:
                what = "points" if known.get("identity") == plan["identity"] else "scene or settings"
                raise UsageError(f"{place} holds a study with other {what}",
                                 "name another folder; this one keeps its results")
        elif place.exists() and any(place.iterdir()):
            raise UsageError(f"{place} is not empty and holds no study", "name another folder")
        try:
            pickled = pickle.dumps(task)
        except (pickle.PicklingError, AttributeError, TypeError) as error:
            raise UsageError(f"other processes cannot get the measure: {error}",
                             "give a function of a module, no lambda") from None
        (place / "runs").mkdir(parents=True, exist_ok=True)
        (place / "task.pickle").write_bytes(pickled)
        fresh = file.with_suffix(".tmp")
        fresh.write_text(json.dumps(plan, indent=1), encoding="utf-8")
        fresh.replace(file)

    @staticmethod
    def _row(place: pathlib.Path, number: int) -> dict[str, Any] | None:
        try:
            row = json.loads(row_file(place, number).read_text(encoding="utf-8"))
        except (OSError, ValueError):
            return None
        return row if isinstance(row, dict) else None
