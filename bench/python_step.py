"""What a step costs from Python: microseconds for a cube of 8 nodes, the median of nine rounds.

Usage: ./dev python bench/python_step.py
"""

import statistics
import time

import sinew

CUBE = "[body.b]\nshape = \"box\"\ncells = [1, 1, 1]\n[pin.p]\nselect = { side = \"-y\" }\n"
STEPS = 5000


def cost(act):
    rounds = []
    for _ in range(9):
        start = time.perf_counter()
        act()
        rounds.append((time.perf_counter() - start) / STEPS * 1e6)
    return statistics.median(rounds)


def main():
    sim = sinew.Simulation(CUBE, threads=1)

    def steps():
        for _ in range(STEPS):
            sim.step()

    sim.step()
    inside = cost(lambda: sim.advance(STEPS * sim.last_step))
    print(f"in one call of advance: {inside:.2f} us")
    print(f"step() from Python:     {cost(steps):.2f} us")
    held = sim.positions
    print(f"with an array held:     {cost(steps):.2f} us ({len(held)} nodes)")


if __name__ == "__main__":
    main()
