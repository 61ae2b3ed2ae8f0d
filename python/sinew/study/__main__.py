"""python3 -m sinew.study FILE.toml: a study from the shell, as `sinew study` (docs/study.md).

python3 -m sinew.study --runs FOLDER NUMBERS: does runs of a study, as a task of another engine.
"""

from __future__ import annotations

import argparse
import json
import os
import pathlib
import sys
import time
import tomllib
from collections.abc import Mapping
from typing import Any

from ..errors import Error, InputError
from .designs import Range, Values
from .point import run_from_folder
from .sensitivity import Morris, Sobol
from .study import Study
from .table import Table

KEYS = {"scene", "design", "samples", "seed", "trajectories", "vary", "set", "result"}


def values_of(key: str, value: Any, file: str) -> Values:
    """A range or a list of the file."""
    if isinstance(value, list) and value:
        return value
    if isinstance(value, dict):
        unknown = set(value) - {"low", "high", "log", "grid", "values"}
        if not unknown and "values" in value:
            return values_of(key, value["values"], file)
        if not unknown and {"low", "high"} <= set(value):
            return Range(**value)
    raise InputError(f"'{key}' in [vary] is no range and no list",
                     "{ low = 1e3, high = 1e4, log = true }, or [0.3, 0.4]", file)


def read_study(file: str) -> tuple[Study, dict[str, Any]]:
    """The study of a file, and its table."""
    path = pathlib.Path(file)
    try:
        table = tomllib.loads(path.read_text(encoding="utf-8"))
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise InputError(str(error), "see docs/study.md", file) from None
    for key in table:
        if key not in KEYS:
            raise InputError(f"unknown key '{key}'", f"one of {', '.join(sorted(KEYS))}", file)
    if "scene" not in table or not isinstance(table.get("vary"), dict):
        raise InputError("a study has a scene and a table [vary]", "see docs/study.md", file)
    vary = {key: values_of(key, value, file) for key, value in table["vary"].items()}
    return Study(path.parent / table["scene"], vary, set=table.get("set", {})), table


def design_of_file(table: Mapping[str, Any]) -> str | Morris | Sobol:
    name = str(table.get("design", "grid"))
    if name == "morris":
        return Morris(table.get("trajectories", 10), table.get("seed", 0))
    if name == "saltelli":
        return Sobol(table.get("samples", 64), table.get("seed", 0))
    return name


def show_progress(done: int, count: int, left: float) -> None:
    terminal = sys.stderr.isatty()
    text = f"{done} of {count} runs"
    if 0 <= left and done < count:
        text += f", about {left:.0f} s left" if left < 120 else f", about {left / 60:.0f} min left"
    print(("\r\033[K" if terminal else "") + text, end="" if terminal and done < count else "\n",
          file=sys.stderr, flush=True)


class Slowly:
    """Shows progress once a second, on a terminal, or once in ten."""

    def __init__(self) -> None:
        self.next = 0.0

    def __call__(self, done: int, count: int, left: float) -> None:
        now = time.monotonic()
        if now < self.next and done < count:
            return
        self.next = now + (1.0 if sys.stderr.isatty() else 10.0)
        show_progress(done, count, left)


def report(study: Study, table: Table, spec: Mapping[str, Any], out: str) -> dict[str, Any]:
    """What the command prints as JSON."""
    answer: dict[str, Any] = {"runs": len(table), "finished": len(table.finished),
                              "failed": len(table.failed), "table": os.path.join(out, "table.csv")}
    design = design_of_file(spec)
    if not isinstance(design, str) and "result" in spec:
        effects = design.analyse(study.vary, table, spec["result"])
        answer["effects"] = {key: {name: v for name, v in vars(e).items() if v == v}
                             for key, e in effects.items()}
    return answer


def study(options: argparse.Namespace) -> int:
    work, spec = read_study(options.file)
    out = options.out or os.path.join("out", pathlib.Path(options.file).stem)
    table = work.run(out, design=design_of_file(spec), samples=spec.get("samples", 100),
                     seed=spec.get("seed", 0), on=options.on, workers=options.workers,
                     progress=None if options.quiet else Slowly())
    answer = report(work, table, spec, out)
    if options.json:
        print(json.dumps(answer, indent=2))
    elif not options.quiet:
        for key, effect in answer.get("effects", {}).items():
            print(f"{key}: " + ", ".join(f"{name} {value:.4g}" for name, value in effect.items()))
        print(f"{answer['finished']} of {answer['runs']} runs finished: {answer['table']}")
    for row in table.failed.rows[:5]:
        print(f"run {row['run']} failed: {row['error'].splitlines()[0]}", file=sys.stderr)
    if len(table.failed) > 5:
        print(f"and {len(table.failed) - 5} more: {os.path.join(out, 'failures.csv')}",
              file=sys.stderr)
    return 0 if len(table.finished) > 0 else 5


def main(arguments: list[str]) -> int:
    if arguments[:1] == ["--runs"] and len(arguments) == 3:
        run_from_folder(pathlib.Path(arguments[1]), [int(n) for n in arguments[2].split(",") if n])
        return 0
    parser = argparse.ArgumentParser(prog="sinew study", description=__doc__)
    parser.add_argument("file", metavar="FILE")
    parser.add_argument("--out")
    parser.add_argument("--on", default="local")
    parser.add_argument("--workers", type=int, default=0)
    parser.add_argument("--json", action="store_true")
    parser.add_argument("-q", "--quiet", action="store_true")
    try:
        return study(parser.parse_args(arguments))
    except KeyboardInterrupt:
        print("\nsinew: interrupted; the same command does the rest", file=sys.stderr)
        return 130
    except Error as error:
        print(f"sinew: {error}", file=sys.stderr)
        from ..errors import _KINDS
        return next((code for code, kind in _KINDS.items() if isinstance(error, kind)), 1)
    except OSError as error:
        print(f"sinew: {error}\n  remedy: check the file and its permissions", file=sys.stderr)
        return 6


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
