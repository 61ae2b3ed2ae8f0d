"""Which value matters: Morris' screening and Sobol's indices, as designs with an analysis."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping

import numpy as np
import numpy.typing as npt

from ..errors import UsageError
from .designs import Point, Values, points_at, require_whole, sobol_shares
from .table import Table

Floats = npt.NDArray[np.float64]


@dataclasses.dataclass(frozen=True)
class Effect:
    """The effect of a key on a result.

    Of Morris: `mean` of |elementary effect| (mu*) and its `spread` (sigma), in the result's unit
    over the whole range. Of Sobol: `first` order and `total` index, shares of the variance.
    """

    mean: float = float("nan")
    spread: float = float("nan")
    first: float = float("nan")
    total: float = float("nan")


def _results(table: Table, name: str) -> Floats:
    values = np.asarray(table.column(name), float)
    values[[row["status"] != "finished" for row in table]] = np.nan
    return values


class Morris:
    """Morris' screening (Morris 1991; mu* of Campolongo, Cariboni, Saltelli 2007).

    `trajectories` walks through the unit cube that change one key at a time by 2/3; each costs
    keys + 1 runs.
    """

    def __init__(self, trajectories: int = 10, seed: int = 0) -> None:
        require_whole("trajectories", trajectories, 2)  # one has no spread
        require_whole("seed", seed, 0, 2**63 - 1)
        self.trajectories, self.seed = trajectories, seed

    def shares(self, keys: int) -> Floats:
        """(trajectories (keys + 1), keys) from 0 to 1, on four levels."""
        random = np.random.default_rng(self.seed)
        rows = []
        for _ in range(self.trajectories):
            start = random.integers(0, 2, keys) / 3.0  # 0 or 1/3: the step of 2/3 stays inside
            up = random.random(keys) < 0.5
            x = np.where(up, start, start + 2.0 / 3.0)
            rows.append(x.copy())
            for key in random.permutation(keys):
                x[key] += 2.0 / 3.0 if up[key] else -2.0 / 3.0
                rows.append(x.copy())
        return np.array(rows)

    def points(self, vary: Mapping[str, Values]) -> list[Point]:
        return points_at(vary, self.shares(len(vary)))

    def analyse(self, vary: Mapping[str, Values], table: Table, result: str) -> dict[str, Effect]:
        """The effects of the keys on a column of the table; failed runs are left out."""
        keys = len(vary)
        x = self.shares(keys).reshape(self.trajectories, keys + 1, keys)
        y = _results(table, result).reshape(self.trajectories, keys + 1)
        moved = np.diff(x, axis=1)
        effects: list[list[float]] = [[] for _ in range(keys)]
        for walk in range(self.trajectories):
            for step in range(keys):
                key = int(np.argmax(np.abs(moved[walk, step])))
                effect = (y[walk, step + 1] - y[walk, step]) / moved[walk, step, key]
                if np.isfinite(effect):
                    effects[key].append(float(effect))
        return {name: Effect(mean=float(np.mean(np.abs(e))) if e else float("nan"),
                             spread=float(np.std(e, ddof=1)) if len(e) > 1 else float("nan"))
                for name, e in zip(vary, effects)}


class Sobol:
    """Sobol's indices by Saltelli's design (Saltelli et al. 2010): first order by their estimator,
    total by Jansen's (1999). Costs samples (keys + 2) runs; samples is a power of two."""

    def __init__(self, samples: int = 64, seed: int = 0) -> None:
        require_whole("samples", samples, 2)
        require_whole("seed", seed, 0, 2**63 - 1)
        if samples & (samples - 1):
            raise UsageError(f"{samples} samples are no power of two", "take 64, 128 ...")
        self.samples, self.seed = samples, seed

    def shares(self, keys: int) -> Floats:
        """(samples (keys + 2), keys): A, B, and A with one column of B for every key."""
        both = sobol_shares(2 * keys, self.samples, self.seed)
        a, b = both[:, :keys], both[:, keys:]
        blocks = [a, b]
        for key in range(keys):
            mixed = a.copy()
            mixed[:, key] = b[:, key]
            blocks.append(mixed)
        return np.concatenate(blocks)

    def points(self, vary: Mapping[str, Values]) -> list[Point]:
        return points_at(vary, self.shares(len(vary)))

    def analyse(self, vary: Mapping[str, Values], table: Table, result: str) -> dict[str, Effect]:
        """The indices of the keys for a column of the table; failed runs are left out."""
        y = _results(table, result).reshape(len(vary) + 2, self.samples)
        a, b = y[0], y[1]
        whole = np.concatenate([a, b])
        variance = np.nanvar(whole)
        out = {}
        for name, mixed in zip(vary, y[2:]):
            first = np.nanmean(b * (mixed - a)) / variance
            total = 0.5 * np.nanmean((a - mixed) ** 2) / variance
            out[name] = Effect(first=float(first), total=float(total))
        return out
