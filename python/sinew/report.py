"""HTML pages of studies and calibrations: one file each, with its pictures inside.

The pictures need matplotlib; without it a page has the tables, and says what is missing.
"""

from __future__ import annotations

import html
import io
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ._sinew import version

if TYPE_CHECKING:
    from .calibration import Calibration
    from .study import Study, Table

MOST_ROWS = 1000  # of a table on a page; table.csv has all
MOST_RESULTS = 6
INK, LINE = "#33414e", "#c0392b"

STYLE = """
:root { color-scheme: light dark; --ink: #1a1a1a; --page: #fff; --soft: #667; --rule: #d4d4da; }
@media (prefers-color-scheme: dark) {
  :root { --ink: #e8e8ea; --page: #16181c; --soft: #9aa; --rule: #3a3d44; } }
body { font: 15px/1.5 system-ui, sans-serif; max-width: 70rem; margin: 2rem auto; padding: 0 1rem;
       color: var(--ink); background: var(--page); }
h1 { font-size: 1.5rem; } h2 { font-size: 1.15rem; margin-top: 2rem; }
footer, .soft { color: var(--soft); }
figure { margin: 1rem 0; background: #fff; border-radius: 8px; padding: 8px; overflow-x: auto; }
figure svg { max-width: 100%; height: auto; display: block; margin: auto; }
.scroll { overflow: auto; max-height: 32rem; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
th, td { padding: .2rem .7rem; text-align: right; border-bottom: 1px solid var(--rule);
         white-space: nowrap; }
th { position: sticky; top: 0; background: var(--page); }
td:first-child, th:first-child { text-align: left; }
li.warning { color: #b3541e; }
"""


def _page(title: str, parts: Iterable[str]) -> str:
    body = "\n".join(parts)
    return (f'<!doctype html>\n<html lang="en">\n<head><meta charset="utf-8">'
            f'<meta name="viewport" content="width=device-width, initial-scale=1">'
            f"<title>{html.escape(title)}</title><style>{STYLE}</style></head>\n<body>\n"
            f"<h1>{html.escape(title)}</h1>\n{body}\n"
            f"<footer>Sinew {html.escape(version)}</footer>\n</body>\n</html>\n")


def _number(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.5g}"
    return html.escape(str(value))


def _table(names: Sequence[str], rows: Sequence[Sequence[Any]]) -> str:
    head = "".join(f"<th>{html.escape(n)}</th>" for n in names)
    body = "\n".join("<tr>" + "".join(f"<td>{_number(v)}</td>" for v in row) + "</tr>"
                     for row in rows)
    return f'<div class="scroll"><table><tr>{head}</tr>\n{body}</table></div>'


def _picture(figure: Any) -> str:
    import matplotlib  # type: ignore[import]
    out = io.StringIO()
    # The same bytes from the same data.
    with matplotlib.rc_context({"svg.hashsalt": "sinew"}):
        figure.savefig(out, format="svg", metadata={"Date": None, "Creator": None})
    text = out.getvalue()
    return f"<figure>{text[text.index('<svg'):]}</figure>"


def _pictures(make: Any) -> list[str]:
    """The figures that make() yields; a line that says so where matplotlib is missing."""
    try:
        return [_picture(figure) for figure in make()]
    except ImportError:
        return ['<p class="soft">Pictures need matplotlib: install python3-matplotlib.</p>']


def of_calibration(found: Calibration, title: str) -> str:
    """The page of a calibration: parameters, warnings, the curves and the residual."""
    warnings = "".join(f'<li class="warning">{html.escape(w)}</li>' for w in found.warnings)
    share = 100 * found.noise / float(np.abs(found.measured).max() or 1.0)
    rows = [(key, e.value, e.low, e.high) for key, e in found.estimates.items()]
    curve = list(zip(*(a.tolist() for a in (found.displacement, found.measured, found.fitted,
                                            found.residual))))
    return _page(title, [
        _table(["parameter", "value", "low", "high"], rows),
        f"<ul>{warnings}</ul>" if warnings else "",
        f"<p>Residual: {found.noise:.3g} N, {share:.2g} % of the largest force.</p>",
        *_pictures(lambda: [found.figure()]),
        "<h2>The curve</h2>",
        _table(["displacement [m]", "measured [N]", "fitted [N]", "residual [N]"], curve)])


