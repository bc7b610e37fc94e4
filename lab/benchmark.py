# SPDX-License-Identifier: BSD-3-Clause
"""Run time against error: runs `work_precision` over its problems; writes every run to out/benchmark and the summary
docs/benchmark.md."""
import argparse
import concurrent.futures
import json
import math
import os
import platform
import subprocess
import sys

import benchmark_summary
from benchmark_runs import Progress, measure
from lab import plt

PROBLEMS = ["insertion", "drive", "operating", "levels"]
LEVELS = [1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9]
PACKAGES = ["libsundials-dev", "libsuitesparse-dev", "libboost-dev", "r-cran-desolve",
            "libeigen3-dev", "g++"]
OPTIONAL = {"RADAU5": "r-cran-desolve"}  # peers that are left out where not installed
OURS = "ours, "
THESIS = "thesis: "
# Colour by family, line by member.
STYLES = {
    "ours, ESDIRK4": ("#D55E00", "-", "o", 2.4), "ours, TR-BDF2": ("#D55E00", "--", "s", 2.4),
    "ours, leapfrog on the ring": ("#D55E00", "-", "o", 2.4),
    "ours, leapfrog on the table": ("#D55E00", "--", "s", 2.4),
    "ours, leapfrog on the table, angles alone": ("#882255", ":", "d", 2.4),
    "ours, table at the encoders' angles": ("#000000", "", "P", 1.0),
    "thesis: implicit Euler": ("#000000", "", "*", 1.0),
    "odeint RK4": ("#CC79A7", "-", "^", 1.2), "odeint dopri5": ("#CC79A7", "--", "v", 1.2),
    "CVODE, order 5, KLU": ("#0072B2", "-", "o", 1.2), "CVODE, order 2, KLU": ("#0072B2", "--", "s", 1.2),
    "CVODE, BDF, dense": ("#0072B2", "-", "o", 1.2), "CVODE, Adams": ("#0072B2", "--", "s", 1.2),
    "IDA, order 5, KLU": ("#009E73", "-", "o", 1.2), "IDA, order 2, KLU": ("#009E73", "--", "s", 1.2),
    "ARKODE, DIRK 3, KLU": ("#E69F00", "-", "o", 1.2), "ARKODE, DIRK 5, KLU": ("#E69F00", "--", "s", 1.2),
    "RADAU5, dense": ("#999999", "-", "D", 1.2),
}
INTRODUCTION = """# Run time against error, every run

Written by `lab/run benchmark`; docs/benchmark.md has the terms. Down and to the left is better. Beyond what stands
there:

- KLU refactors in a fixed pattern; the cup's matrix of rank one, which would fill it, is put back by Sherman and
  Morrison's formula. RADAU5 has no sparse solver and factors densely, using the fact that half of the states are the
  derivatives of the others.
- The peers' tolerances are absolute, in units of 5 um, 0.1 m/s, 1 mrad and 10 rad/s; ours is the error of a tooth's
  position by one step. Teeth and spaces are paired after every step of every solver.
- The thesis' method, implicit Euler at 10 us, is drawn but is neither ours nor a peer.
- Where the curves of the forces are vertical, the error is the vibration of single teeth: a limit of the problem, not
  of the solver.
- The operating model of the peers has no friction of the cup, which no solver of smooth equations can have."""


CHOICE = """Choose the full ring if you want every tooth at every step, or if the gear has no table. Choose the table
for the live node and for runs offline. Choose the table at measured angles if you follow a recording. The runs solve
the tooth forces for the hundred samples alone, which takes about 3 ms."""


QUANTITIES = {"angle": "angles", "position": "tooth positions", "force": "tooth forces"}


def error_of(row, quantity):
    return row["series_error"][quantity]


def shown_error(error):
    """As text; of what was not computed, a dash."""
    return f"{error:.1e}" if error < 1e9 else "-"


def rounded(value, digits):
    """As text without an exponent."""
    return f"{float(f'{value:.{digits}g}'):g}"


