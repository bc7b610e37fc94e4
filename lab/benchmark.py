# SPDX-License-Identifier: BSD-3-Clause
"""Run time against error: runs `work_precision` over its problems; writes every run to out/benchmark/runs.csv and the
page docs/benchmark.md."""
import argparse
import concurrent.futures
import csv
import json
import math
import os
import platform
import subprocess
import sys

from benchmark_runs import Progress, measure
from lab import plt, wrapped

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
HEAD = """# Run time against error

`lab/run benchmark` writes this page. The page compares how much time the solvers of the twin and of other programs
(peers) need to reach a given error. All solvers integrate the same equations of motion. The problems are the dynamic
ring of [model.md](model.md) (804 states: masses of teeth, wave generator, circular spline), the operating model (motor
and output as masses, the ring in equilibrium), and the shipped gear
with all friction, which only the twin's own methods solve (levels of detail).

```sh
lab/run benchmark                    # ten minutes: installs peers, measures, writes every run to out/benchmark/runs.csv
lab/run benchmark --reuse            # writes the page again from the last measurements
```

The **error** of a run is the root mean square of its differences from a reference run over all samples, divided by the
standard deviation of the reference. Angles, tooth positions and tooth forces have separate errors. The **time** is the
processor time of one thread, the median of repeated runs, in which the solvers take turns. The **peers** are SUNDIALS
(CVODE, IDA, ARKODE), RADAU5 and Boost.odeint. The peers use the analytic sparse Jacobian with SuiteSparse's KLU, and
call the twin's functions for the forces. The peers have absolute tolerances, in units of 5 µm (positions), 0.1 m/s
(speeds), 1 mrad (angles) and 10 rad/s (angular speeds). The operating model of the peers has no friction of the cup,
because a solver of smooth equations cannot compute this friction. **Our solvers** are TR-BDF2 and ESDIRK4 with adaptive
steps (`joint_twin dynamics --tolerance`).
"""
READING = """A number above 1 means that our fastest solver is faster than the fastest peer. *ours only* means that no
peer reaches the error, *peer only* that none of our solvers reaches the error. A dash means that no solver reaches the
error, or that the two reference runs differ by more than the error. For tooth forces an error below 1e-3 needs
steps of a fraction of a microsecond, which resolve the vibration of single teeth. The best peer for errors below 1e-3
of tooth forces is Runge-Kutta 4 with steps of equal length.

![Working drive under a load step: time against error of all solvers](images/benchmark/drive.png)
"""


CHOICE = """[benchmark_levels.csv](benchmark_levels.csv) has the speed and the error of each level of detail. Choose the
full ring if you want the force on every tooth at every step, or if the gear has no table. Choose the table for the live
node and for runs offline. Choose the table, read at the measured angles, if you follow a recording. In this comparison
the runs on the table solve the tooth forces only for the hundred samples of a run, which takes about 3 ms."""


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


def ratios_of(rows, quantity, apart):
    """Time of the quickest peer over that of our quickest, by error, down to what the references are `apart`."""
    ratios = {}
    for level in (level for level in LEVELS if level >= apart):
        ours, peer = (fastest(family(rows, name), quantity, level) for name in ("ours", "peers"))
        if ours and peer:
            ratios[level] = rounded(peer["processor_time"] / ours["processor_time"], 2)
        elif ours or peer:
            ratios[level] = "ours only" if ours else "peer only"
    return ratios


def choice(rows, quantity, apart):
    """Rows of ours alone: times real time by level of detail and error; the problem takes a second."""
    for solver in dict.fromkeys(row["solver"] for row in rows):
        for level in (level for level in LEVELS if level >= apart):
            row = fastest([row for row in rows if row["solver"] == solver], quantity, level)
            if row:
                yield [QUANTITIES[quantity], solver.replace(OURS, ""), f"{level:.0e}",
                       f"{rounded(1.0 / row['processor_time'], 3)}", row["setting"]]


def write_levels(path, reference, rows):
    with open(path, "w", encoding="utf-8", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["quantity", "method", "error", "times real time", "step or rate"])
        for quantity in shown(rows):
            table.writerows(choice(rows, quantity, reference["apart"][quantity]))


def write_runs(path, measured):
    """Every run of every problem, a row each."""
    with open(path, "w", encoding="utf-8", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["problem", "solver", "setting", "time_ms", "least_ms", "most_ms", "runs", "angle_error",
                        "position_error", "force_error", "force_error_at_end", "steps", "force_evaluations",
                        "factorisations", "rejections", "failure"])
        table.writerows([problem, row["solver"], row["setting"],
                         *(f"{1e3 * row[key]:.4g}" for key in ("processor_time", "least", "most")), row["runs"],
                         *(f"{row['series_error'][quantity]:.2g}" for quantity in QUANTITIES),
                         f"{row['end_error']['force']:.2g}", row["steps"], row["force_evaluations"],
                         row["factorisations"], row["rejections"], row["failure"]]
                        for problem, (_, rows) in measured.items() for row in rows)


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


