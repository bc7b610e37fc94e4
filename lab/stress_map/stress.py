# SPDX-License-Identifier: BSD-3-Clause
"""Runs the stress matrix and writes the page of stability. See `lab/run stress --help`."""
import argparse
import collections
import concurrent.futures
import math
import os
import sys
import tempfile
import time

import arm
import cells
import judge
import stability
from stability import percent

sys.path.append(os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "validation"))
from page import BLUE, GREY, ORANGE, RED, Page, Settings, markdown_table, say  # noqa: E402  (its folder is known now)

COLOURS = {judge.ACCURATE: BLUE, judge.DEGRADED: ORANGE, judge.REFUSED: GREY}

HEAD = """# Stability, all cells

Written by `lab/run stress`; docs/stability.md has the terms.
"""


def short(value):
    return value if isinstance(value, str) else f"{value:g}"


def table_of(page, judged):
    page.table(["cell", "verdict", "error", "doubt", "drift", "Newton iterations, mean / most", "cuts", "messages"],
               [[", ".join(short(label) for label in j.cell.labels), j.verdict, percent(j.error), percent(j.doubt),
                 percent(j.drift), "–" if math.isnan(j.iterations) else f"{j.iterations:.1f} / {j.iterations_max}",
                 j.cuts, j.reason.split("\n")[0][:150]] for j in judged])


def folded(page, title, judged):
    page.text(f"<details><summary>{title}: {len(judged)} cells</summary>")
    table_of(page, judged)
    page.text("</details>")


def draw_lines(figure, groups):
    """Every line of cells as a row of squares, its error in the square."""
    axes = figure.add_subplot()
    for row, (_, judged) in enumerate(groups):
        for column, j in enumerate(judged):
            square(axes, column, row, j, short(j.cell.labels[0]))
    axes.set_yticks(range(len(groups)), [name for name, _ in groups])
    axes.set(xlim=(-0.5, max(len(judged) for _, judged in groups) - 0.5), ylim=(len(groups) - 0.5, -0.5))
    bare(axes)
    axes.set_xticks([])


def draw_map(figure, judged, across, up):
    axes = figure.add_subplot()
    columns = sorted({j.cell.labels[0] for j in judged})
    rows = sorted({j.cell.labels[1] for j in judged})
    for j in judged:
        square(axes, columns.index(j.cell.labels[0]), rows.index(j.cell.labels[1]), j, "")
    axes.set_xticks(range(len(columns)), [short(c) for c in columns])
    axes.set_yticks(range(len(rows)), [short(r) for r in rows])
    axes.set(xlim=(-0.5, len(columns) - 0.5), ylim=(-0.5, len(rows) - 0.5), xlabel=across, ylabel=up)
    bare(axes)


def square(axes, x, y, judged, label):
    axes.fill([x - 0.47, x + 0.47, x + 0.47, x - 0.47], [y - 0.44, y - 0.44, y + 0.44, y + 0.44],
              color=COLOURS.get(judged.verdict, RED), linewidth=0)
    error = "" if math.isnan(judged.error) else percent(judged.error)
    axes.text(x, y, f"{label}\n{error}".strip(), ha="center", va="center", fontsize=6.5, color="white")


def bare(axes):
    axes.grid(False)
    axes.tick_params(length=0)
    for spine in axes.spines.values():
        spine.set_visible(False)


KEY = "blue: accurate; orange: degraded, reported; grey: refused with a reason; red: none of these"
MAP_AXES = {
    "map: step and stiffness": ("step [s]", "all stiffness times [-]"),
    "map: step and speed, five teeth missing": ("step [s]", "speed limit [rpm],\n12 N·m at the motor"),
    "map: load and stiffness": ("load steps, to and fro [N·m]", "all stiffness times [-]"),
    "map: bending and contact stiffness": ("rim bending times [-]", "springs under the rim times [-]"),
}


def file_name(group):
    return "".join(c if c.isalnum() else "_" for c in group.lower())


