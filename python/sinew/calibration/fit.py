"""Material parameters from a measured force-displacement curve, with their confidence."""

from __future__ import annotations

import dataclasses
import math
import os
import pathlib
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from ..errors import DivergedError, UsageError
from ..handles import Floats, Obstacle, Pin, Point, xyz
from ..scene import Path, Scene, overrides
from ..simulation import Settings, Simulation
from ..study.designs import Range

# Shares of a parameter's range: the step of finite differences, and the width of an interval that
# says nothing.
STEP = 1e-3
KNOWS_NOTHING = 0.5
CORRELATED = 0.98


@dataclasses.dataclass(frozen=True)
class Estimate:
    """A parameter: the best value, and the interval that holds the true one with the given
    confidence, if the noise is independent and normal and the model is right."""

    value: float
    low: float
    high: float


@dataclasses.dataclass(frozen=True)
class Calibration:
    """Result of calibrate()."""

    estimates: Mapping[str, Estimate]
    displacement: Floats  # (n,) [m]
    measured: Floats  # (n,) [N]
    fitted: Floats  # (n,) [N]
    noise: float  # standard deviation of measured - fitted [N]
    correlation: Floats  # (parameters, parameters)
    warnings: Sequence[str]  # parameters that the data do not determine, and what else is wrong
    runs: int  # curves that were computed

    @property
    def residual(self) -> Floats:
        """(n,) measured - fitted [N]."""
        return self.measured - self.fitted

    def plot(self, file: Path) -> None:
        """Writes a picture: the curves, and the residual below (PNG, SVG or PDF by the name).

        Raises:
            ImportError: matplotlib is not installed.
        """
        self.figure().savefig(os.fspath(file))

    def figure(self) -> Any:
        """The picture of plot(), a figure of matplotlib."""
        from matplotlib.figure import Figure  # type: ignore[import]
        figure = Figure(figsize=(6, 6), layout="constrained")
        curve, rest = figure.subplots(2, 1, sharex=True, height_ratios=(3, 1))
        x = 1e3 * self.displacement
        curve.plot(x, self.measured, "o", label="measured", color="#444")
        curve.plot(x, self.fitted, "-", label="Sinew", color="#c0392b")
        curve.set_ylabel("force [N]")
        curve.legend()
        values = ", ".join(f"{key} = {e.value:.4g} ({e.low:.4g} to {e.high:.4g})"
                           for key, e in self.estimates.items())
        curve.set_title(values, fontsize=9)
        rest.axhline(0.0, color="#bbb")
        rest.axhspan(-2 * self.noise, 2 * self.noise, color="#eee")
        rest.plot(x, self.residual, "o-", color="#444")
        rest.set_xlabel("displacement [mm]")
        rest.set_ylabel("residual [N]")
        return figure

    def __str__(self) -> str:
        lines = [f"{key}: {e.value:.5g}  ({e.low:.5g} to {e.high:.5g})"
                 for key, e in self.estimates.items()]
        lines.append(f"residual: {self.noise:.3g} N, "
                     f"{100 * self.noise / np.abs(self.measured).max():.2g} % of the largest force")
        return "\n".join([*lines, *(f"warning: {w}" for w in self.warnings)])


def read_curve(file: Path) -> tuple[Floats, Floats]:
    """Displacement [m] and force [N] from the first two columns of a CSV file.

    Lines that do not start with a number are headings or comments.
    """
    rows = []
    try:
        text = pathlib.Path(file).read_text(encoding="utf-8")
    except UnicodeDecodeError:
        raise UsageError(f"{file} is no text", "a CSV file: displacement [m], force [N]") from None
    for number, line in enumerate(text.splitlines(), 1):
        cells = line.replace(";", ",").split(",")
        try:
            first = float(cells[0])
        except ValueError:
            continue
        try:
            rows.append((first, float(cells[1])))
        except (ValueError, IndexError):
            raise UsageError(f"{file}:{number}: no force beside the displacement",
                             "give two numbers in every line: metres, newtons") from None
    if not rows:
        raise UsageError(f"{file} has no rows of numbers", "displacement [m], force [N]")
    array = np.array(rows)
    return array[:, 0], array[:, 1]


