"""The fields of a study, one HDF5 file: a group for each run."""

from __future__ import annotations

import importlib.util
import pathlib
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ..errors import UsageError
from .point import field_file


def need_h5py() -> None:
    """Raises UsageError where HDF5 files cannot be written: before the runs, not after."""
    if importlib.util.find_spec("h5py") is None:
        raise UsageError("fields are written as HDF5, by h5py, which is not installed",
                         "install python3-h5py")


def write_fields(place: pathlib.Path, rows: Sequence[Mapping[str, Any]],
                 keys: Sequence[str]) -> None:
    """fields.h5: /000012/positions and /000012/rest_positions (nodes, 3) [m] of the run 12, with
    its point as attributes of the group."""
    import h5py  # type: ignore[import]
    fresh = place / "fields.h5.tmp"
    with h5py.File(fresh, "w") as out:
        out.attrs["unit"] = "m"
        for row in rows:
            source = field_file(place, int(row["run"]))
            if not source.exists():
                continue
            group = out.create_group(f"{row['run']:06}")
            for key in keys:
                group.attrs[key] = row[key]
            group.attrs["status"] = row["status"]
            with np.load(source) as arrays:
                for name in arrays.files:
                    group.create_dataset(name, data=arrays[name], compression="gzip",
                                         compression_opts=4, shuffle=True)
    fresh.replace(place / "fields.h5")
