#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Run time against error: runs `work_precision` over its problems and writes docs/benchmark.md. Started by scripts/benchmark."""
import argparse
import json
import math
import os
import platform
import subprocess
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (the backend is chosen before pyplot is loaded)

PROBLEMS = ["insertion", "drive", "drive_smooth", "drive_stiff10", "drive_stiff100"]
LEVELS = [1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9]
PACKAGES = ["libsundials-dev", "libsuitesparse-dev", "libboost-dev", "libeigen3-dev", "g++"]
OURS = "ours, "
FAIR = "our linear solver"
# Colour by family, line by member.
STYLES = {
    "ours, ESDIRK4": ("#D55E00", "-", "o", 2.4), "ours, TR-BDF2": ("#D55E00", "--", "s", 2.4),
    "implicit Euler (thesis' step)": ("#000000", "", "*", 1.0),
    "odeint RK4": ("#CC79A7", "-", "^", 1.2), "odeint dopri5": ("#CC79A7", "--", "v", 1.2),
    "CVODE, order 5, KLU": ("#0072B2", "-", "o", 1.2), "CVODE, order 2, KLU": ("#0072B2", "--", "s", 1.2),
    "IDA, order 5, KLU": ("#009E73", "-", "o", 1.2), "IDA, order 2, KLU": ("#009E73", "--", "s", 1.2),
    "ARKODE, DIRK 3, KLU": ("#E69F00", "-", "o", 1.2), "ARKODE, DIRK 5, KLU": ("#E69F00", "--", "s", 1.2),
    "CVODE, order 2, our linear solver": ("#0072B2", ":", "x", 1.2),
    "IDA, order 2, our linear solver": ("#009E73", ":", "x", 1.2),
    "ARKODE, DIRK 3, our linear solver": ("#E69F00", ":", "x", 1.2),
    "ARKODE, DIRK 5, our linear solver": ("#E69F00", "-.", "+", 1.2),
}
INTRODUCTION = """# Run time against error

Written by `scripts/benchmark`; do not edit. One right-hand side, the dynamic ring of [model.md](model.md) (804 states: every
tooth's mass, wave generator, circular spline), many solvers. **Error**: root mean square over the samples, over the standard
deviation of the reference, over all angles, all tooth positions or all tooth forces. **Time**: of the processor, of one thread, median of the runs; the solvers take turns, so what slows the
machine meets all alike. Down and to the left is better.

Peers get the analytic sparse Jacobian with SuiteSparse's KLU, refactored in a fixed pattern; the cup's matrix of rank one, which
would fill that pattern, is put back by Sherman and Morrison's formula. *Our linear solver*: the same integrators with the twin's
own cyclic solver plugged in. Tolerances are absolute, in units of 5 um, 0.1 m/s, 1 mrad and 10 rad/s. Teeth and spaces are paired
after every step of every solver. Ours march at fixed steps, a whole number of them to a sample.

Where the curves of the forces turn upright, what is left is the vibration of single teeth that start and contact stir up: steps
that do not follow it, at a fraction of a microsecond, gain nothing by being finer. An upright curve is a limit of the question,
not of the solver."""
OMISSIONS = """
Not measured here: PETSc TS, RADAU5 (r-cran-desolve), odeint's rosenbrock4, MuJoCo, Simbody, and the operating model with the ring
in equilibrium. A prototype of this model met, in its own runs, rosenbrock4 too slow to pass the first millisecond (dense
factorisation), RADAU5 10 to 40 times dearer than a structured method of order 4 (dense factorisation), PETSc's BDF-2 and rosw
ra34pw2 on the level of SUNDIALS of order 2, MuJoCo 13 and Simbody 26 to 59 times dearer per right-hand side."""


QUANTITIES = {"angle": "angles", "position": "tooth positions", "force": "tooth forces"}


def error_of(row, quantity):
    return row["series_error"][quantity]


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


def family(rows, name):
    if name == "ours":
        return [row for row in rows if row["solver"].startswith(OURS)]
    fair = [row for row in rows if FAIR in row["solver"]]
    if name == "fair":
        return fair
    return [row for row in rows if not row["solver"].startswith(OURS) and row not in fair]


