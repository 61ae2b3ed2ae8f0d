"""The table of a study: a row for each run."""

from __future__ import annotations

import csv
import os
import pathlib
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from ..errors import UsageError


class Table:
    """Rows by the number of the run; every row has `run`, `status`, `error` and its point.

    pandas.DataFrame(table.rows) makes a data frame of it.
    """

    def __init__(self, rows: Sequence[Mapping[str, Any]]) -> None:
        self.rows = sorted((dict(row) for row in rows), key=lambda row: int(row["run"]))

    def __len__(self) -> int:
        return len(self.rows)

    def __iter__(self) -> Iterator[dict[str, Any]]:
        return iter(self.rows)

    @property
    def names(self) -> list[str]:
        """The columns, in the order of the first rows that have them."""
        names: dict[str, None] = {}
        for row in self.rows:
            names.update(dict.fromkeys(row))
        return list(names)

    def column(self, name: str) -> npt.NDArray[Any]:
        """The values of a column; nan for runs without one.

        Raises:
            UsageError: there is none; the message has the names.
        """
        if name not in self.names:
            raise UsageError(f"the table has no column '{name}'", f"one of {', '.join(self.names)}")
        return np.array([row.get(name, float("nan")) for row in self.rows])

    @property
    def finished(self) -> Table:
        """The runs that finished."""
        return Table([row for row in self.rows if row["status"] == "finished"])

    @property
    def failed(self) -> Table:
        """The others, with the reason in `error`."""
        return Table([row for row in self.rows if row["status"] != "finished"])

    def write(self, file: str | os.PathLike[str]) -> None:
        """Writes it as CSV."""
        path = pathlib.Path(file)
        fresh = path.with_suffix(".tmp")
        with open(fresh, "w", encoding="utf-8", newline="") as out:
            writer = csv.DictWriter(out, self.names)
            writer.writeheader()
            writer.writerows(self.rows)
        fresh.replace(path)
