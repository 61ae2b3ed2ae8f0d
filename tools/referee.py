#!/usr/bin/python3
"""Computes the reference values of the validation suite.

For each case it writes inputs for CalculiX, runs ccx, reads its results, extrapolates over meshes,
and writes validation/CASE/reference.toml, the table in validation/CASE/README.md, and the input of
the coarsest mesh as an example. The values are committed: `sinew validate` needs none of this.

Needs python3-numpy and, for most cases, ccx (Debian: calculix-ccx). libopenblas0-serial makes the
second referee, tools/referee/fem.py, several times faster.
"""

import argparse
import importlib
import pathlib
import shutil
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
MODULES = ("beam", "twist", "cook", "bending", "indentation", "vibration", "liver",
           "analytic", "gel", "composite")


def cases():
    """{name: (source, function of the runner that gives the values, job shown as an example)}"""
    known = {}
    for name in MODULES:
        known.update(importlib.import_module(f"referee.{name}").CASES)
    return known


def compute(name, case, runner):
    """Runs one case and writes its files."""
    from referee import values as output
    source, function, example = case
    print(name, flush=True)
    values = list(function(runner))
    folder = ROOT / "validation" / name
    folder.mkdir(parents=True, exist_ok=True)
    output.write_reference(folder / "reference.toml", source, values)
    output.write_table(folder / "README.md", values)
    if example:
        shutil.copyfile(runner.folder / example / "job.inp", folder / "referee.inp")
    print(output.table(values), end="", flush=True)


def main(argv):
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("case", nargs="*", help="cases to compute; none: all")
    parser.add_argument("--list", action="store_true", help="list the cases and end")
    parser.add_argument("--keep", metavar="DIR",
                        help="keep inputs and results here, and do not repeat what is there")
    parser.add_argument("--ccx", default="ccx", help="the program to run (default: ccx)")
    options = parser.parse_args(argv)
    known = cases()
    if options.list:
        for name, (source, _, _) in known.items():
            print(f"{name}: {source}")
        return
    unknown = [name for name in options.case if name not in known]
    if unknown:
        parser.error(f"no case {', '.join(unknown)}; there are: {', '.join(known)}")
    from referee.ccx import Runner
    with tempfile.TemporaryDirectory() as scratch:
        runner = Runner(options.keep or scratch, options.ccx)
        for name in options.case or known:
            compute(name, known[name], runner)


if __name__ == "__main__":
    try:
        main(sys.argv[1:])
    except Exception as problem:  # noqa: BLE001  (RefereeError; its class lives in the package)
        if type(problem).__name__ != "RefereeError":
            raise
        sys.exit(f"referee: {problem}")