def _varied_results(study: Study, table: Table, result: str | None) -> list[str]:
    """The columns to draw: the one asked for, else those of probes, pins and measures that differ
    from run to run."""
    if result is not None and result in table.names:
        return [result]
    last = ("run", "status", "error", "steps", "frames", "time", "warnings", "state_hash",
            "wall_seconds", "inverted_tets")
    found = []
    for name in table.names:
        if name in study.vary or name in last or name.startswith("energy."):
            continue
        values = np.asarray(table.column(name), float)
        spread = float(np.ptp(values[np.isfinite(values)])) if np.isfinite(values).any() else 0.0
        if spread > 1e-9 * float(np.nanmax(np.abs(values)) or 1.0):
            found.append((spread / float(np.nanmax(np.abs(values))), name))
    return [name for _, name in sorted(found, reverse=True)[:MOST_RESULTS]]


def _scatter(study: Study, table: Table, results: Sequence[str]) -> Iterable[Any]:
    """A row of plots for each result: over each varied key."""
    from matplotlib.figure import Figure  # type: ignore[import]
    from .study.designs import Range
    keys = list(study.vary)
    for result in results:
        figure = Figure(figsize=(3.4 * min(len(keys), 3), 2.7 * -(-len(keys) // 3)),
                        layout="constrained")
        y = np.asarray(table.column(result), float)
        for i, key in enumerate(keys):
            axes = figure.add_subplot(-(-len(keys) // 3), min(len(keys), 3), i + 1)
            x = [row[key] for row in table]
            if not all(isinstance(v, int | float) for v in x):  # names, lists: one place for each
                x = [str(v) for v in x]
            axes.plot(x, y, "o", color=INK, markersize=3.5, alpha=0.7)
            of = study.vary[key]
            if isinstance(of, Range) and of.log:
                axes.set_xscale("log")
            axes.set_xlabel(key)
            if i % 3 == 0:
                axes.set_ylabel(result)
        yield figure


def _bars(effects: Mapping[str, Mapping[str, float]]) -> Iterable[Any]:
    """The effects of the keys, side by side."""
    from matplotlib.figure import Figure
    names = list(next(iter(effects.values())))
    figure = Figure(figsize=(7, 0.5 + 0.5 * len(effects)), layout="constrained")
    axes = figure.add_subplot()
    place = np.arange(len(effects), dtype=float)
    for i, name in enumerate(names):
        axes.barh(place + 0.38 * i, [e.get(name, 0.0) for e in effects.values()], 0.36, label=name,
                  color=(LINE, INK)[i % 2])
    axes.set_yticks(place + 0.19 * (len(names) - 1), list(effects))
    axes.invert_yaxis()
    axes.legend()
    yield figure


def of_study(study: Study, table: Table, title: str, result: str | None = None,
             effects: Mapping[str, Mapping[str, float]] | None = None) -> str:
    """The page of a study: effects, results over the varied keys, failures, all rows.

    Args:
        result: the column to draw; None: those that differ most from run to run.
        effects: of Morris or Sobol, by key.
    """
    done = table.finished
    parts = [f"<p>{len(done)} of {len(table)} runs finished.</p>"]
    if effects:
        names = list(next(iter(effects.values())))
        parts += [f"<h2>Effects on {html.escape(result or '')}</h2>", *_pictures(lambda: _bars(effects)),
                  _table(["key", *names], [(key, *(e.get(n, float("nan")) for n in names))
                                           for key, e in effects.items()])]
    if len(done) > 0:
        results = _varied_results(study, done, result)
        parts += ["<h2>Results</h2>", *_pictures(lambda: _scatter(study, done, results))]
    if len(table.failed) > 0:
        parts += ["<h2>Failed</h2>",
                  _table(["run", *study.vary, "error"],
                         [(r["run"], *(r.get(k, "") for k in study.vary), r["error"])
                          for r in table.failed.rows[:MOST_ROWS]])]
    names = [n for n in table.names if n not in ("error", "state_hash")]
    more = f" The first {MOST_ROWS}; table.csv has all." if len(table) > MOST_ROWS else ""
    parts += ["<h2>Runs</h2>", f'<p class="soft">{more}</p>' if more else "",
              _table(names, [[row.get(n, "") for n in names] for row in table.rows[:MOST_ROWS]])]
    return _page(title, parts)