def finished(rows):
    return [row for row in rows if not row["failure"]]


def shown(rows):
    """The two quantities of a figure: driven bodies have no error of their angles."""
    driven = all(row["series_error"]["angle"] == 0.0 for row in finished(rows))
    return ["position" if driven else "angle", "force"]


def fastest(rows, quantity, level):
    """Quickest row that keeps the error, or None."""
    good = [row for row in finished(rows) if error_of(row, quantity) <= level]
    return min(good, key=lambda row: row["processor_time"]) if good else None


def family_of(row):
    """ours, thesis or peers."""
    if row["solver"].startswith(OURS):
        return "ours"
    return "thesis" if row["solver"].startswith(THESIS) else "peers"


def family(rows, name):
    return [row for row in rows if family_of(row) == name]


def table(header, rows):
    lines = [header, ["---"] * len(header)] + rows
    return [table_row(line) for line in lines] + [""]


def envelope(rows, quantity, apart):
    """Table of the quickest that keeps each error, down to what the references are `apart`; ratios of peers to ours by
    level."""
    lines = []
    ratios = {}
    for level in LEVELS:
        best = {name: fastest(family(rows, name), quantity, level) for name in ("ours", "peers")}
        if level < apart or not any(best.values()):
            continue
        cells = [f"{level:.0e}"]
        for name in ("ours", "peers"):
            row = best[name]
            cells.append(f"{1e3 * row['processor_time']:.3g} ms ({row['solver'].replace(OURS, '')}, {row['setting']})"
                         if row else "not reached")
        both = best["ours"] and best["peers"]
        ratio = best["peers"]["processor_time"] / best["ours"]["processor_time"] if both else None
        cells.append(f"{ratio:.2g}" if both else "-")
        ratios[level] = ratio or ("ours only" if best["ours"] else "peer only" if best["peers"] else None)
        lines.append(cells)
    header = [f"error of {QUANTITIES[quantity]}", "ours", "best peer", "peer / ours"]
    return table(header, lines), ratios


def choice(rows, quantity, apart):
    """Table of ours alone: times real time by level of detail and error; the problem takes a second."""
    levels = [level for level in LEVELS if level >= apart]
    header = [f"times real time at an error of {QUANTITIES[quantity]}", *(f"{level:.0e}" for level in levels)]
    lines = []
    for solver in dict.fromkeys(row["solver"] for row in rows):
        best = [fastest([row for row in rows if row["solver"] == solver], quantity, level) for level in levels]
        if any(best):
            lines.append([solver.replace(OURS, ""),
                          *(f"{rounded(1.0 / row['processor_time'], 3)} ({row['setting']})" if row else "-"
                            for row in best)])
    return table(header, lines)


def run_table(rows):
    header = ["solver", "setting", "time [ms]", "least ... most", "runs", "angles", "positions", "forces",
              "forces at the end", "steps", "right-hand sides", "factorisations", "rejections"]
    return table(header, [[row["solver"], row["setting"], f"{1e3 * row['processor_time']:.3g}",
                           f"{1e3 * row['least']:.3g} ... {1e3 * row['most']:.3g}", row["runs"],
                           *(shown_error(row["series_error"][quantity]) for quantity in QUANTITIES),
                           shown_error(row["end_error"]["force"]), row["steps"], row["force_evaluations"],
                           row["factorisations"], row["rejections"]] for row in finished(rows)])


