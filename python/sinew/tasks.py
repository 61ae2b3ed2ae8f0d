"""Whole tasks, as the commands of the command line: run, resume, static, identify, converge,
validate."""

from __future__ import annotations

import dataclasses
import json
import os
import pathlib
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from . import _sinew
from .errors import UsageError
from .handles import Floats, Probe
from .scene import Path, Scene, overrides, source_of
from .simulation import Settings, Simulation

# Called with the share done, 0 to 1, and the remaining seconds (negative: unknown).
Progress = Callable[[float, float], None]


@dataclasses.dataclass(frozen=True)
class RunResult:
    """The result of a run: the content of summary.json (docs/output.md)."""

    status: str  # finished, interrupted, diverged
    folder: pathlib.Path | None  # what was written; None: nothing
    time: float  # simulated [s]
    wall_seconds: float
    steps: int
    frames: int
    stepper: str
    energy: Mapping[str, float]  # kinetic, elastic, gravity, dissipated ... [J]
    probes: Mapping[str, Probe]
    warnings: Sequence[str]
    state_hash: str
    error: str  # of a run that diverged; else empty
    summary: Mapping[str, Any]  # all of summary.json
    rest_positions: Floats  # (nodes, 3) [m]
    positions: Floats  # (nodes, 3), at the end [m]

    def table(self, name: str = "probes") -> dict[str, Floats]:
        """The columns of probes.csv, energy.csv or frames.csv, by their headings.

        Raises:
            UsageError: nothing was written, or there is no such table.
        """
        return read_table(self._file(f"{name}.csv"))

    def _file(self, name: str) -> pathlib.Path:
        if self.folder is None or not (self.folder / name).exists():
            raise UsageError(f"the run wrote no {name}", "name a folder: sinew.run(..., out='run')")
        return self.folder / name


def read_table(file: Path) -> dict[str, Floats]:
    """The columns of a CSV file of Sinew by their headings, such as "time [s]".

    Cells that are no numbers become nan. pandas.DataFrame() takes the result.
    """
    lines = pathlib.Path(file).read_text(encoding="utf-8").splitlines()
    heads = lines[0].split(",")
    rows = [line.split(",") for line in lines[1:]]

    def number(cell: str) -> float:
        try:
            return float(cell)
        except ValueError:
            return float("nan")

    return {head: np.array([number(row[i]) for row in rows]) for i, head in enumerate(heads)}


def _result(done: tuple[str, Floats, Floats], folder: Path | None) -> RunResult:
    s = json.loads(done[0])
    probes = {name: Probe(name, np.array(p["position"]), np.array(p["displacement"]))
              for name, p in s["probes"].items()}
    return RunResult(
        status=s["status"], folder=None if folder is None else pathlib.Path(folder),
        time=s["sim_seconds"], wall_seconds=s["wall_seconds"], steps=s["steps"],
        frames=s["frames"], stepper=s["stepper"], energy=s["energy"], probes=probes,
        warnings=s["warnings"], state_hash=s["state_hash"], error=s.get("error", ""), summary=s,
        rest_positions=done[1], positions=done[2])


def run(scene: Scene | Path, *, out: Path | None = None, set: Settings | None = None,
        force: bool = False, threads: int = 0, progress: Progress | None = None) -> RunResult:
    """Runs a scene to its end, as `sinew run` does.

    Args:
        out: the folder to write; default: nothing is written.
        set: values that override those of the scene.
        force: an earlier run in `out` may be replaced.
        progress: called after every frame. An exception there ends the run.

    Raises:
        InputError, UnstableError, IoError: nothing was run.
        UsageError: `out` holds a run already.
        KeyboardInterrupt: Ctrl-C; resume() goes on with what was written.
    """
    target = "" if out is None else os.fspath(out)
    return _result(_sinew.run(source_of(scene, set), target, force, threads, progress), out)


def resume(folder: Path, *, threads: int = 0, progress: Progress | None = None) -> RunResult:
    """Continues the run in a folder from its checkpoint, with the bits of an unbroken run."""
    return _result(_sinew.resume(os.fspath(folder), threads, progress), folder)


