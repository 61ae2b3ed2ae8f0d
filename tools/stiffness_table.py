#!/usr/bin/env python3
"""Implicit steps against rest states, over nine decades of stiffness and any step.

    tools/stiffness_table.py [--sinew BIN] [--body beam ...] [--k 4] [--young 1e3 ... 1e9]
        [--poisson 0.3 0.45 0.49 0.499] [--dt 1/30 1/60 1/1000] [--json FILE] [--keep DIR]

A beam of 0.1 x 0.1 x 0.4 m, k x k x 4k cells, held at one end, falls under gravity with
`stepper = "implicit"` until it rests; its tip is compared with that of `stepper = "static"`.
Prints a line per run and a table at the end. Ends with 1 where a run is not finite or its tip
is off by more than 1 % of the way that it went.

The drag is 1.5 omega and the duration 14 / omega, at least 30 steps; omega is the larger of the
beam's lowest bending frequency and SWING, that of a beam that hangs down."""

import argparse
import json
import math
import subprocess
import sys
import tempfile
import time
from fractions import Fraction
from pathlib import Path

import stiffness_bodies as bodies

ROOT = Path(__file__).resolve().parent.parent
DENSITY = 1060.0  # [kg/m3]
SWING = 2.4  # about 1.2 sqrt(g / l) of a rod that was stretched to l = 2.5 m [rad/s]
LARGEST = 0.01  # difference of the tips over the displacement

SCENE = """name = "{name}"
stepper = "{stepper}"
dt = {dt!r}
duration = {duration!r}

{body}
[pin.wall]
select = {{ side = "-z" }}

[output]
fps = {fps!r}
vtu = false
"""


def bending_frequency(young):
    """Lowest one of a slender cantilever: 1.875^2 sqrt(E I / (rho A l^4)) [rad/s]."""
    side, length = bodies.SIZE[0], bodies.SIZE[2]
    return 1.875 ** 2 * math.sqrt(young / DENSITY / 12) * side / length ** 2


def plan(name, young, dt):
    """(omega [rad/s], number of steps)."""
    omega = max(bending_frequency(min(young, bodies.FAT) if name.startswith("bone") else young),
                SWING)
    return omega, max(30, math.ceil(14 / omega / dt))


def scene(name, stepper, k, young, poisson, dt, mesh):
    omega, steps = plan(name, young, dt)
    body = bodies.body_text(name, k, young, poisson, mesh)
    return SCENE.format(name=f"{name}-{k}", stepper=stepper, dt=dt, duration=steps * dt, fps=1 / dt,
                        body=body.replace("{drag}", f"drag = {1.5 * omega:.4g}"))


def run(binary, file, threads):
    """(the summary, wall time [s]); the summary of a run that did not end has only its status."""
    begin = time.monotonic()
    r = subprocess.run([binary, "run", file, "--no-output", "--json", "--threads", str(threads)],
                       text=True, capture_output=True)
    wall = time.monotonic() - begin
    if r.returncode != 0:
        return {"status": (r.stderr.strip() or str(r.returncode)).splitlines()[0]}, wall
    return json.loads(r.stdout), wall


def tips(summary, what):
    """That of every probe, one after the other [m]."""
    return [x for p in summary["probes"].values() for x in p[what]]


def compare(implicit, rest, omega):
    """The row of two summaries; its difference is infinite if one of them has no end."""
    row = {"status": "finished", "difference": math.inf}
    if rest["status"] != "finished":
        row["status"] = rest["status"]
    if implicit["status"] != "finished":
        return {**row, "status": implicit["status"]}
    steps, work = implicit["steps"], implicit["static"]
    row.update(tip=tips(implicit, "position"), steps=steps, residual=work["residual"],
               newton_steps=work["newton_steps"] / steps, products=work["products"] / steps,
               step_cuts=implicit["step_cuts"], inverted_tets=implicit["inverted_tets"])
    if rest["status"] != "finished":
        return row
    way = math.hypot(*tips(rest, "displacement"))
    speed = math.sqrt(2 * implicit["energy"]["kinetic"] / implicit["bodies"][0]["mass"])
    row.update(static_tip=tips(rest, "position"), still_moves=speed / (omega * way),
               difference=math.dist(row["tip"], tips(rest, "position")) / way,
               static_newton_steps=rest["static"]["newton_steps"],
               static_products=rest["static"]["products"])
    return row