def draw(rows, title, file):
    figure, panels = plt.subplots(1, 2, figsize=(10.0, 4.4), dpi=110, sharey=True, constrained_layout=True)
    for axes, quantity in zip(panels, shown(rows)):
        for solver, (colour, line, marker, width) in STYLES.items():
            points = [row for row in finished(rows) if row["solver"] == solver and error_of(row, quantity) < 3.0]
            if points:
                axes.loglog([error_of(row, quantity) for row in points], [row["processor_time"] for row in points],
                            color=colour, linestyle=line or "none", marker=marker, markersize=4.5, linewidth=width,
                            label=solver)
        axes.invert_xaxis()
        axes.set_xlabel(f"error of the {QUANTITIES[quantity]} over the time series [-]")
        axes.grid(True, which="major", alpha=0.25)
        axes.spines[["top", "right"]].set_visible(False)
    panels[0].set_ylabel("processor time [s]")
    entries = {label: handle for axes in panels for handle, label in zip(*axes.get_legend_handles_labels())}
    panels[1].legend(entries.values(), entries.keys(), fontsize=7.5, frameon=False, loc="center left",
                     bbox_to_anchor=(1.0, 0.5))
    figure.suptitle(title, fontsize=9.5, x=0.02, ha="left", fontweight="bold")
    figure.savefig(file, metadata={"Software": None})
    plt.close(figure)


def failures(rows):
    """One line a solver: runs that did not finish."""
    lost = {}
    for row in rows:
        if row["failure"]:
            lost.setdefault(row["solver"], []).append(f"{row['setting']} ({row['failure']})")
    return [f"- {solver}: " + ", ".join(settings) for solver, settings in lost.items()]


def installed_version(package):
    done = subprocess.run(["dpkg-query", "-W", "-f", "${Version}", package], capture_output=True, text=True,
                          check=False)
    return f"{package} {done.stdout}" if done.returncode == 0 else f"{package} not from a package"


def processor():
    with open("/proc/cpuinfo", encoding="utf-8") as info:
        return next((line.split(":", 1)[1].strip() for line in info if line.startswith("model name")),
                    platform.machine())


def section(problem, reference, rows, images):
    """Lines of the page, unfinished runs, and the ratios by quantity and level."""
    draw(rows, reference["title"], os.path.join(images, problem + ".png"))
    lines = ["## " + reference["title"], "",
             f"The reference is {reference['methods'][0]}. A second reference, {reference['methods'][1]}, differs from "
             f"it by {reference['apart']['force']:.1e} in the forces, {reference['apart']['position']:.1e} in the "
             f"positions and {reference['apart']['angle']:.1e} in the angles. Smaller errors mean nothing: the tables "
             "end there.", "",
             f"![{reference['title']}](images/benchmark/{problem}.png)", ""]
    ratios = {}
    for quantity in shown(rows):
        if family(rows, "peers"):
            body, ratios[quantity] = envelope(rows, quantity, reference["apart"][quantity])
        else:
            body = choice(rows, quantity, reference["apart"][quantity])
            lines += [CHOICE, ""] if quantity == "angle" else []
        lines += body
    lines += ["<details><summary>every run</summary>", ""] + run_table(rows) + ["</details>", ""]
    lost = failures(rows)
    return lines, [f"**{reference['title']}**", "", *lost, ""] if lost else [], ratios


def table_row(cells):
    return "| " + " | ".join(str(cell) for cell in cells) + " |"


def cell(ratio):
    return "-" if ratio is None else ratio if isinstance(ratio, str) else rounded(ratio, 2)


def ratio_table(sections):
    header = ["best peer's time over ours, at an error of", *(f"{level:.0e}" for level in LEVELS)]
    return table(header, [[f"{title}: {QUANTITIES[quantity]}", *(cell(by_level.get(level)) for level in LEVELS)]
                          for title, ratios in sections for quantity, by_level in ratios.items()])


