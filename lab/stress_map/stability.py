# SPDX-License-Identifier: BSD-3-Clause
"""The short page of the stress matrix: verdicts by group of cells, where the twin is accurate, what it reports."""
import collections
import csv
import math
import os
import sys

import cells
import judge

sys.path.append(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
from lab import BLUE, GREY, ORANGE, RED, STYLE, plt, wrapped  # noqa: E402  (its folder is known now)

HEAD = """# Stability

`lab/run stress` writes this page. The page shows where the twin is accurate for unusual parameters and inputs. A cell
is a combination of parameters and inputs. The program changes one factor (parameter or input) at a time, then two
factors at a time, then all factors at random. For each cell the program runs the twin of the Python module, and
compares this run with a [converged run](#what-is-compared) of the same cell.

```sh
lab/run stress                # every cell: all results in out/stability/cells.csv
lab/run stress --seeds 200    # more random cells; equal seeds give equal cells
```

The exit code of `lab/run stress` is 0 only if each cell ends in one of three ways:

- **accurate**: the solver reported nothing, and torque and angles stay within {accuracy:.0f} % of the converged run;
- **degraded, reported**: `~health` has `solver_state` DEGRADED or FAILED, and a counter gives the cause. The result of
  a degraded cell may still be accurate;
- **refused with a reason**: the twin does not start, and a message states the reason.

The exit code is 1 if a run gives a NaN, crashes, takes more than {timeout:.0f} s, or is wrong without a report.
"""

MEANING = """## What is compared

Every run simulates {duration:g} s. The **converged run** computes the same cell with a shorter step, at most a tenth of
the step of the cell and at most 1/600 of a period of the joint's fastest natural mode. The **error** of a cell is the
largest difference between its run and the converged run in joint torque, output angle and motor angle, each divided by
a scale. The scale of the torque is its largest value in the run, and at least {torque:g} N·m, where the first slope of
the cup ends. The scale of an angle is its travel in the run, and at least {angle:.2f} mrad, the torsion at {torque:g}
N·m. The **drift** is the largest residual of the energy balance, divided by the work of motor and load.

## What the solver reports

| message | condition | reason |
|---|---|---|
| steps too long | the joint's fastest natural mode advances more than 0.1 rad of phase in a substep, although the twin divides long steps | the phase error of the leapfrog method is phase²/24 of the phase; at 0.1 rad this error makes 1 % of the amplitude after four periods |
| with teeth jumping | a tooth changes its space below the tip circle | the teeth ratchet, or the teeth of the gear do not fit |
| cut | the solver found the equilibrium only in smaller steps from the last state, or by inserting the wave generator anew | the state may be on another branch of equilibria |
| failed | the solver found no equilibrium | the twin keeps its last good state |
| refused | the fastest natural mode advances more than 2.48 rad in a step, or the insertion finds no equilibrium | the twin divides a step into at most 31 substeps of 0.08 rad |
"""  # noqa: E501

COLOURS = {judge.ACCURATE: BLUE, judge.DEGRADED: ORANGE, judge.REFUSED: GREY}
# File and axes of the maps.
MAPS = {"map: step and stiffness": ("map__step_and_stiffness", "step [s]", "all stiffness times [-]"),
        "map: step and speed, five teeth missing": ("map__step_and_speed__five_teeth_missing", "step [s]",
                                                    "speed limit [rpm],\n12 N·m at the motor")}


def percent(value):
    return "–" if math.isnan(value) else f"{100.0 * value:.2g} %"


def draw_map(path, judged, across, up):
    """A square a cell, its error in the square."""
    with plt.rc_context(STYLE):
        figure, axes = plt.subplots(figsize=(7.0, 2.6), constrained_layout=True)
        columns = sorted({j.cell.labels[0] for j in judged})
        rows = sorted({j.cell.labels[1] for j in judged})
        for j in judged:
            x, y = columns.index(j.cell.labels[0]), rows.index(j.cell.labels[1])
            axes.fill([x - 0.47, x + 0.47, x + 0.47, x - 0.47], [y - 0.44, y - 0.44, y + 0.44, y + 0.44],
                      color=COLOURS.get(j.verdict, RED), linewidth=0)
            axes.text(x, y, "" if math.isnan(j.error) else percent(j.error), ha="center", va="center", fontsize=6.5,
                      color="white")
        axes.set_xticks(range(len(columns)), [f"{value:g}" for value in columns])
        axes.set_yticks(range(len(rows)), [f"{value:g}" for value in rows])
        axes.set(xlim=(-0.5, len(columns) - 0.5), ylim=(-0.5, len(rows) - 0.5), xlabel=across, ylabel=up)
        axes.grid(False)
        axes.tick_params(length=0)
        axes.spines[:].set_visible(False)
        figure.savefig(path, metadata={"Software": None})
        plt.close(figure)


def by_group(judged):
    groups = collections.defaultdict(list)
    for j in judged:
        groups[j.cell.group].append(j)
    return groups


def boundary(judged):
    """In words, from the cells: how long a step may be, and what a report of the solver is worth."""
    def steps(group):
        good = [j.cell.step for j in judged if j.cell.group == group and j.verdict == judge.ACCURATE]
        return f"{max(good):g} s" if good else "no step"

    ran = [j for j in judged if not math.isnan(j.error)]
    quiet = [j for j in ran if j.verdict == judge.ACCURATE]
    flagged = [j for j in ran if j.verdict == judge.DEGRADED]
    if not quiet:
        return "No cell is accurate."
    return (f"With the shipped parameters the longest accurate step is {steps('step, load steps of 100 N.m')} under "
            f"load steps. Under reversals of the motor torque (12 N·m, four times the limit) the longest "
            f"accurate step is {steps('step, reversal at 3030 rpm')}. The solver reported nothing in {len(quiet)} "
            f"cells, whose largest error is {percent(max(j.error for j in quiet))} and whose largest "
            f"energy drift is {percent(max(j.drift for j in quiet))}. Of the {len(flagged)} degraded cells "
            f"{sum(j.error <= judge.ACCURACY for j in flagged)} are accurate, so a warning of the solver often comes "
            f"before the result is wrong.")


def group_rows(groups):
    """A row a group: cells by verdict, the largest error of those that the solver reported nothing about."""
    rows = []
    for name, members in groups.items():
        count = collections.Counter(j.verdict for j in members)
        errors = [j.error for j in members if j.verdict == judge.ACCURATE]
        other = sum(count[verdict] for verdict in judge.VERDICTS if verdict not in judge.GOOD)
        rows.append([name, len(members), *(count[verdict] or "" for verdict in judge.GOOD), other or "",
                     percent(max(errors)) if errors else "–"])
    return rows


def write(docs, judged, table):
    """docs/stability.md, its maps and .csv. `table`: makes lines of a table."""
    groups = by_group(judged)
    count = collections.Counter(j.verdict for j in judged)
    lines = [wrapped(HEAD.format(accuracy=100.0 * judge.ACCURACY, timeout=judge.TIMEOUT))]
    lines += table(["verdict", "cells"], [[verdict, count[verdict]] for verdict in judge.VERDICTS])
    wrong = [f"{j.cell.name} (error {percent(j.error)})" for j in judged if j.verdict not in judge.GOOD]
    if wrong:
        lines += ["", "These cells are wrong without a report, or have no result (group of the cell, values of its "
                  f"factors, error): {'; '.join(wrong)}. In these cells the steps are as long as the twin allows, and "
                  "the phase error of the leapfrog method grows with the time of the run."]
    lines += ["", "## Where it is accurate", "", boundary(judged), ""]
    for name, (file, across, up) in MAPS.items():
        draw_map(os.path.join(docs, "images", "stability", file + ".png"), groups[name], across, up)
        lines += [f"![{name[5:].capitalize()}: the error in each square (blue: accurate; orange: degraded, "
                  f"reported; grey: refused)](images/stability/{file}.png)", ""]
    lines += [wrapped(MEANING.format(duration=cells.DURATION, torque=judge.LEAST_TORQUE,
                                     angle=1e3 * judge.LEAST_ANGLE))]
    lines += ["[stability.csv](stability.csv) counts the cells of each group, and has the largest error of the "
              "accurate cells of the group."]
    with open(os.path.join(docs, "stability.md"), "w", encoding="utf-8") as file:
        file.write("\n".join(lines).rstrip() + "\n")
    with open(os.path.join(docs, "stability.csv"), "w", encoding="utf-8", newline="") as file:
        rows = csv.writer(file, lineterminator="\n")
        rows.writerow(["factor", "cells", *judge.GOOD, "none of these", "largest error of the accurate"])
        rows.writerows(group_rows(groups))
