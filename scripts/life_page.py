# SPDX-License-Identifier: BSD-3-Clause
"""Ages drives with `joint_twin life` and writes how they age and how well that is forecast: tables and figures."""
import argparse
import json
import pathlib
import subprocess
import sys

import matplotlib
import numpy

import page_section

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (after the choice of its backend)

DUTIES = {"rated": "rated torque and speed", "palletising": "palletising"}
ENDS = ["flank wear", "interface wear", "root crack", "bearing"]
# The catalogue's bearing hides the wear of the flanks; flanks ten times as soft show how their wear is forecast.
TRIALS = {"as shipped": [], "flanks wear ten times as fast": ["--set", "life.flank_wear_coefficient=3.0e-18"]}
SHARES = [0.05, 0.1, 0.5, 0.9, 0.95]
QUANTILES = ["q05", "q10", "q50", "q90", "q95"]
ALPHA = 0.3


def run(options, *arguments):
    command = [options.tool, "life", *arguments]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"life: {' '.join(map(str, command))} failed:\n{done.stderr}")
    return done.stdout


def read(path):
    return numpy.genfromtxt(path, delimiter=",", names=True)


def age(options, name):
    path = options.work / f"{name}.csv"
    result = json.loads(run(options, "age", options.duties / f"{name}.csv", "--grease-changes", "--every", "200",
                            "--csv",
                            path, "--force", "--check", "--json"))
    return result, read(path)


def trials(options, overlay):
    path = options.work / "trials.csv"
    result = json.loads(run(options, "trials", options.duties / "rated.csv", "--grease-changes", "--lives",
                            str(options.lives), "--every", "500", "--seed", "1", "--csv", path, "--force", "--json",
                            *overlay))
    return result, read(path)


def draw_ageing(ages, path):
    figure, axes = plt.subplots(2, 2, figsize=(10, 6.4), constrained_layout=True)
    for (name, (_, rows)), colour in zip(ages.items(), ["C0", "C3"]):
        label = DUTIES[name]
        axes[0, 0].plot(rows["turns"], 1e6 * rows["flank_wear"], colour, label=label)
        axes[0, 1].plot(rows["turns"], 1e6 * rows["interface_wear"], colour)
        axes[1, 0].plot(rows["turns"], rows["grease"], colour)
        axes[1, 1].plot(rows["turns"], 100 * rows["bearings_failed"], colour)
    titles = ["Worn off both flanks [µm]", "Worn off outer race and rim [µm]", "Age of the grease [-]",
              "Bearings failed [%]"]
    for axis, title in zip(axes.flat, titles):
        axis.set_title(title, loc="left", fontsize=10)
        axis.set_xlabel("turns of the motor")
        axis.set_xlim(0, None)
        axis.set_ylim(0, None)
        axis.grid(alpha=0.3)
    axes[0, 0].legend(frameon=False)
    figure.savefig(path, dpi=110)
    plt.close(figure)


def draw_forecasts(rows, title, axis):
    """Some lives of different length: forecast against truth."""
    lengths = {life: (rows["hours"] + rows["remaining"])[rows["life"] == life].max()
               for life in numpy.unique(rows["life"])}
    ordered = sorted(lengths, key=lengths.get)
    chosen = [ordered[int(share * (len(ordered) - 1))] for share in (0.25, 0.5, 0.75)]
    for life, colour in zip(chosen, ["C0", "C1", "C2"]):
        of = rows[rows["life"] == life]
        axis.fill_between(of["hours"], of["q10"], of["q90"], color=colour, alpha=0.2, linewidth=0)
        axis.plot(of["hours"], of["q50"], colour, linewidth=1)
        axis.plot(of["hours"], of["remaining"], colour, linewidth=1, linestyle="--")
    axis.set_title(title, loc="left", fontsize=10)
    axis.set_xlabel("hours of use")
    axis.set_ylabel("remaining hours")
    axis.set_ylim(0, 2.5 * max(lengths[life] for life in chosen))
    axis.grid(alpha=0.3)


