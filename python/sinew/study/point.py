"""One run of a study, wherever it is done."""

from __future__ import annotations

import dataclasses
import json
import os
import pathlib
import pickle
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from ..errors import Error
from ..scene import Path, Scene
from ..tasks import RunResult, run

Measure = Callable[[RunResult], Mapping[str, float]]
FIELDS = "fields"  # of a row on its way to the folder


@dataclasses.dataclass(frozen=True)
class Task:
    """What every run of a study needs; travels to other processes and machines."""

    scene: Scene | Path
    settings: Mapping[str, Any]
    measure: Measure | None
    fields: bool = False  # the rows carry the nodes' positions, for write_row()

    def run(self, number: int, point: Mapping[str, Any]) -> dict[str, Any]:
        """The row of the table: the point, the results, and how it ended."""
        row: dict[str, Any] = {"run": number, "status": "failed", "error": "", **point}
        try:
            result = run(self.scene, set={**self.settings, **point}, threads=1)
            row["status"], row["error"] = result.status, result.error
            row.update(results_of(result))
            if self.fields:
                row[FIELDS] = {"rest_positions": result.rest_positions,
                               "positions": result.positions}
            if self.measure is not None and result.status == "finished":
                row.update({name: float(v) for name, v in self.measure(result).items()})
        except Error as error:
            row["error"] = str(error)
        except Exception as error:  # of `measure`: one run does not end the study
            row["error"] = f"{type(error).__name__}: {error}"
            row["status"] = "failed"
        return row


def results_of(result: RunResult) -> dict[str, Any]:
    """The results that every row has."""
    out: dict[str, Any] = {}
    for name, probe in result.probes.items():
        for axis, value in zip("xyz", probe.displacement):
            out[f"{name}.u{axis}"] = float(value)
    for name, pin in result.summary["pins"].items():
        for axis, value in zip("xyz", pin["force"]):
            out[f"pin.{name}.f{axis}"] = float(value)
    for name, value in result.energy.items():
        out[f"energy.{name}"] = value
    out.update(steps=result.steps, frames=result.frames, time=result.time,
               volume_ratio=result.summary["volume_ratio"],
               inverted_tets=result.summary["inverted_tets"], warnings=len(result.warnings),
               state_hash=result.state_hash, wall_seconds=result.wall_seconds)
    return out


def row_file(folder: pathlib.Path, number: int) -> pathlib.Path:
    return folder / "runs" / f"{number:06}.json"


def field_file(folder: pathlib.Path, number: int) -> pathlib.Path:
    return folder / "runs" / f"{number:06}.npz"


def write_row(folder: pathlib.Path, row: dict[str, Any]) -> None:
    """Complete or absent, also if two processes write the same row. Takes the fields out of it."""
    fields = row.pop(FIELDS, None)
    if fields is not None:  # first: a row that is there has its fields
        target = field_file(folder, row["run"])
        part = target.with_suffix(f".{os.getpid()}.tmp")
        with open(part, "wb") as out:
            np.savez(out, **fields)
        part.replace(target)
    file = row_file(folder, row["run"])
    fresh = file.with_suffix(f".{os.getpid()}.tmp")
    fresh.write_text(json.dumps(row), encoding="utf-8")
    fresh.replace(file)


def run_from_folder(folder: pathlib.Path, numbers: list[int]) -> None:
    """Does these runs of a study's folder that are not done yet: in a process of another engine."""
    task: Task = pickle.loads((folder / "task.pickle").read_bytes())
    points = json.loads((folder / "study.json").read_text(encoding="utf-8"))["points"]
    for number in numbers:
        if not row_file(folder, number).exists():
            write_row(folder, task.run(number, points[number]))
