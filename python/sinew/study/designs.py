"""The points of a study: grid, Latin hypercube, Sobol's sequence."""

from __future__ import annotations

import dataclasses
import itertools
import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from ..errors import UsageError

Point = dict[str, Any]  # the settings of one run: {"liver.young": 5e3}


@dataclasses.dataclass(frozen=True)
class Range:
    """The values from `low` to `high`; with `log`, evenly spread over their logarithm.

    grid: the number of values in a grid.
    """

    low: float
    high: float
    log: bool = False
    grid: int = 5

    def __post_init__(self) -> None:
        if not (math.isfinite(self.low) and math.isfinite(self.high) and self.low < self.high):
            raise UsageError(f"the range from {self.low} to {self.high} is empty",
                             "give a finite low below a finite high")
        if self.log and self.low <= 0:
            raise UsageError("a logarithmic range starts above 0", "leave log out")
        if self.grid < 2:
            raise UsageError(f"a grid of {self.grid} values over a range", "give 2 or more")

    def at(self, share: float) -> float:
        """The value at a share from 0 to 1."""
        if self.log:
            return float(self.low * (self.high / self.low) ** share)
        return float(self.low + share * (self.high - self.low))


Values = Range | Sequence[Any]  # a range, or the values themselves


def value_at(values: Values, share: float) -> Any:
    """The value at a share from 0 to 1."""
    if isinstance(values, Range):
        return values.at(share)
    return values[min(int(share * len(values)), len(values) - 1)]


def points_at(vary: Mapping[str, Values], shares: npt.NDArray[np.float64]) -> list[Point]:
    """Points from shares (points, keys) from 0 to 1."""
    return [{key: value_at(values, float(s)) for (key, values), s in zip(vary.items(), row)}
            for row in shares]


# Above it a study's folder has more files than file systems like.
MOST_POINTS = 1_000_000


def require_whole(name: str, value: Any, least: int, most: int = MOST_POINTS) -> None:
    """Raises UsageError unless the value is a whole number from `least` to `most`."""
    if isinstance(value, bool) or not isinstance(value, int | np.integer) or not (
            least <= value <= most):
        raise UsageError(f"{name} is {value!r}", f"give a whole number from {least} to {most}")


def grid(vary: Mapping[str, Values]) -> list[Point]:
    """Every combination of the values."""
    lists = [[v.at(i / (v.grid - 1)) for i in range(v.grid)] if isinstance(v, Range) else list(v)
             for v in vary.values()]
    return [dict(zip(vary, values)) for values in itertools.product(*lists)]


def latin(vary: Mapping[str, Values], samples: int, seed: int) -> list[Point]:
    """A Latin hypercube (McKay, Beckman, Conover 1979): each of `samples` equal parts of every key's
    range has one point."""
    random = np.random.default_rng(seed)
    strata = np.stack([random.permutation(samples) for _ in vary], axis=1)
    return points_at(vary, (strata + random.random(strata.shape)) / samples)


def sobol_shares(keys: int, samples: int, seed: int) -> npt.NDArray[np.float64]:
    """(samples, keys) of Sobol's sequence, scrambled (Owen 1995)."""
    try:
        from scipy.stats import qmc  # type: ignore[import]
    except ImportError:
        raise UsageError("Sobol's sequence needs scipy", "install python3-scipy, or take a Latin "
                         "hypercube: design=\"latin\"") from None
    exponent = max(0, math.ceil(math.log2(samples)))
    shares: npt.NDArray[np.float64] = qmc.Sobol(keys, seed=seed).random_base2(exponent)[:samples]
    return shares


def design_of(name: str, vary: Mapping[str, Values], samples: int, seed: int) -> list[Point]:
    """The points of the design `grid`, `latin` or `sobol`."""
    if not vary:
        raise UsageError("a study varies nothing", "give a key and its range or values")
    for key, values in vary.items():
        if not isinstance(values, Range) and (isinstance(values, str) or len(values) == 0):
            raise UsageError(f"'{key}' has no values", "give a Range or a list")
    if name == "grid":
        sizes = [v.grid if isinstance(v, Range) else len(v) for v in vary.values()]
        require_whole("the number of points of the grid", math.prod(sizes), 1)
        return grid(vary)
    require_whole("samples", samples, 1)
    require_whole("seed", seed, 0, 2**63 - 1)
    if name == "latin":
        return latin(vary, samples, seed)
    if name == "sobol":
        return points_at(vary, sobol_shares(len(vary), samples, seed))
    raise UsageError(f"there is no design '{name}'", "one of grid, latin, sobol")