def parts(tool):
    """Insertion from cold, and a Newton iteration against the number of teeth."""
    done = subprocess.run([tool, "--benchmark_filter=newtonIteration/|insertFromCold", "--benchmark_min_time=0.3",
                           "--benchmark_format=json"], capture_output=True, text=True, check=False)
    if done.returncode:
        sys.exit(f"parts_benchmark: exit code {done.returncode}")
    times = {row["name"]: row["cpu_time"]
             for row in json.loads(done.stdout)["benchmarks"] if row["run_type"] == "iteration"}
    cold = times.pop("insertFromCold")  # [ms]
    teeth = {int(name.split("/")[1]): time for name, time in times.items()}
    least, most = min(teeth), max(teeth)
    slope = math.log(teeth[most] / teeth[least]) / math.log(most / least)
    return ["## Insertion from cold, and cost against teeth", "",
            f"The solver finds the equilibrium of the wave generator in the round ring in {cold:.2g} ms (target: at "
            f"most 1 ms). A Newton iteration of the dynamic ring computes forces, tangent, factors and solution. Its "
            f"time grows with the number of teeth to the power {slope:.2f} (target: at most 1.05).", "",
            *table(["teeth", "iteration [us]"],
                   [[count, f"{1e-3 * time:.3g}"] for count, time in sorted(teeth.items())])]


def main():
    parser = argparse.ArgumentParser(prog="lab/run benchmark", description=__doc__)
    parser.add_argument("--tool", required=True, help=argparse.SUPPRESS)
    parser.add_argument("--parts", required=True, help=argparse.SUPPRESS)
    parser.add_argument("--docs", required=True, help="folder of the summary (default: docs)")
    parser.add_argument("--out", required=True, help="folder of the complete page (default: out/benchmark)")
    parser.add_argument("--work", required=True, help="folder of references and results (default: build/benchmark)")
    parser.add_argument("--problems", default=",".join(PROBLEMS), help="which, by commas (default: all)")
    parser.add_argument("--runs", type=int, default=10,
                        help="timed runs, until one solver and setting has had 1.5 s (default: 10)")
    parser.add_argument("--quick", action="store_true", help="three runs")
    parser.add_argument("--jobs", type=int, default=2,
                        help="problems at a time; not more than there are quiet cores (default: 2)")
    parser.add_argument("--limit", type=float, default=4.0,
                        help="processor time after which a run is given up [s] (default: 4)")
    parser.add_argument("--reuse", action="store_true", help="take references and results at hand, however old")
    options = parser.parse_args()
    if options.quick:
        options.runs = min(options.runs, 3)
    images = os.path.join(options.out, "images", "benchmark")
    os.makedirs(images, exist_ok=True)
    os.makedirs(options.work, exist_ok=True)
    problems = options.problems.split(",")
    progress = Progress(problems)
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        measured = dict(zip(problems, pool.map(lambda problem: measure(problem, options, progress), problems)))
    body, lost, ratios, solvers, levels = [], [], [], set(), []
    for problem in problems:
        reference, rows = measured[problem]
        lines, missing, by_quantity = section(problem, reference, rows, images)
        body += lines
        if problem == "levels":
            levels = lines[:lines.index("<details><summary>every run</summary>")]
        lost += missing
        if by_quantity:
            ratios.append((reference["title"], by_quantity))
        solvers |= {row["solver"] for row in rows}
    absent = [f"{peer} ({package})" for peer, package in OPTIONAL.items()
              if not any(solver.startswith(peer) for solver in solvers)]
    teeth = parts(options.parts)
    machine = (f"{processor()}; {', '.join(installed_version(package) for package in PACKAGES)}. At most "
               f"{options.runs} runs of each, fewer of those that take longer.")
    lines = [INTRODUCTION, "", "## All in one table", "", *ratio_table(ratios), *body, *teeth, "## Omissions", ""]
    if absent:
        lines += [f"Not installed where this was measured: {', '.join(absent)}.", ""]
    lines += [f"Given up after {options.limit:g} s of processor time, explicit ones and RADAU5 after twice that "
              f"(tighter "
              "settings of a solver that gave up early or twice with it), or failed:", "", *lost, "---", "", machine]
    page = os.path.join(options.out, "benchmark.md")
    with open(page, "w", encoding="utf-8") as out:
        out.write("\n".join(lines).rstrip() + "\n")
    print(f"wrote {page}", file=sys.stderr)
    if problems == PROBLEMS:
        benchmark_summary.write(options.docs, options.out, ratio_table(ratios), levels, teeth, machine)


if __name__ == "__main__":
    main()