class _Curve:
    """The force over the displacement as the parameters vary."""

    def __init__(self, scene: Scene | Path, moved: str, direction: Point, settings: list[str],
                 displacement: Floats) -> None:
        kind, _, name = moved.partition(".")
        if kind not in ("pin", "obstacle") or not name:
            raise UsageError(f"'{moved}' cannot be moved", "\"pin.NAME\" or \"obstacle.NAME\"")
        self.scene, self.kind, self.name = scene, kind, name
        simulation = Simulation(scene, set=settings)
        names = simulation.pin_names if kind == "pin" else simulation.obstacle_names
        if name not in names:
            raise UsageError(f"the scene has no {kind} '{name}'",
                             f"one of {', '.join(names)}" if names else f"add a [{kind}.{name}]")
        length = math.sqrt(sum(d * d for d in xyz(direction)))
        if not (math.isfinite(length) and length > 0.0):
            raise UsageError(f"{list(direction)} is no direction", "such as [0, -1, 0]")
        self.direction = np.array(xyz(direction)) / length
        path = [{"time": 0.0}, *({"time": float(i), "move": (d * self.direction).tolist()}
                                 for i, d in enumerate(displacement, 1))]
        self.settings = [*settings, *overrides({
            "stepper": "static", "output.fps": 1.0, "duration": float(len(displacement)),
            f"{moved}.path": path})]
        self.count = len(displacement)
        self.runs = 0

    def force(self, point: Mapping[str, float]) -> Floats:
        """The force that moves it, along the direction [N]; nan where no rest state was found."""
        self.runs += 1
        out = np.full(self.count, np.nan)
        simulation = Simulation(self.scene, set=[*self.settings, *overrides(point)])
        handle: Pin | Obstacle = (simulation.pin(self.name) if self.kind == "pin"
                                  else simulation.obstacle(self.name))
        for i in range(self.count):
            try:
                simulation.step()
            except DivergedError:
                break
            out[i] = -float(handle.force @ self.direction)  # .force is of the tissue on it
        return out


class _Scale:
    """A parameter as a number from 0 to 1 over its range."""

    def __init__(self, of: Range) -> None:
        self.of = of

    def value(self, share: float) -> float:
        return self.of.at(share)

    def share(self, value: float) -> float:
        if self.of.log:
            return math.log(value / self.of.low) / math.log(self.of.high / self.of.low)
        return (value - self.of.low) / (self.of.high - self.of.low)