def static(scene: Scene | Path, *, set: Settings | None = None, threads: int = 0) -> Simulation:
    """The rest state of a scene, with pins and loads as at the end of its duration.

    Returns:
        The simulation at rest: positions, probes, stress, and the loads on pins.

    Raises:
        DivergedError: there is no rest state, or none was found; the message says why.
    """
    given = overrides(set)
    duration = _sinew.duration_of(source_of(scene, given))
    settings = {"stepper": "static", "output.fps": 1.0 / duration}  # one frame, at the end
    simulation = Simulation(scene, set=[*given, *overrides(settings)], threads=threads)
    simulation.step()
    return simulation


@dataclasses.dataclass(frozen=True)
class Moduli:
    """The measured moduli of a body on its mesh."""

    young: float  # [Pa]
    poisson: float
    shear: float  # [Pa]
    bulk: float  # [Pa]
    young_along: Floats  # (3,) along x, y, z [Pa]
    anisotropy: float  # 0: none


@dataclasses.dataclass(frozen=True)
class LawIdentity:
    """The behaviour that a law gives a material on a mesh (docs/methods/identify.md)."""

    law: str
    note: str  # why it could not be measured; else empty
    traction: Moduli  # by tractions on the free surface
    displacement: Moduli  # by displacement of the surface
    stable_step: float  # [s]
    step_seconds: float  # wall time of an explicit step [s]
    stretch: Floats  # of the curve; empty unless asked for
    stress: Floats  # nominal [Pa]
    expected_stress: Floats  # of the material [Pa]


def _moduli(m: Mapping[str, Any]) -> Moduli:
    return Moduli(m["young"], m["poisson"], m["shear"], m["bulk"], np.array(m["young_along"]),
                  m["anisotropy"])


def identify(scene: Scene | Path, *, laws: Sequence[str] = (), curve: bool = False,
             set: Settings | None = None, threads: int = 0) -> dict[str, LawIdentity]:
    """Measures what each law makes of the material of a scene's first body on its mesh.

    Args:
        scene: a scene, a scene file, or a mesh.
        laws: names such as "neo-hookean", "lloyd"; default: all.
        curve: measure the stress over the stretch too.
    """
    found = {}
    for one in _sinew.identify(source_of(scene, set), list(laws), curve, threads):
        found[one["law"]] = LawIdentity(
            one["law"], one["note"], _moduli(one["traction"]), _moduli(one["displacement"]),
            one["stable_step"], one["step_seconds"], np.array(one["stretch"]),
            np.array(one["stress"]), np.array(one["expected_stress"]))
    return found


@dataclasses.dataclass(frozen=True)
class Trend:
    """A probe's displacement over finer and finer meshes."""

    displacement: Floats  # (levels, 3) [m]
    order: float  # nan: nothing changes
    extrapolated: Floats  # (3,) [m]
    error: float  # estimate for the extrapolated value [m]
    converges: bool


@dataclasses.dataclass(frozen=True)
class ConvergeResult:
    """Result of converge()."""

    tets: Sequence[int]  # (levels)
    trends: Mapping[str, Trend]  # by probe
    report: Mapping[str, Any]  # as `sinew converge --json`


def converge(scene: Path, *, levels: int = 3, set: Settings | None = None, threads: int = 0,
             progress: Progress | None = None) -> ConvergeResult:
    """Runs a scene file on its mesh and on finer ones, and extrapolates its probes.

    Args:
        levels: meshes, the scene's own included: 2 to 5.
    """
    text = _sinew.converge(os.fspath(scene), overrides(set), levels, threads, progress)
    report = json.loads(text)
    trends = {}
    for name, probe in report["probes"].items():
        order = probe["order"]
        trends[name] = Trend(
            np.array(probe["displacement"]), float("nan") if order is None else order,
            np.array(probe["extrapolated"]), probe["error"], probe["converges"])
    return ConvergeResult([level["tets"] for level in report["levels"]], trends, report)


@dataclasses.dataclass(frozen=True)
class ValidateResult:
    """Result of validate()."""

    holds: bool  # every threshold
    report: Mapping[str, Any]  # as `sinew validate --json`


def validate(*cases: str, folder: Path = "validation", laws: Sequence[str] = (),
             quick: bool = False, full: bool = False, threads: int = 0,
             progress: Progress | None = None) -> ValidateResult:
    """Runs cases of the validation suite; without a name, all of them.

    Args:
        folder: where the cases are.
        laws: only these.
        quick: the first variant on the coarsest mesh of each.
        full: the finest meshes too.
    """
    report = json.loads(_sinew.validate(os.fspath(folder), list(cases), list(laws), quick, full,
                                        threads, progress))
    return ValidateResult(report.pop("holds"), report)
