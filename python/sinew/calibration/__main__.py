"""python3 -m sinew.calibration FILE.toml: `sinew calibrate` (docs/calibrate.md)."""

from __future__ import annotations

import argparse
import csv
import json
import pathlib
import sys
import time

from .. import report
from ..errors import InputError
from ..shell import guarded, is_kind, new_folder, read_toml, show, table_of, values_of
from ..study.designs import Range
from .fit import Calibration, calibrate

PAGE = "docs/calibrate.md"
KEYS = {"scene": str, "data": str, "moved": str, "direction": list, "confidence": float,
        "parameters": dict, "set": dict}


def read(file: str) -> tuple[dict[str, object], dict[str, Range]]:
    """The keys of a calibration's file, and the ranges of its parameters."""
    spec = read_toml(file, KEYS, PAGE)
    for key in ("scene", "data", "moved", "direction"):
        if key not in spec:
            raise InputError(f"the key '{key}' is missing", f"see {PAGE}", file)
    direction = spec["direction"]
    if not (isinstance(direction, list) and len(direction) == 3 and
            all(is_kind(x, float) for x in direction)):
        raise InputError("'direction' is no list of three numbers", "such as [0, -1, 0]", file)
    confidence = spec.setdefault("confidence", 0.95)
    if not 0.0 < confidence < 1.0:
        raise InputError("'confidence' is no number between 0 and 1", "such as 0.95", file)
    ranges = {}
    for key, value in table_of(spec, "parameters", file, PAGE).items():
        of = values_of(key, value, file)
        if not isinstance(of, Range):
            raise InputError(f"'{key}' needs a range", "{ low = 1e3, high = 1e4, log = true }", file)
        ranges[key] = of
    return spec, ranges


def as_json(found: Calibration) -> dict[str, object]:
    return {"estimates": {key: vars(e) for key, e in found.estimates.items()},
            "noise": found.noise, "correlation": found.correlation.tolist(),
            "warnings": list(found.warnings), "curves": found.runs}


def write(found: Calibration, folder: pathlib.Path, title: str) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "result.json").write_text(json.dumps(as_json(found), indent=2) + "\n",
                                        encoding="utf-8")
    with open(folder / "curve.csv", "w", encoding="utf-8", newline="") as out:
        rows = csv.writer(out)
        rows.writerow(["displacement", "measured", "fitted", "residual"])
        rows.writerows(zip(found.displacement, found.measured, found.fitted, found.residual))
    (folder / "report.html").write_text(report.of_calibration(found, title), encoding="utf-8")


def command(options: argparse.Namespace) -> int:
    spec, ranges = read(options.file)
    here = pathlib.Path(options.file).parent
    folder = new_folder(options.out, options.file)
    said = [0.0]

    def progress(curves: int, residual: float) -> None:
        now = time.monotonic()
        if now - said[0] > (0.5 if sys.stderr.isatty() else 10.0):
            said[0] = now
            show(f"curve {curves}: residual {100 * residual:.2g} % of the largest force", False)

    found = calibrate(here / str(spec["scene"]), here / str(spec["data"]),
                      moved=str(spec["moved"]), direction=spec["direction"],  # type: ignore[arg-type]
                      parameters=ranges, set=spec.get("set"),  # type: ignore[arg-type]
                      confidence=spec["confidence"],  # type: ignore[arg-type]
                      progress=None if options.quiet else progress)
    if not options.quiet and sys.stderr.isatty():
        show("", False)
    write(found, folder, pathlib.Path(options.file).stem)
    if options.json:
        print(json.dumps({**as_json(found), "folder": str(folder)}, indent=2))
    elif not options.quiet:
        print(found)
        print(f"{folder / 'report.html'}: the curves and the residual")
    return 0


def main(arguments: list[str]) -> int:
    parser = argparse.ArgumentParser(prog="sinew calibrate", description=__doc__)
    parser.add_argument("file", metavar="FILE")
    parser.add_argument("--out")
    parser.add_argument("--json", action="store_true")
    parser.add_argument("-q", "--quiet", action="store_true")
    return guarded(lambda: command(parser.parse_args(arguments)), "; nothing was written")


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