def draw_calibration(results, path):
    figure, axes = plt.subplots(2, 2, figsize=(10, 7.6), constrained_layout=True)
    for (name, (_, rows)), axis in zip(results.items(), axes[0]):
        draw_forecasts(rows, f"Three lives, {name}", axis)
    axes[0, 0].plot([], [], "k--", label="truth")
    axes[0, 0].plot([], [], "k", label="median forecast")
    axes[0, 0].fill_between([], [], color="k", alpha=0.2, label="80 % interval")
    axes[0, 0].legend(frameon=False)
    for (name, (_, rows)), colour in zip(results.items(), ["C0", "C3"]):
        observed = [numpy.mean(rows["remaining"] <= rows[quantile]) for quantile in QUANTILES]
        axes[1, 0].plot(SHARES, observed, colour + "o-", label=name)
        ages = rows["hours"] / (rows["hours"] + rows["remaining"])
        edges = numpy.linspace(0, 1, 11)
        within = numpy.abs(rows["q50"] - rows["remaining"]) <= ALPHA * rows["remaining"]
        middle = 0.5 * (edges[1:] + edges[:-1])
        share = [100 * numpy.mean(within[(ages >= low) & (ages < high)]) for low, high in zip(edges, edges[1:])]
        axes[1, 1].plot(middle, share, colour + "o-")
    axes[1, 0].plot([0, 1], [0, 1], "k:", linewidth=1)
    axes[1, 0].set_title("Calibration over all forecasts", loc="left", fontsize=10)
    axes[1, 0].set_xlabel("stated quantile [-]")
    axes[1, 0].set_ylabel("share of truths below it [-]")
    axes[1, 0].legend(frameon=False)
    axes[1, 1].set_title(f"α–λ: median within {100 * ALPHA:.0f} % of the truth [%]", loc="left", fontsize=10)
    axes[1, 1].set_xlabel("λ: share of the life gone [-]")
    axes[1, 1].set_ylim(0, 100)
    for axis in axes[1]:
        axis.grid(alpha=0.3)
    figure.savefig(path, dpi=110)
    plt.close(figure)


def held(rows, chosen):
    inside = (rows["remaining"] >= rows["q10"]) & (rows["remaining"] <= rows["q90"])
    return f"{100 * numpy.mean(inside[chosen]):.0f} %" if numpy.any(chosen) else "none"


def age_table(ages):
    lines = ["| duty | turns an hour | first limit | after [h] | flank wear [µm] | interface wear [µm] | rim stress "
             "range [MPa] "
             "| error of the map [-] |", "|---|---|---|---|---|---|---|---|"]
    for name, (result, _) in ages.items():
        stress = max(phase["rim_stress_range"] for phase in result["phases"])
        lines.append(f"| {DUTIES[name]} | {result['turns'] / result['hours']:.3g} | {result['end']} | "
                     f"{result['hours']:.3g} "
                     f"| {1e6 * result['flank_wear']:.1f} | {1e6 * result['interface_wear']:.1f} | {1e-6 * stress:.0f} "
                     f"| {result['map_error']:.1g} |")
    return lines


def trial_table(results):
    lines = ["| drives | lives | ended by " + ", ".join(ENDS)
             + " | forecasts | 80 % interval held the truth | from half of each "
             "life on | of those, lives ended by flank wear | by the bearing |", "|---|---|---|---|---|---|---|---|"]
    for name, (result, rows) in results.items():
        ends = ", ".join(str(result[end.replace(" ", "_")]) for end in ENDS)
        later = rows["hours"] >= rows["remaining"]
        lines.append(f"| {name} | {result['lives']} | {ends} | {result['forecasts']} | "
                     f"{100 * result['coverage_80']:.0f} % "
                     f"| {100 * result['coverage_80_from_half_life']:.0f} % | {held(rows, later & (rows['end'] == 0))} "
                     f"| {held(rows, later & (rows['end'] == 3))} |")
    return lines


def main():
    parser = argparse.ArgumentParser(prog="life", description=__doc__)
    parser.add_argument("--tool", type=pathlib.Path, required=True, help=argparse.SUPPRESS)
    parser.add_argument("--duties", type=pathlib.Path, required=True, help=argparse.SUPPRESS)
    parser.add_argument("--docs", type=pathlib.Path, required=True, help="folder that holds life.md")
    parser.add_argument("--work", type=pathlib.Path, required=True, help="folder for the rows")
    parser.add_argument("--lives", type=int, default=200, help="simulated lives of each kind [200]")
    options = parser.parse_args()
    options.work.mkdir(parents=True, exist_ok=True)

    ages = {}
    for name in DUTIES:
        print(f"life: ageing, {DUTIES[name]}", file=sys.stderr)
        ages[name] = age(options, name)
    results = {}
    for name, overlay in TRIALS.items():
        print(f"life: {options.lives} lives, {name}", file=sys.stderr)
        results[name] = trials(options, overlay)
    draw_ageing(ages, options.docs / "images" / "life_ageing.png")
    draw_calibration(results, options.docs / "images" / "life_forecast.png")
    page_section.write(options.docs / "life.md", "life", [
        *age_table(ages), "",
        "![Wear, grease and bearing over the turns of the motor, two duties](images/life_ageing.png)", "",
        *trial_table(results), "",
        "![Forecasts of three lives each, calibration, and accuracy against the share of life "
        "gone](images/life_forecast.png)"])
    print(f"life: wrote {options.docs / 'life.md'}", file=sys.stderr)


if __name__ == "__main__":
    main()
