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
from collections.abc import Mapping
from typing import Any

from .. import report as pages
from ..errors import InputError
from ..shell import guarded, read_toml, show, table_of, values_of
from .point import run_from_folder
from .sensitivity import Morris, Sobol
from .study import Study
from .table import Table

PAGE = "docs/study.md"
KEYS = {"scene": str, "design": str, "samples": int, "seed": int, "trajectories": int, "vary": dict,
        "set": dict, "result": str, "fields": bool}


def read_study(file: str) -> tuple[Study, dict[str, Any]]:
    """The study of a file, and its table."""
    table = read_toml(file, KEYS, PAGE)
    if "scene" not in table:
        raise InputError("the key 'scene' is missing", f"see {PAGE}", file)
    vary = {key: values_of(key, value, file)
            for key, value in table_of(table, "vary", file, PAGE).items()}
    return Study(pathlib.Path(file).parent / table["scene"], vary, set=table.get("set", {})), table


def design_of_file(table: Mapping[str, Any]) -> str | Morris | Sobol:
    name = str(table.get("design", "grid"))
    if name == "morris":
        return Morris(table.get("trajectories", 10), table.get("seed", 0))
    if name == "saltelli":
        return Sobol(table.get("samples", 64), table.get("seed", 0))
    return name


def show_progress(done: int, count: int, left: float) -> None:
    text = f"{done} of {count} runs"
    if 0 <= left and done < count:
        text += f", about {left:.0f} s left" if left < 120 else f", about {left / 60:.0f} min left"
    show(text, done == count)


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
                     fields=bool(spec.get("fields", False)), progress=None if options.quiet else Slowly())
    answer = report(work, table, spec, out)
    if "result" in spec and spec["result"] not in table.names:
        print(f"warning: the table has no column '{spec['result']}', but {', '.join(table.names)}",
              file=sys.stderr)
    page = pathlib.Path(out) / "report.html"
    page.write_text(pages.of_study(work, table, pathlib.Path(options.file).stem,
                                   spec.get("result"), answer.get("effects", {})), encoding="utf-8")
    answer["report"] = str(page)
    if options.json:
        print(json.dumps(answer, indent=2))
    elif not options.quiet:
        for key, effect in answer.get("effects", {}).items():
            print(f"{key}: " + ", ".join(f"{name} {value:.4g}" for name, value in effect.items()))
        print(f"{answer['finished']} of {answer['runs']} runs finished: {answer['table']}, {page}")
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
    return guarded(lambda: study(parser.parse_args(arguments)), "; the same command does the rest")


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