def installed_version(package):
    done = subprocess.run(["dpkg-query", "-W", "-f", "${Version}", package], capture_output=True, text=True,
                          check=False)
    return f"{package} {done.stdout}" if done.returncode == 0 else f"{package} not from a package"


def processor():
    with open("/proc/cpuinfo", encoding="utf-8") as info:
        return next((line.split(":", 1)[1].strip() for line in info if line.startswith("model name")),
                    platform.machine())


def levels_of(reference):
    """Lines on the levels of detail."""
    return ["## " + reference["title"], "",
            f"The reference run is {reference['methods'][0]} (h: step). A second run, {reference['methods'][1]}, "
            f"differs from the first by {reference['apart']['force']:.1e} in the forces, "
            f"{reference['apart']['position']:.1e} in the positions and {reference['apart']['angle']:.1e} in the "
            "angles. Errors smaller than the differences between these two runs mean nothing, so "
            "`benchmark_levels.csv` omits errors of this size.", "",
            f"![{reference['title']}](images/benchmark/levels.png)", "", wrapped(CHOICE)]


def table_row(cells):
    return "| " + " | ".join(str(cell) for cell in cells) + " |"


def ratio_table(sections):
    header = ["best peer's time over ours, at an error of", *(f"{level:.0e}" for level in LEVELS)]
    return table(header, [[f"{title}: {QUANTITIES[quantity]}", *(by_level.get(level, "-") for level in LEVELS)]
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
            f"most 1 ms). A Newton iteration of the dynamic ring computes forces and tangent, and solves the linear "
            f"equations. The time of an iteration grows with the number of teeth to the power {slope:.2f} (target: at "
            "most 1.05).", ""]


def write_page(options, measured):
    """docs/benchmark.md and its figures."""
    ratios = [(reference["title"], {quantity: ratios_of(rows, quantity, reference["apart"][quantity])
                                    for quantity in shown(rows)})
              for reference, rows in measured.values() if family(rows, "peers")]
    for name in ("drive", "levels"):
        draw(measured[name][1], measured[name][0]["title"],
             os.path.join(options.docs, "images", "benchmark", name + ".png"))
    write_levels(os.path.join(options.docs, "benchmark_levels.csv"), *measured["levels"])
    solvers = {row["solver"] for _, rows in measured.values() for row in rows}
    absent = [f"{peer} ({package})" for peer, package in OPTIONAL.items()
              if not any(solver.startswith(peer) for solver in solvers)]
    machine = (f"The processor of the measurements is {processor()}. The versions of the packages are: "
               f"{', '.join(installed_version(package) for package in PACKAGES)}. Each setting ran "
               f"{options.runs} times, slow settings less often. The program ended a run after {options.limit:g} s of "
               "processor time, a run of an explicit solver or of RADAU5 after twice this time.")
    lines = [wrapped(HEAD), "## Best peer against ours", "", *ratio_table(ratios), wrapped(READING),
             *levels_of(measured["levels"][0]), *parts(options.parts), "---", "", machine]
    if absent:
        lines.append(f"Not installed: {', '.join(absent)}.")
    with open(os.path.join(options.docs, "benchmark.md"), "w", encoding="utf-8") as out:
        out.write("\n".join(lines).rstrip() + "\n")


def main():
    parser = argparse.ArgumentParser(prog="lab/run benchmark", description=__doc__)
    parser.add_argument("--tool", required=True, help=argparse.SUPPRESS)
    parser.add_argument("--parts", required=True, help=argparse.SUPPRESS)
    parser.add_argument("--docs", required=True, help="folder of the page (default: docs)")
    parser.add_argument("--out", required=True, help="folder of runs.csv (default: out/benchmark)")
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
    os.makedirs(options.out, exist_ok=True)
    os.makedirs(options.work, exist_ok=True)
    problems = options.problems.split(",")
    progress = Progress(problems)
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        measured = dict(zip(problems, pool.map(lambda problem: measure(problem, options, progress), problems)))
    runs = os.path.join(options.out, "runs.csv")
    write_runs(runs, measured)
    print(f"wrote {runs}", file=sys.stderr)
    if problems == PROBLEMS:
        write_page(options, measured)


if __name__ == "__main__":
    main()