def write_page(settings, judged):
    page = Page("stability", settings)
    page.text(HEAD)
    groups = stability.by_group(judged)
    page.heading("One factor at a time")
    lines = [(name, members) for name, members in groups.items()
             if not name.startswith("map") and name not in ("edge", "random")]
    page.figure("lines", f"Each square a run: value of the factor, below it the error. The rest as shipped ({KEY}).",
                lambda figure: draw_lines(figure, lines), size=(11.0, 0.4 * len(lines) + 0.4))
    for name, members in lines:
        folded(page, name, members)
    page.heading("Two factors")
    for name, (across, up) in MAP_AXES.items():
        if name in groups:
            page.figure(file_name(name), f"{name[5:].capitalize()}: the error in each square ({KEY}).",
                        lambda figure, m=groups[name], a=across, u=up: draw_map(figure, m, a, u), size=(7.0, 2.6))
            folded(page, name[5:].capitalize(), groups[name])
    page.heading("Edges")
    table_of(page, groups["edge"])
    page.heading("Random cells")
    page.text("Every factor at once, drawn in the logarithm from its whole range; the seed makes the cell again. More: "
              "`lab/run stress "
              "--seeds N`.")
    table_of(page, groups["random"])
    page.finish()
    path = os.path.join(settings.out, "stability.md")
    with open(path, "w", encoding="utf-8") as file:
        file.write("\n".join(page.lines).rstrip() + "\n")
    return path


def parse(arguments):
    parser = argparse.ArgumentParser(
        prog="stress", description="Runs the twin far from where it is meant to run and judges each run against "
        "converged ones. Writes all cells with their maps to out/stability and, if none was left out, the summary "
        "docs/stability.md. Exit code 1 if a cell is silently wrong, not finite, hung or crashed.")
    parser.add_argument("--tool", required=True, help=argparse.SUPPRESS)
    parser.add_argument("--docs", required=True, help=argparse.SUPPRESS)
    parser.add_argument("--seeds", type=int, default=30, metavar="N", help="random cells, seeds 1 ... N [30]")
    parser.add_argument("--only", metavar="TEXT",
                        help="only cells whose name has this in it; needs --out to write a page")
    parser.add_argument("--out", metavar="DIR",
                        help="folder of all cells and maps (default: out/stability of the checkout)")
    parser.add_argument("--arm", action="store_true",
                        help="a whole arm in closed loop in place of one joint; writes docs/arm_stress.csv and a line "
                        "of docs/arm_twin.md")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), metavar="N", help="cells at a time")
    return parser.parse_args(arguments)


def main(arguments):
    options = parse(arguments)
    if options.arm:
        with tempfile.TemporaryDirectory(prefix="stress.") as work:
            return arm.main(options.tool, options.docs, work, options.only)
    chosen = [cell for cell in cells.matrix(options.seeds) if not options.only or options.only in cell.name]
    if not chosen:
        sys.exit(f"stress: no cell has '{options.only}' in its name")
    started = time.monotonic()
    judged = []
    shipped = judge.judge(cells.Cell("shipped", ("parameters",)))
    if shipped.verdict != judge.ACCURATE:
        sys.exit(f"stress: the shipped parameters themselves are {shipped.verdict}: {shipped.reason}")
    with concurrent.futures.ProcessPoolExecutor(max(1, options.jobs)) as pool:
        for j in pool.map(judge.judge, chosen):
            judged.append(j)
            if j.verdict not in judge.GOOD:
                say(f"{j.verdict}: {j.cell.name}: {j.reason or 'error ' + percent(j.error)}")
            if len(judged) % 20 == 0 or len(judged) == len(chosen):
                say(f"[{len(judged)}/{len(chosen)}] {time.monotonic() - started:.0f} s")
    out = options.out or (None if options.only else os.path.join(os.path.dirname(options.docs), "out", "stability"))
    if out:
        os.makedirs(out, exist_ok=True)
        say(f"page: {write_page(Settings(options.tool, os.path.abspath(out), '', '', page='stability'), judged)}")
        if not options.only:
            stability.write(options.docs, out, judged, markdown_table)
    counts = collections.Counter(j.verdict for j in judged)
    print(", ".join(f"{counts[verdict]} {verdict}" for verdict in judge.VERDICTS if counts[verdict]))
    return 0 if all(j.verdict in judge.GOOD for j in judged) else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
