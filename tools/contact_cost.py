#!/usr/bin/env python3
"""The cost of contact per frame: scenes with and without it, in one run, medians (docs/performance.md).

  tools/contact_cost.py [--sinew build/release/sinew] [--rounds 5]

Each scene runs to two durations on one thread; the difference of their wall times is the cost of the
time in between, without start-up.
"""
import argparse
import json
import pathlib
import statistics
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent

BEAM = """
[body.{name}]
shape = "beam"
size = [0.1, 0.1, 0.4]
cells = [8, 8, 32]
position = {position}
young = 15e3
poisson = 0.45
damping_ratio = 0.2
drag = 10
"""
BEAMS = "duration = 6\n[output]\nvtu = false\nfps = 20\n[ground]\nfriction = 0.5\n"
LOWER = BEAM.format(name="lower", position="[0, 0.05, 0]")
ON_IT = BEAM.format(name="upper", position="[0.004, 0.15, 0.003]")
BESIDE_IT = BEAM.format(name="upper", position="[0.2, 0.05, 0.003]")
LIVER = ROOT / "scenes/liver-fine.toml"
STILL = ["--set", "gravity=[0, -0.5, 0]"]
SELF = ["--set", "contact.self=true"]

# name, scene, options without contact and with it (or the scene with it), from, to [s]
CASES = [
    ("two beams W(8): on each other, and side by side", BEAMS + LOWER + BESIDE_IT,
     BEAMS + "[contact]\nfriction = 0.3\n" + LOWER + ON_IT, [], [], 4, 6),
    ("liver, 36k tets, with itself: sagging by a little", LIVER, LIVER, STILL, STILL + SELF, 0.2, 1),
    ("liver, 36k tets, with itself: falling from rest", LIVER, LIVER, [], SELF, 0.05, 0.3),
    ("liver, 36k tets, with itself: swinging to rest", LIVER, LIVER, [], SELF, 0.5, 1),
]


def measure(sinew, scene, options, start, end):
    """Wall seconds and steps from `start` to `end`."""
    got = []
    with tempfile.TemporaryDirectory() as folder:
        if isinstance(scene, str):
            path = pathlib.Path(folder) / "scene.toml"
            path.write_text(scene)
        else:
            path = scene
        for duration in (start, end):
            out = subprocess.run(
                [sinew, "run", path, "--threads", "1", "--json", "--no-output", "--quiet",
                 "--set", f"duration={duration}", *options],
                check=True, capture_output=True, text=True).stdout
            got.append(json.loads(out))
    return (got[1]["wall_seconds"] - got[0]["wall_seconds"], got[1]["steps"] - got[0]["steps"])


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sinew", default=ROOT / "build/release/sinew")
    parser.add_argument("--rounds", type=int, default=5)
    args = parser.parse_args()
    print("| scene | without [ms a frame] | with | contact adds | steps a frame |")
    print("| --- | --- | --- | --- | --- |")
    for name, without, with_it, plain, contact, start, end in CASES:
        frames = (end - start) * 60
        times = {"without": [], "with": []}
        for _ in range(args.rounds):
            times["without"].append(measure(args.sinew, without, plain, start, end)[0])
            wall, steps = measure(args.sinew, with_it, contact, start, end)
            times["with"].append(wall)
        a, b = (1e3 * statistics.median(times[k]) / frames for k in ("without", "with"))
        print(f"| {name} | {a:.2f} | {b:.2f} | {b - a:.2f} ms, {100 * (b / a - 1):.0f} % "
              f"| {steps / frames:.0f} |", flush=True)


if __name__ == "__main__":
    main()
