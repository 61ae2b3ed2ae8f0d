#!/usr/bin/env python3
"""Pulls the liver of scenes/liver.toml at random with budget_ms, and reports the result.

    tools/budget_run.py [--sinew BIN] [--frames 10000] [--budget 4] [--seed 1] [--out DIR]

A grab at the tip of the left lobe follows a seeded random walk. Prints frames, wall time of the
frames against the budget, residuals, the largest change of the energy. Exit status 1 if a frame is
not finite."""

import argparse
import csv
import json
import math
import random
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
FPS = 60
KEYS_A_SECOND = 4
REACH = 0.06  # of the hand from where it starts, along each axis [m]


def hand(frames, seed):
    """A [pin.hand] whose path visits random places of a box."""
    rng = random.Random(seed)
    count = max(1, math.ceil(frames / FPS * KEYS_A_SECOND))
    keys = []
    for k in range(1, count + 1):
        move = [round(rng.uniform(-REACH, REACH), 4) for _ in range(3)]
        keys.append(f"{{ time = {k / KEYS_A_SECOND}, move = {move} }}")
    return ('[pin.hand]\nselect = { side = "+x", depth = 0.01 }\nsmooth = true\n'
            "path = [\n  " + ",\n  ".join(keys) + "\n]\n")


def write_scene(file, frames, budget, seed):
    """scenes/liver.toml with the hand, in the place of the probe where it grasps."""
    text = (ROOT / "scenes/liver.toml").read_text(encoding="utf-8")
    text = text.replace("duration = 2\n",
                        f"duration = {frames / FPS}\nstepper = \"implicit\"\nbudget_ms = {budget}\n")
    text = text.replace('mesh = "meshes/', f'mesh = "{ROOT}/scenes/meshes/')
    text += f"\n{hand(frames, seed)}\n[output]\nfps = {FPS}\nvtu = false\n"
    file.write_text(text, encoding="utf-8")


def read_table(file):
    with open(file, encoding="utf-8") as f:
        return list(csv.DictReader(f))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--sinew", default=str(ROOT / "build/release/sinew"))
    parser.add_argument("--frames", type=int, default=10000)
    parser.add_argument("--budget", type=float, default=4.0, help="[ms]")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--out", help="keep the run's folder")
    parser.add_argument("--set", action="append", default=[], help="as of sinew run")
    a = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        scene = Path(temporary) / "budget.toml"
        out = Path(a.out or Path(temporary) / "out")
        write_scene(scene, a.frames, a.budget, a.seed)
        more = [word for value in a.set for word in ("--set", value)]
        subprocess.run([a.sinew, "run", scene, "-o", out, "--force", "-q", *more], check=True)
        frames = read_table(out / "frames.csv")[1:]
        energy = read_table(out / "energy.csv")
        summary = json.loads((out / "summary.json").read_text(encoding="utf-8"))

    bad = sum(not math.isfinite(float(v)) for row in energy for v in row.values())
    wall = sorted(float(row["wall [ms]"]) for row in frames)
    residual = sorted(float(row["residual"]) for row in frames)
    kinetic = max(float(row["kinetic [J]"]) for row in energy)
    newton = sum(int(row["newton_steps"]) for row in frames) / len(frames)
    products = sum(int(row["products"]) for row in frames) / len(frames)
    mesh = summary["mesh"]

    def share(values, part):
        return values[min(len(values) - 1, math.ceil(part * len(values)) - 1)]

    print(f"{len(frames)} frames of {mesh['nodes']} nodes, {mesh['tets']} tets, "
          f"budget {a.budget} ms: {summary['status']}, {bad} values not finite")
    print(f"wall [ms]   median {share(wall, 0.5):.3f}, 99 % {share(wall, 0.99):.3f}, "
          f"99.9 % {share(wall, 0.999):.3f}, largest {wall[-1]:.3f}")
    print(f"residual    median {share(residual, 0.5):.2g}, 99 % {share(residual, 0.99):.2g}, "
          f"largest {residual[-1]:.2g}")
    print(f"a frame     {newton:.2f} Newton steps, {products:.1f} products; "
          f"cut short {summary['budget']['cut_short']}, late {summary['budget']['late']}")
    print(f"body        largest kinetic energy {kinetic:.4g} J, peak stretch "
          f"{summary['peak_stretch']:.2f}, most inverted tets {summary['peak_inverted_tets']}")
    return 0 if bad == 0 and summary["status"] == "finished" else 1


if __name__ == "__main__":
    sys.exit(main())
