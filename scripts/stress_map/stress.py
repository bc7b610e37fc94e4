# SPDX-License-Identifier: BSD-3-Clause
"""Runs the stress matrix and writes the page of stability. See `scripts/stress --help`."""
import argparse
import collections
import concurrent.futures
import math
import os
import sys
import tempfile
import time

import cells
import judge

sys.path.append(os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "validation"))
from page import BLUE, GREY, ORANGE, RED, Page, Settings, say  # noqa: E402  (its folder is known only now)

COLOURS = {judge.ACCURATE: BLUE, judge.DEGRADED: ORANGE, judge.REFUSED: GREY}

HEAD = """# Stability

Behaviour of the twin far from its usual range: one factor at a time, two at a time, all at once at random. Every cell
below is a run of `joint_twin trial`, compared with converged runs of the same cell. One command repeats them all:

    scripts/stress

It exits 0 only if every cell is one of

- **accurate**: the solver reported nothing, and torque and angles stay within {accuracy:.0f} % of the converged run;
- **degraded, reported**: `~health` has `solver_state` DEGRADED or FAILED, and a counter gives the cause. The result may
  be good or not;
- **refused with a reason**: the twin does not start, and a message states the reason.

Never a NaN, never a hang (more than {timeout:.0f} s a run), never silently wrong; one such cell makes the exit code 1.
"""

MEANING = """The **error** is the largest difference to the converged run over {duration:g} s, of the joint torque, the
output's angle and the motor's, each over its scale: the largest torque (at least {torque:g} N·m, where the cup's first
slope ends) and the travel (at least the
{angle:.2f} mrad that belong to it). One per cent is the twin's stated accuracy: the parameters themselves are known no
better, and the catalogue allows ten times that scatter between gears. The **converged run** is the same cell at a step
that resolves a period of the joint's fastest natural mode 600 times, at most a tenth of the cell's; the **doubt** is
its difference from a run with twice the step. A new input acts from half a step before its instant (the leapfrog kicks
there), so the profile of the converged run is advanced by the difference of half steps: that half step is sampling, not
error. The **drift** is the largest energy residual over the work of motor and load.

The solver's messages on a step:

| message | condition | reason |
|---|---|---|
| steps too long | the joint's fastest natural mode (motor against output on the ring's present stiffness) advances more than 0.1 rad of phase in a substep (the twin divides a step by itself, by its parameters) | the leapfrog's phase error is phase²/24 of the phase; at 0.1 rad that makes 1 % of the amplitude after four periods |
| with teeth jumping | a tooth changes its space below the tip circle | no tooth can pass a tip unnoticed: ratcheting, or a gear whose teeth do not fit |
| cut | the ring's equilibrium was found only over a shorter path, or by repeating the insertion | the state may be on another branch |
| failed | no equilibrium was found | the last good state is held |
| refused | the natural mode advances more than 2.48 rad a step, or the insertion finds no equilibrium | a step is divided into 31 substeps of 0.08 rad at most |
"""  # noqa: E501


def short(value):
    return value if isinstance(value, str) else f"{value:g}"


def percent(value):
    return "–" if math.isnan(value) else f"{100.0 * value:.2g} %"


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
    axes.set_xlim(-0.5, max(len(judged) for _, judged in groups) - 0.5)
    axes.set_ylim(len(groups) - 0.5, -0.5)
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
    axes.set_xlim(-0.5, len(columns) - 0.5)
    axes.set_ylim(-0.5, len(rows) - 0.5)
    axes.set_xlabel(across)
    axes.set_ylabel(up)
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
    page.text(HEAD.format(accuracy=100.0 * judge.ACCURACY, timeout=judge.TIMEOUT))
    counts = collections.Counter(j.verdict for j in judged)
    page.table(["verdict", "cells"], [[verdict, counts[verdict]] for verdict in judge.VERDICTS])
    groups = collections.defaultdict(list)
    for j in judged:
        groups[j.cell.group].append(j)
    page.heading("Definitions")
    page.text(MEANING.format(duration=cells.DURATION, torque=judge.LEAST_TORQUE, angle=1e3 * judge.LEAST_ANGLE))
    page.heading("The boundary of what is accurate")
    page.text(boundary(judged))
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
              "`scripts/stress "
              "--seeds N`.")
    table_of(page, groups["random"])
    page.finish()
    path = os.path.join(settings.out, "stability.md")
    with open(path, "w", encoding="utf-8") as file:
        file.write("\n".join(page.lines).rstrip() + "\n")
    return path