def calibrate(scene: Scene | Path, data: Path | tuple[npt.ArrayLike, npt.ArrayLike], *,
              moved: str, direction: Point, parameters: Mapping[str, Range],
              set: Settings | None = None, confidence: float = 0.95,
              progress: Callable[[int, float], None] | None = None) -> Calibration:
    """Fits material parameters to a force-displacement curve of a slow test.

    The scene is the test at rest: what holds the specimen, and the pin or obstacle that loads it.
    Its path is replaced by the displacements of the data; a rest state is found for each.

    Method: least squares (trust region, bounds from the ranges, scipy), derivatives by forward
    differences of 1/1000 of the range. The intervals are those of the linearised model,
    s^2 (J^T J)^-1 with s^2 = |residual|^2 / (n - p) and Student's t.

    Args:
        data: a CSV file (displacement [m], force [N]), or the two arrays.
        moved: "pin.NAME" or "obstacle.NAME".
        direction: of the displacement, and of the force that causes it.
        parameters: ranges by key: {"cube.young": Range(1e3, 1e5, log=True)}.
        confidence: of the intervals.
        progress: called after each curve with their number and the residual, a share of the largest
            force (root mean square).

    Raises:
        UsageError: the data, a key or scipy is missing.
        DivergedError: no rest state was found at the middle of the ranges.
    """
    try:
        from scipy import optimize, stats  # type: ignore[import]
    except ImportError:
        raise UsageError("calibrate() needs scipy", "install python3-scipy") from None
    x, y = data if isinstance(data, tuple) else read_curve(data)
    displacement, measured = np.asarray(x, float), np.asarray(y, float)
    if displacement.shape != measured.shape or displacement.ndim != 1:
        raise UsageError("displacement and force have different lengths", "give one for each")
    if not (np.isfinite(displacement).all() and np.isfinite(measured).all()):
        raise UsageError("the data hold numbers that are not finite", "remove these rows")
    if not parameters:
        raise UsageError("nothing is to be fitted", "parameters={\"cube.young\": Range(1e3, 1e5)}")
    if len(displacement) <= len(parameters):
        raise UsageError(f"{len(displacement)} rows for {len(parameters)} parameters",
                         "give more rows than parameters")
    curve = _Curve(scene, moved, direction, overrides(set), displacement)
    scales = {key: _Scale(of) for key, of in parameters.items()}

    def point(shares: Floats) -> dict[str, float]:
        return {key: s.value(float(v)) for (key, s), v in zip(scales.items(), shares)}

    middle = np.full(len(scales), 0.5)
    if not np.isfinite(curve.force(point(middle))).all():
        raise DivergedError("no rest state was found at the middle of the ranges",
                            "make the ranges smaller, or the rows closer to each other")
    size = float(np.abs(measured).max()) or 1.0

    def residual(shares: Floats) -> Floats:
        force = curve.force(point(shares))
        # Where no rest state is found the model is far off.
        off = np.where(np.isfinite(force), force - measured, 10.0 * size) / size
        if progress is not None:
            progress(curve.runs, float(np.sqrt(np.mean(off**2))))
        return np.asarray(off, float)

    found = optimize.least_squares(residual, middle, bounds=(0.0, 1.0), diff_step=STEP,
                                   xtol=1e-10, ftol=1e-12, gtol=1e-12, max_nfev=50)
    return _report(found, curve, scales, displacement, measured, size, confidence, point, stats)


def _report(found: Any, curve: _Curve, scales: Mapping[str, _Scale], displacement: Floats,
            measured: Floats, size: float, confidence: float, point: Any, stats: Any
            ) -> Calibration:
    free = len(displacement) - len(scales)
    fitted = curve.force(point(found.x))
    jacobian = np.asarray(found.jac)
    noise = float(np.sqrt(np.sum((measured - fitted) ** 2) / free))
    # Directions that the data do not see get an infinite variance instead of a division by 0.
    _, singular, directions = np.linalg.svd(jacobian, full_matrices=False)
    seen = np.maximum(singular, 1e-12 * max(float(singular.max()), 1e-300))
    covariance = (noise / size) ** 2 * (directions.T / seen**2) @ directions
    deviation = np.sqrt(np.diag(covariance))
    correlation = covariance / np.outer(np.maximum(deviation, 1e-300), np.maximum(deviation, 1e-300))
    quantile = float(stats.t.ppf(0.5 + confidence / 2.0, free))
    warnings, estimates = [], {}
    for (key, scale), share, spread in zip(scales.items(), found.x, deviation):
        half = quantile * spread
        low, high = max(0.0, share - half), min(1.0, share + half)
        estimates[key] = Estimate(scale.value(float(share)), scale.value(float(low)),
                                  scale.value(float(high)))
        if high - low > KNOWS_NOTHING:
            warnings.append(f"the data do not determine {key}: its interval covers "
                            f"{100 * (high - low):.0f} % of the range")
        elif share < 2 * STEP or share > 1.0 - 2 * STEP:
            warnings.append(f"{key} is at the end of its range: make the range larger")
    keys = list(scales)
    for i in range(len(keys)):
        for j in range(i):
            if abs(correlation[i, j]) > CORRELATED:
                warnings.append(f"the data determine {keys[j]} and {keys[i]} only together "
                                f"(correlation {correlation[i, j]:+.3f})")
    signs = np.sign(measured - fitted)
    changes = int(np.count_nonzero(signs[1:] != signs[:-1]))
    if len(signs) >= 8 and changes <= len(signs) // 5:
        warnings.append("the residual is not random: the model differs from the specimen, and the "
                        "intervals are too narrow")
    if not found.success:
        warnings.append(f"the search did not end: {found.message}")
    return Calibration(estimates, displacement, measured, fitted, noise, correlation, warnings,
                       curve.runs)