def table(header, rows):
    lines = [header, ["---"] * len(header)] + rows
    return ["| " + " | ".join(str(cell) for cell in line) + " |" for line in lines] + [""]


def envelope(rows, quantity):
    lines = []
    for level in LEVELS:
        best = {name: fastest(family(rows, name), quantity, level) for name in ("ours", "peers", "fair")}
        if not any(best.values()):
            continue
        cells = [f"{level:.0e}"]
        for name in ("ours", "peers", "fair"):
            row = best[name]
            cells.append(f"{1e3 * row['processor_time']:.3g} ms ({row['solver'].replace(OURS, '')}, {row['setting']})"
                         if row else "not reached")
        for name in ("peers", "fair"):
            both = best["ours"] and best[name]
            cells.append(f"{best[name]['processor_time'] / best['ours']['processor_time']:.2g}" if both else "-")
        lines.append(cells)
    return table([f"error of {QUANTITIES[quantity]}", "ours", "best peer", "best peer with our linear solver", "peer / ours", "that one / ours"], lines)


def run_table(rows):
    header = ["solver", "setting", "time [ms]", "angles", "positions", "forces", "forces at the end", "steps", "right-hand sides", "factorisations",
              "rejections"]
    return table(header, [[row["solver"], row["setting"], f"{1e3 * row['processor_time']:.3g}", 
                           *(f"{error_of(row, quantity):.1e}" for quantity in QUANTITIES),
                           f"{row['end_error']['force']:.1e}", row["steps"], row["force_evaluations"],
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
    panels[1].legend(fontsize=7.5, frameon=False, loc="center left", bbox_to_anchor=(1.0, 0.5))
    figure.suptitle(title, fontsize=9.5, x=0.02, ha="left", fontweight="bold")
    figure.savefig(file, metadata={"Software": None})
    plt.close(figure)


def failures(rows):
    """One line a solver: what did not finish."""
    lost = {}
    for row in rows:
        if row["failure"]:
            lost.setdefault(row["solver"], []).append(f"{row['setting']} ({row['failure']})")
    return [f"- {solver}: " + ", ".join(settings) for solver, settings in lost.items()]


def installed_version(package):
    done = subprocess.run(["dpkg-query", "-W", "-f", "${Version}", package], capture_output=True, text=True, check=False)
    return f"{package} {done.stdout}" if done.returncode == 0 else f"{package} not from a package"


def processor():
    with open("/proc/cpuinfo", encoding="utf-8") as info:
        return next((line.split(":", 1)[1].strip() for line in info if line.startswith("model name")), platform.machine())


def ask(tool, *arguments):
    """Runs the tool, its progress passed on, and gives its JSON lines."""
    done = subprocess.run([tool, *arguments], stdout=subprocess.PIPE, text=True, check=False)
    if done.returncode:
        sys.exit(f"work_precision {' '.join(arguments)}: exit code {done.returncode}")
    return [json.loads(line) for line in done.stdout.splitlines()]


def cached(file, reuse, newer_than, make):
    """JSON lines of a file, made anew if something they depend on is younger."""
    fresh = os.path.exists(file) and (reuse or os.path.getmtime(file) > newer_than)
    if not fresh:
        lines = make()
        with open(file, "w", encoding="utf-8") as out:
            out.writelines(json.dumps(line) + "\n" for line in lines)
    with open(file, encoding="utf-8") as source:
        return [json.loads(line) for line in source]


def section(problem, options, images):
    built = os.path.getmtime(options.tool)
    reference_file = os.path.join(options.work, problem + ".ref")
    print(f"{problem}: reference", file=sys.stderr)
    reference = cached(os.path.join(options.work, problem + ".reference.jsonl"), options.reuse, built,
                       lambda: ask(options.tool, problem, "--reference", reference_file, "--make-reference"))[0]
    rows = cached(os.path.join(options.work, problem + ".jsonl"), options.reuse, float("inf"),
                  lambda: ask(options.tool, problem, "--reference", reference_file, "--runs", str(options.runs),
                              "--limit", str(options.limit)))
    draw(rows, reference["title"], os.path.join(images, problem + ".png"))
    lines = ["## " + reference["title"], "",
             f"Reference: {reference['methods'][0]}; {reference['methods'][1]} is {reference['apart']['force']:.1e} from it in the forces, "
             f"{reference['apart']['position']:.1e} in the positions: errors below that mean nothing.", "",
             f"![{reference['title']}](images/benchmark/{problem}.png)", ""]
    for quantity in shown(rows):
        lines += envelope(rows, quantity)
    lines += ["<details><summary>every run</summary>", ""] + run_table(rows) + ["</details>", ""]
    lost = failures(rows)
    return lines, [f"**{reference['title']}**", "", *lost, ""] if lost else []


def parts(tool):
    """Insertion from cold, and a Newton iteration against the number of teeth."""
    done = subprocess.run([tool, "--benchmark_filter=newtonIteration/|insertFromCold", "--benchmark_min_time=0.3",
                           "--benchmark_format=json"], capture_output=True, text=True, check=False)
    if done.returncode:
        sys.exit(f"parts_benchmark: exit code {done.returncode}")
    times = {row["name"]: row["cpu_time"] for row in json.loads(done.stdout)["benchmarks"] if row["run_type"] == "iteration"}
    cold = times.pop("insertFromCold")  # [ms]
    teeth = {int(name.split("/")[1]): time for name, time in times.items()}
    least, most = min(teeth), max(teeth)
    slope = math.log(teeth[most] / teeth[least]) / math.log(most / least)
    return ["## Insertion from cold, and cost against teeth", "",
            f"Equilibrium of the wave generator inserted into the round ring: {cold:.2g} ms (wanted: 1 ms at most). A Newton "
            f"iteration of the dynamic ring, that is forces, tangent, factors and solution, goes with the number of teeth to "
            f"the power {slope:.2f} (wanted: 1.05 at most).", "",
            *table(["teeth", "iteration [us]"], [[count, f"{1e-3 * time:.3g}"] for count, time in sorted(teeth.items())])]


def main():
    parser = argparse.ArgumentParser(prog="scripts/benchmark", description=__doc__)
    parser.add_argument("--tool", required=True, help=argparse.SUPPRESS)
    parser.add_argument("--parts", required=True, help=argparse.SUPPRESS)
    parser.add_argument("--docs", required=True, help="folder of the page (default: docs)")
    parser.add_argument("--work", required=True, help="folder of references and results (default: build/benchmark)")
    parser.add_argument("--problems", default=",".join(PROBLEMS), help="which, by commas (default: all)")
    parser.add_argument("--runs", type=int, default=10, help="timed runs; longer ones than 0.5 s are timed once")
    parser.add_argument("--limit", type=float, default=8.0, help="processor time after which a run is given up [s]")
    parser.add_argument("--reuse", action="store_true", help="take references and results at hand, however old")
    options = parser.parse_args()
    images = os.path.join(options.docs, "images", "benchmark")
    os.makedirs(images, exist_ok=True)
    os.makedirs(options.work, exist_ok=True)
    lines = [INTRODUCTION, ""]
    lost = []
    for problem in options.problems.split(","):
        body, missing = section(problem, options, images)
        lines += body
        lost += missing
    lines += parts(options.parts)
    lines += ["## Omissions", "", f"Given up after {options.limit:g} s of processor time, odeint's after eight times that (tighter settings of the same "
              "solver with it), or failed:", "", *lost, OMISSIONS.strip(), "", "---", "",
              f"{processor()}; {', '.join(installed_version(package) for package in PACKAGES)}; {options.runs} runs."]
    page = os.path.join(options.docs, "benchmark.md")
    with open(page, "w", encoding="utf-8") as out:
        out.write("\n".join(lines).rstrip() + "\n")
    print(f"wrote {page}", file=sys.stderr)


if __name__ == "__main__":
    main()