def boundary(judged):
    """In words, from the cells: how long a step may be, and what the words of the solver are worth."""
    def steps(group):
        good = [j.cell.step for j in judged if j.cell.group == group and j.verdict == judge.ACCURATE]
        return f"{max(good):g} s" if good else "no step"

    ran = [j for j in judged if not math.isnan(j.error)]
    quiet = [j for j in ran if j.verdict == judge.ACCURATE]
    flagged = [j for j in ran if j.verdict == judge.DEGRADED]
    still = sum(j.error <= judge.ACCURACY for j in flagged)
    phase = max((j.phase for j in quiet), default=float("nan"))
    if not quiet:
        return "No cell is accurate."
    return (f"With the shipped parameters the longest step that is accurate is {steps('step, load steps of 100 N.m')} "
            f"under load steps and "
            f"{steps('step, reversal at 3030 rpm')} under reversals with 12 N·m at the motor, four times what it can "
            f"give. "
            f"Over all {len(quiet)} cells in which the solver reported nothing the largest error is "
            f"{percent(max(j.error for j in quiet))}, the largest energy drift {percent(max(j.drift for j in quiet))}, "
            f"and a step took "
            f"at most {phase:.2f} rad of the swing. Of the {len(flagged)} degraded cells {still} were within the "
            f"accuracy all the same: the "
            f"solver warns early rather than late.")


def parse(arguments):
    parser = argparse.ArgumentParser(
        prog="stress", description="Runs the twin far from where it is meant to run, judges each run against converged "
        "ones and writes "
        "stability.md with its maps. Exit code 1 if a cell is silently wrong, not finite, hung or crashed.")
    parser.add_argument("--tool", required=True, help=argparse.SUPPRESS)
    parser.add_argument("--docs", required=True, help=argparse.SUPPRESS)
    parser.add_argument("--seeds", type=int, default=30, metavar="N", help="random cells, seeds 1 ... N [30]")
    parser.add_argument("--only", metavar="TEXT",
                        help="only cells whose name has this in it; needs --out to write a page")
    parser.add_argument("--out", metavar="DIR", help="folder of page and figures (default: docs/ of the checkout)")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), metavar="N", help="cells at a time")
    return parser.parse_args(arguments)


def main(arguments):
    options = parse(arguments)
    chosen = [cell for cell in cells.matrix(options.seeds) if not options.only or options.only in cell.name]
    if not chosen:
        sys.exit(f"stress: no cell has '{options.only}' in its name")
    started = time.monotonic()
    judged = []
    with tempfile.TemporaryDirectory(prefix="stress.") as work:
        runner = judge.Runner(options.tool, work)
        shipped = judge.judge(runner, cells.Cell("shipped", ("parameters",)))
        if shipped.verdict != judge.ACCURATE:
            sys.exit(f"stress: the shipped parameters themselves are {shipped.verdict}: {shipped.reason}")
        with concurrent.futures.ProcessPoolExecutor(max(1, options.jobs)) as pool:
            for j in pool.map(judge.judge, [runner] * len(chosen), chosen):
                judged.append(j)
                if j.verdict not in judge.GOOD:
                    say(f"{j.verdict}: {j.cell.name}: {j.reason or 'error ' + percent(j.error)}")
                if len(judged) % 20 == 0 or len(judged) == len(chosen):
                    say(f"[{len(judged)}/{len(chosen)}] {time.monotonic() - started:.0f} s")
    out = options.out or (None if options.only else options.docs)
    if out:
        os.makedirs(out, exist_ok=True)
        say(f"page: {write_page(Settings(options.tool, os.path.abspath(out), '', '', page='stability'), judged)}")
    counts = collections.Counter(j.verdict for j in judged)
    print(", ".join(f"{counts[verdict]} {verdict}" for verdict in judge.VERDICTS if counts[verdict]))
    return 0 if all(j.verdict in judge.GOOD for j in judged) else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