def print_row(row):
    def place(key):
        return "(" + " ".join(f"{x:.6g}" for x in row[key]) + ")"
    print(f"{row['body']} k {row['k']} E {row['young']:.0e} nu {row['poisson']:<5} "
          f"dt {str(Fraction(row['dt']).limit_denominator(10**6)):<6}", end="  ")
    if "tip" in row:
        print(f"tip {place('tip')}  {row['steps']} steps of {row['newton_steps']:.1f} Newton "
              f"steps, {row['products']:.0f} products, cuts {row['step_cuts']}", end="  ")
    if "static_tip" in row:
        print(f"static {place('static_tip')}  off {100 * row['difference']:.2g} %, still moves "
              f"{100 * row['still_moves']:.1g} %", end="  ")
    else:
        print(row["status"], end="  ")
    print(f"{row['wall']:.1f} s{'' if good(row) else '  MISS'}", flush=True)


def good(row):
    return math.isfinite(row["difference"]) and row["difference"] <= LARGEST


def table(rows):
    """Markdown: a row per body, k and modulus, over all Poisson's ratios and steps in it."""
    lines = ["| body | k | E | runs | largest difference | Newton steps a step | products a step | "
             "step cuts | misses |", "| --- " * 9 + "|"]
    groups = {}
    for row in rows:
        groups.setdefault((row["body"], row["k"], row["young"]), []).append(row)
    for (body, k, young), group in groups.items():
        done = [r for r in group if "tip" in r] or [{}]

        def span(key, digits):
            values = [r.get(key, math.nan) for r in done]
            return f"{min(values):.{digits}f} to {max(values):.{digits}f}"
        lines.append(f"| {body} | {k} | {young:.0e} | {len(group)} | "
                     f"{100 * max(r['difference'] for r in group):.2g} % | "
                     f"{span('newton_steps', 1)} | {span('products', 0)} | "
                     f"{sum(r.get('step_cuts', 0) for r in group)} | "
                     f"{sum(not good(r) for r in group)} |")
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    number = lambda word: float(Fraction(word))  # noqa: E731
    parser.add_argument("--sinew", default=str(ROOT / "build/release/sinew"))
    parser.add_argument("--body", nargs="+", default=["beam"], choices=bodies.MESHES)
    parser.add_argument("--k", nargs="+", type=int, default=[4])
    parser.add_argument("--young", nargs="+", type=float, default=[10.0 ** n for n in range(3, 10)])
    parser.add_argument("--poisson", nargs="+", type=float, default=[0.3, 0.45, 0.49, 0.499])
    parser.add_argument("--dt", nargs="+", type=number, default=[1 / 30, 1 / 60, 1 / 1000])
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--json", metavar="FILE", help="write every run's row there, too")
    parser.add_argument("--keep", metavar="DIR", help="keep scenes and meshes")
    a = parser.parse_args()
    rows = []
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(a.keep or temporary).resolve()
        folder.mkdir(parents=True, exist_ok=True)
        for name, k in ((name, k) for name in a.body for k in a.k):
            mesh = f"{name}-{k}.mesh"
            said = bodies.MESHES[name] and bodies.MESHES[name](folder / mesh, k)
            if said:
                print(said)
            for young, poisson in ((e, nu) for e in a.young for nu in a.poisson):
                rest = None
                for dt in a.dt:
                    stem = f"{name}-{k}-{young:.0e}-{poisson}"
                    files = {"static": folder / f"{stem}-static.toml",
                             "implicit": folder / f"{stem}-{dt:.4f}.toml"}
                    for stepper, file in files.items():
                        file.write_text(scene(name, stepper, k, young, poisson, dt, mesh),
                                        encoding="utf-8")
                    rest = rest or run(a.sinew, files["static"], a.threads)[0]
                    moving, wall = run(a.sinew, files["implicit"], a.threads)
                    rows.append({"body": name, "k": k, "young": young, "poisson": poisson, "dt": dt,
                                 "wall": wall, **compare(moving, rest, plan(name, young, dt)[0])})
                    print_row(rows[-1])
                    if a.json:
                        Path(a.json).write_text(json.dumps(rows, indent=1), encoding="utf-8")
    print("\n" + table(rows))
    return 0 if all(map(good, rows)) else 1


if __name__ == "__main__":
    sys.exit(main())
