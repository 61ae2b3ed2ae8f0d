#!/usr/bin/env python3
"""Writes the figures of `sinew bench` into docs/performance.md, between its marks
<!-- figures --> and <!-- /figures -->.

    ./dev bench
    tools/bench_tables.py build/bench/sinew.json docs/performance.md
"""

import json
import pathlib
import sys

BEGIN, END = "<!-- figures -->\n", "<!-- /figures -->"


def table(titles, rows):
    lines = [titles, ["---"] * len(titles), *rows]
    return "\n".join("| " + " | ".join(map(str, line)) + " |" for line in lines) + "\n"


def digits(value):
    """Three significant digits, without an exponent."""
    if value is None:
        return ""
    text = f"{value:.3g}"
    return f"{value:.0f}" if "e" in text else text


class Figures:
    def __init__(self, result):
        self.result = result
        self.rows = {(r["kernel"], r["mesh"], r["precision"], r["threads"]): r
                     for r in result["rows"]}
        meshes = {r["mesh"]: r["tets"] for r in result["rows"]}
        self.meshes = sorted(meshes, key=meshes.get)
        self.threads = [limit["threads"] for limit in result["limits"]]

    def of(self, kernel, mesh, precision, threads):
        return self.rows.get((kernel, mesh, precision, threads), {})

    def ns(self, *row):
        return digits(self.of(*row).get("ns_per_item"))

    def ms(self, *row):
        time = self.of(*row).get("time")
        return digits(time and 1e3 * time["median_s"])

    def share(self, *row):
        row = self.of(*row)
        return f"{100 * row['share_of_bound']:.0f} % of {row['bound']}" if "bound" in row else ""

    def machine(self):
        m = self.result["machine"]
        limit = self.result["limits"][0]
        text = (f"{m['processor']}, {m['cores']} cores seen, {m['instruction_set']}, "
                f"L2 {m['l2'] / 2**20:.0f} MiB a core, L3 {m['l3'] / 2**20:.0f} MiB (shared with "
                f"others), {limit['clock'] / 1e9:.2f} GHz, {limit['fma_per_cycle']:.2f} vector "
                f"multiply-adds a cycle; Sinew {self.result['version']}.\n\n")
        rows = []
        for limit in self.result["limits"]:
            cells = [limit["threads"]]
            for level in limit["bandwidth"].values():
                cells.append(f"{level['copy'] / 1e9:.1f}, {level['triad'] / 1e9:.1f}")
            rows.append(cells + [f"{limit['flops'] / 1e9:.0f}"])
        sizes = [f"{b['bytes'] / 2**20:.0f} MiB"
                 for b in self.result["limits"][0]["bandwidth"].values()]
        titles = ["threads"] + [f"{level}, {size}: copy, triad [GB/s]" for level, size in
                                zip(self.result["limits"][0]["bandwidth"], sizes)]
        spreads = sorted(r["time"]["spread"] for r in self.result["rows"])
        return text + table(titles + ["FMA [GFLOP/s]"], rows) + (
            f"\nOther load on the machine: the distance between the quartiles of a row's "
            f"repetitions is {100 * spreads[len(spreads) // 2]:.0f} % of their median in the "
            f"middle row, {100 * spreads[-1]:.0f} % in the worst.\n")

    def steps(self, kernel, unit, count):
        cells = [(p, t) for p in ("single", "double") for t in self.threads]
        titles = ["", unit + "s"] + [f"{p}, {t} thread{'s' if t > 1 else ''}" for p, t in cells]
        rows = [[mesh, f"{self.of(kernel, mesh, 'single', 1).get(count, 0):,}"] +
                [self.ns(kernel, mesh, *cell) for cell in cells] +
                [self.share(kernel, mesh, "single", 1)] for mesh in self.meshes]
        return table(titles + ["share, single, 1 thread"], rows)

    def kernels(self):
        kernels = [("network forces", "single"), ("network gather", "single"),
                   ("network volumes", "double"), ("spring forces", "single"),
                   ("spring forces", "double"), ("tangent assembly", ""),
                   ("tangent product", "single"), ("gradients iteration", "single")]
        rows = []
        for kernel, precision in kernels:
            per = next((self.of(kernel, m, precision, 1).get("unit") for m in self.meshes
                        if self.of(kernel, m, precision, 1)), "")
            scale, unit = (1e-3, "us a product") if per == "product" else (1, f"ns a {per}")
            cells = []
            for mesh in self.meshes:
                time = self.of(kernel, mesh, precision, 1).get("ns_per_item")
                share = self.share(kernel, mesh, precision, 1)
                cells.append(digits(time and time * scale) + (f"; {share}" if share else ""))
            rows.append([kernel, precision, unit] + cells)
        return table(["kernel", "precision", "per"] + self.meshes, rows)

    def frames(self):
        rows = []
        for mesh in self.meshes:
            implicit = self.of("implicit frame", mesh, "", 1)
            rest = self.of("rest state", mesh, "", 1)
            rows.append(
                [mesh] +
                [self.ms("network frame", mesh, "single", t) for t in self.threads] +
                [self.of("network frame", mesh, "single", 1).get("steps", "")] +
                [self.ms("implicit frame", mesh, "", t) for t in self.threads] +
                [f"{implicit.get('newton_steps', '')}, {implicit.get('products', '')}"] +
                [self.ms("rest state", mesh, "", t) for t in self.threads] +
                [f"{rest.get('newton_steps', '')}, {rest.get('products', '')}"])
        titles = [""]
        for name, takes in (("explicit, single", "steps"), ("implicit", "Newton steps, products"),
                            ("rest state", "Newton steps, products")):
            titles += [f"{name}, {t} thread{'s' if t > 1 else ''} [ms]" for t in self.threads]
            titles.append(takes)
        return table(titles, rows)

    def peer(self):
        rows = []
        for mesh in self.meshes:
            if self.of("bullet links", mesh, "single", 1):
                rows.append([mesh, self.ns("bullet links", mesh, "single", 1),
                             self.ns("bullet step", mesh, "single", 1),
                             self.ns("spring forces", mesh, "single", 1),
                             self.ns("spring step", mesh, "single", 1),
                             self.ns("spring step", mesh, "double", 1)])
        titles = ["", "Bullet: links, one iteration", "Bullet: step", "Sinew: forces, single",
                  "Sinew: step, single", "Sinew: step, double"]
        return table(titles, rows) if rows else "Bullet was not there.\n"

    def text(self):
        return "\n".join([
            "### The machine\n", self.machine(),
            "### A step of Verlet, network law [ns a tet]\n",
            self.steps("network step", "tet", "tets"),
            "### A step of Verlet, springs with dashpots [ns a spring]\n",
            self.steps("spring step", "spring", "springs"),
            "### Kernels, one thread\n", self.kernels(),
            "### Whole frames of 1/60 s, and rest states\n", self.frames(),
            "### Beside Bullet 3.24, one thread [ns a spring or link]\n", self.peer()])


def main(argv):
    if len(argv) != 3:
        print(__doc__, file=sys.stderr)
        return 2
    figures = Figures(json.loads(pathlib.Path(argv[1]).read_text(encoding="utf-8"))).text()
    page = pathlib.Path(argv[2])
    before, begin, rest = page.read_text(encoding="utf-8").partition(BEGIN)
    _, end, after = rest.partition(END)
    if not begin or not end:
        print(f"{page}: no {BEGIN.strip()} with a {END} after it", file=sys.stderr)
        return 1
    page.write_text(f"{before}{BEGIN}\n{figures}\n{END}{after}", encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv))
