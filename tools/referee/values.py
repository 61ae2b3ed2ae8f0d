"""Values with their meshes: extrapolation, reference.toml, the table in the README."""

import dataclasses
import json
import math
import pathlib

BEGIN, END = "<!-- values: written by tools/referee.py -->", "<!-- end of values -->"


@dataclasses.dataclass
class Value:
    """One reference value [SI]; error: its estimated error; meshes: the value of each mesh, from
    coarse to fine."""
    variant: str
    quantity: str
    value: float
    error: float
    meshes: dict = dataclasses.field(default_factory=dict)


def observed_order(sizes, values):
    """p of v = v0 + c / n^p through the last three meshes of n cells; None where there is none
    between 0.5 and 8."""
    (n1, n2, n3), (v1, v2, v3) = sizes[-3:], values[-3:]
    if (v1 - v2) * (v2 - v3) <= 0.0:
        return None
    ratio = (v1 - v2) / (v2 - v3)

    def excess(p):
        return (n1 ** -p - n2 ** -p) / (n2 ** -p - n3 ** -p) - ratio

    low, high = 0.5, 8.0
    if excess(low) * excess(high) > 0.0:
        return None
    for _ in range(60):
        middle = (low + high) / 2.0
        low, high = (middle, high) if excess(middle) < 0.0 else (low, middle)
    return low


def extrapolate(variant, quantity, sizes, values, names="k = {}"):
    """Richardson's extrapolation over three or more meshes. The error is the whole distance from
    the finest mesh; without a clean order, the spread of the last two meshes around the finest."""
    meshes = {names.format(n): v for n, v in zip(sizes, values)}
    order = observed_order(sizes, values) if len(values) > 2 else None
    if order is None:
        value, error = values[-1], abs(values[-1] - values[-2])
    else:
        (n2, n3), (v2, v3) = sizes[-2:], values[-2:]
        value = v3 + (v3 - v2) / ((n3 / n2) ** order - 1.0)
        error = abs(value - v3)
    return Value(variant, quantity, value, error, meshes)


def rounded(value, error):
    """As many digits as the error leaves sense in, and two more."""
    if value == 0.0:
        return 0.0
    digits = 6
    if error > 0.0:
        digits = max(2, min(15, math.floor(math.log10(abs(value) / error)) + 3))
    return float(f"{value:.{digits}g}")


def write_reference(path, source, values):
    lines = [f"source = {json.dumps(source, ensure_ascii=False)}"]
    for v in values:
        lines += ["", "[[value]]", f"variant = {json.dumps(v.variant)}",
                  f"quantity = {json.dumps(v.quantity)}",
                  f"value = {rounded(v.value, v.error)!r}", f"error = {float(f'{v.error:.2g}')!r}"]
    pathlib.Path(path).write_text("\n".join(lines) + "\n", encoding="utf-8")


def table(values):
    """Markdown: a row per value, a column per mesh."""
    columns = list(dict.fromkeys(name for v in values for name in v.meshes))
    head = ["variant", "quantity", *columns, "reference", "error"]
    rows = [head, ["---"] * len(head)]
    for v in values:
        cells = [f"{v.meshes[c]:.6g}" if c in v.meshes else "" for c in columns]
        rows.append([v.variant, v.quantity, *cells, f"{rounded(v.value, v.error):.8g}",
                     f"{v.error:.2g}"])
    return "".join("| " + " | ".join(row) + " |\n" for row in rows)


def write_table(readme, values):
    """Puts the table between the marks of a README that has them."""
    readme = pathlib.Path(readme)
    if not readme.exists():
        return
    text = readme.read_text(encoding="utf-8")
    if BEGIN in text and END in text:
        before, after = text.split(BEGIN)[0], text.split(END)[1]
        readme.write_text(f"{before}{BEGIN}\n{table(values)}{END}{after}", encoding="utf-8")
