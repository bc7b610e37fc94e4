# SPDX-License-Identifier: BSD-3-Clause
"""Ages drives with `joint_twin life` and writes how they age and how well that is forecast: tables and figures."""
import argparse
import json
import pathlib
import subprocess
import sys

import matplotlib
import numpy

import lives_judged
import lab

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (after the choice of its backend)

DUTIES = {"rated": "rated torque and speed", "palletising": "palletising",
          "collisions": "rated, with collisions"}
COLOURS = ["C0", "C3", "C2"]
ENDS = ["flank wear", "interface wear", "root crack", "bearing", "tooth space fatigue", "transition fatigue",
        "flange fatigue"]
PLACES = {"tooth space": "tooth_space", "transition": "transition", "flange": "flange"}
LOADS = {0: "C0", 67: "C2", 150: "C1", 284: "C3"}  # [N.m]
# The catalogue's bearing hides the wear of the flanks; flanks ten times as soft show how their wear is forecast, a gear
# that the collisions tire how its fatigue is.
TRIALS = {"as shipped": ("rated",),
          "flanks wear ten times as fast": ("rated", "--set", "life.flank_wear_coefficient=3.0e-18"),
          "collisions, straight flanks": ("collisions", "--config", "golden.yaml")}
SHARES = [0.05, 0.1, 0.5, 0.9, 0.95]
QUANTILES = ["q05", "q10", "q50", "q90", "q95"]
ALPHA = 0.3
JUDGED_SEED = 1
BEYOND_KNEE = 45.0   # exponent of the S-N curve there
LEAST_FORECASTS = 30  # of which a share is stated


def run(options, *arguments):
    return tool(options, "life", *arguments)


def tool(options, *arguments):
    command = [options.tool, *arguments]
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


def trials(options, seed, duty, *overlay):
    path = options.work / "trials.csv"
    result = json.loads(run(options, "trials", options.duties / f"{duty}.csv", "--grease-changes", "--lives",
                            str(options.lives), "--every", "1000", "--seed", str(seed), "--csv", path, "--force",
                            "--json", *overlay))
    return result, read(path)


def draw_stress(options, path):
    """Nominal stress of every tooth at three places under four loads."""
    rows = json.loads(tool(options, "stiffness", "--torques", ",".join(map(str, LOADS)), "--teeth", "--json"))["rows"]
    figure, axes = plt.subplots(3, 1, figsize=(10, 8.4), sharex=True, constrained_layout=True)
    for axis, (place, key) in zip(axes, PLACES.items()):
        for row, colour in zip(rows, LOADS.values()):
            stress = 1e-6 * numpy.array(row["teeth"]["stress_" + key])
            angle = 360.0 * numpy.arange(len(stress)) / len(stress)
            shear = row["stress"][place]["shear"]
            label = f"{row['torque']:g} N·m" + (f", shear {1e-6 * shear:.0f} MPa" if shear > 1e3 else "")
            axis.plot(angle, stress, colour, linewidth=1.2, label=label)
        axis.set_title(f"{place[0].upper() + place[1:]}: nominal normal stress [MPa]", loc="left", fontsize=10)
        axis.legend(frameon=False, ncol=4, fontsize=8)
        axis.margins(y=0.18)
        axis.grid(alpha=0.3)
    axes[-1].set_xlabel("angle from the wave generator's major axis [°]")
    axes[-1].set_xticks(range(0, 361, 45))
    axes[-1].set_xlim(0, 360)
    figure.savefig(path, dpi=110)
    plt.close(figure)


def draw_fatigue(options, ages, path):
    """S-N curve with what the catalogue allows, and with the phases of the duties over their lives."""
    life = json.loads(tool(options, "parameters", "--json"))["life"]
    limit, knee, exponent = life["endurance_limit"], life["endurance_cycles"], life["fatigue_exponent"]
    figure, axis = plt.subplots(figsize=(10, 4.6), constrained_layout=True)
    amplitudes = numpy.linspace(limit, 0.9 * life["ultimate_strength"], 100)
    for deviation, style, label in ((0.0, "k", "half of all flexsplines"), (-2.326, "k--", "weakest 1 %")):
        strength = numpy.exp(deviation * life["fatigue_spread"])
        cycles = numpy.append(1e12, knee * (limit / amplitudes) ** exponent)
        beyond = limit * (1e12 / knee) ** (-1.0 / BEYOND_KNEE)
        axis.plot(cycles, 1e-6 * strength * numpy.append(beyond, amplitudes), style, label=label)
    for row in json.loads(run(options, "fatigue", "--json"))["rows"]:
        colour = dict(zip(PLACES, ["C0", "C1", "C2"]))[row["place"]]
        amplitude = 1e-6 * row["equivalent"]
        place = row["place"] if row["torque"] == life["rated_torque"] else None
        if row["allowed"] is None:
            axis.plot(1e11, amplitude, colour + ">", label=place)
        else:
            axis.plot(row["allowed"], amplitude, colour + "o")
        shift = -9 if row["torque"] == life["rated_torque"] else 2
        axis.annotate(f"{row['torque']:g} N·m", (row["allowed"] or 1e11, amplitude), xytext=(7, shift),
                      textcoords="offset points", fontsize=7, color=colour)
    for (name, (result, _)), marker in zip(ages.items(), "xsd"):
        per_hour = result["turns"] / result["hours"]
        turns = sum(phase["turns_per_cycle"] for phase in result["phases"])
        for number, phase in enumerate(result["phases"]):
            row = phase["fatigue"][0]
            cycles = 2.0 * phase["turns_per_cycle"] / turns * per_hour * result["hours"]
            axis.plot(max(cycles, 1.0), 1e-6 * row["equivalent"], "C3" + marker, fillstyle="none",
                      label=f"{DUTIES[name]}: tooth space, phases" if number == 0 else None)
    axis.set_xscale("log")
    axis.set_xlim(1e3, 1e12)
    axis.set_xlabel("cycles, two a turn of the motor")
    axis.set_ylabel("amplitude at the notch, no mean [MPa]")
    axis.grid(alpha=0.3)
    axis.legend(frameon=False, fontsize=8, ncol=2)
    figure.savefig(path, dpi=110)
    plt.close(figure)


def draw_ageing(ages, path):
    figure, axes = plt.subplots(2, 2, figsize=(10, 6.4), constrained_layout=True)
    for (name, (_, rows)), style in zip(ages.items(), ["C0", "C3", "C2--"]):
        axes[0, 0].plot(rows["turns"], 1e6 * rows["flank_wear"], style, label=DUTIES[name])
        axes[0, 1].plot(rows["turns"], 1e6 * rows["interface_wear"], style)
        axes[1, 0].plot(rows["turns"], rows["grease"], style)
        axes[1, 1].plot(rows["turns"], 100 * rows["bearings_failed"], style)
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
        axis.fill_between(of["hours"], of["read_q10"], of["read_q90"], color=colour, alpha=0.2, linewidth=0)
        axis.plot(of["hours"], of["read_q50"], colour, linewidth=1)
        axis.plot(of["hours"], of["remaining"], colour, linewidth=1, linestyle="--")
    axis.set_title(title, loc="left", fontsize=10)
    axis.set_xlabel("hours of use")
    axis.set_ylabel("remaining hours")
    axis.set_ylim(0, 2.5 * max(lengths[life] for life in chosen))
    axis.grid(alpha=0.3)


def tenths(rows, share):
    """Forecasts in each tenth of `share` [-], 0 ... 1, as conditions on the rows."""
    return [(share >= 0.1 * tenth) & (share < 0.1 * (tenth + 1)) for tenth in range(10)]


def of_life(rows):
    """Share of the life that is gone, as it turns out [-]."""
    return rows["hours"] / (rows["hours"] + rows["remaining"])


def of_forecast(rows):
    """The same as the median forecast has it: what is known at the time [-]."""
    return rows["hours"] / (rows["hours"] + rows["read_q50"])


def accurate(rows, median):
    return numpy.abs(median - rows["remaining"]) <= ALPHA * rows["remaining"]


def draw_calibration(results, path):
    figure, axes = plt.subplots(2, 3, figsize=(13, 7.6), constrained_layout=True)
    for (name, (_, rows)), axis in zip(results.items(), axes[0]):
        draw_forecasts(rows, f"Three lives, {name}", axis)
    axes[0, 0].plot([], [], "k--", label="truth")
    axes[0, 0].plot([], [], "k", label="median forecast")
    axes[0, 0].fill_between([], [], color="k", alpha=0.2, label="80 % interval")
    axes[0, 0].legend(frameon=False)
    middle = 0.05 + 0.1 * numpy.arange(10)
    for (name, (_, rows)), colour in zip(results.items(), COLOURS):
        observed = [numpy.mean(rows["remaining"] <= rows["read_" + quantile]) for quantile in QUANTILES]
        axes[1, 0].plot(SHARES, observed, colour + "o-", label=name)
        for prefix, style in (("read_", "o-"), ("prior_", ":")):
            share = [100 * numpy.mean(accurate(rows, rows[prefix + "q50"])[tenth]) for tenth in
                     tenths(rows, of_life(rows))]
            axes[1, 1].plot(middle, share, colour + style)
        for share, style in ((of_life(rows), "o-"), (of_forecast(rows), "s--")):
            covered = [100 * numpy.mean(inside(rows)[tenth]) if numpy.count_nonzero(tenth) >= LEAST_FORECASTS else
                       numpy.nan for tenth in tenths(rows, share)]
            axes[1, 2].plot(middle, covered, colour + style)
    axes[1, 0].plot([0, 1], [0, 1], "k:", linewidth=1)
    axes[1, 0].set_title("Calibration over all forecasts", loc="left", fontsize=10)
    axes[1, 0].set_xlabel("stated quantile [-]")
    axes[1, 0].set_ylabel("share of truths below it [-]")
    axes[1, 0].legend(frameon=False)
    axes[1, 1].plot([], [], "ko-", label="with readings")
    axes[1, 1].plot([], [], "k:", label="prior")
    axes[1, 1].legend(frameon=False)
    axes[1, 1].set_title(f"α–λ: median within {100 * ALPHA:.0f} % of the truth [%]", loc="left", fontsize=10)
    axes[1, 1].set_xlabel("λ: share of the life gone [-]")
    axes[1, 1].set_ylim(0, 100)
    axes[1, 2].axhspan(75, 85, color="k", alpha=0.1)
    axes[1, 2].plot([], [], "ko-", label="as it turns out")
    axes[1, 2].plot([], [], "ks--", label="as the forecast has it")
    axes[1, 2].legend(frameon=False)
    axes[1, 2].set_title("80 % interval held the truth [%]", loc="left", fontsize=10)
    axes[1, 2].set_xlabel("share of the life gone [-]")
    axes[1, 2].set_ylim(0, 100)
    for axis in axes[1]:
        axis.grid(alpha=0.3)
    figure.savefig(path, dpi=110)
    plt.close(figure)


def inside(rows):
    return (rows["remaining"] >= rows["read_q10"]) & (rows["remaining"] <= rows["read_q90"])


def held(rows, chosen):
    enough = numpy.count_nonzero(chosen) >= LEAST_FORECASTS
    return f"{100 * numpy.mean(inside(rows)[chosen]):.0f}" if enough else "-"


def age_table(ages):
    lines = ["| duty cycle | turns of the motor in an hour | limit reached first | hours until this limit "
             "| flank wear at this limit [µm] | interface wear at this limit [µm] | amplitude in the tooth space [MPa] "
             "| mean stress in the tooth space [MPa] | equivalent amplitude at the notch [MPa] "
             "| error of the interpolation [-] |", "|---" * 10 + "|"]
    for name, (result, _) in ages.items():
        worst = max((phase["fatigue"][0] for phase in result["phases"]), key=lambda row: row["equivalent"])
        lines.append(f"| {DUTIES[name]} | {result['turns'] / result['hours']:.3g} | {result['end']} | "
                     f"{result['hours']:.3g} "
                     f"| {1e6 * result['flank_wear']:.1f} | {1e6 * result['interface_wear']:.1f} "
                     f"| {1e-6 * worst['amplitude']:.0f}, {1e-6 * worst['mean']:.0f} "
                     f"| {1e-6 * worst['equivalent']:.0f} | {result['map_error']:.1g} |")
    return lines


def fatigue_table(options):
    def shown(value):
        return "unlimited" if value is None else f"{value:.2g}"

    rows = json.loads(run(options, "fatigue", "--json"))["rows"]
    lines = ["| load [N.m] | place | amplitude [MPa] | mean stress [MPa] | shear [MPa] "
             "| equivalent amplitude at the notch [MPa] | cycles that half of the drives survive "
             "| cycles that 99 % of the drives survive | cycles that the catalogue allows |", "|---" * 9 + "|"]
    for row in rows:
        lines.append(f"| {row['torque']:g} | {row['place']} | {1e-6 * row['amplitude']:.0f} | "
                     f"{1e-6 * row['mean']:.0f} | "
                     f"{1e-6 * row['shear']:.0f} | {1e-6 * row['equivalent']:.0f} | {shown(row['cycles'])} | "
                     f"{shown(row['cycles_weak'])} | {shown(row['allowed'])} |")
    return lines


def ends_table(results):
    lines = ["| drives | lives | " + " | ".join(f"ended by {end}" for end in ENDS) + " |",
             "|---" * (len(ENDS) + 2) + "|"]
    for name, (result, _) in results.items():
        ends = " | ".join(str(result[end.replace(" ", "_")]) for end in ENDS)
        lines.append(f"| {name} | {result['lives']} | {ends} |")
    return lines


def coverage_table(results):
    lines = ["| truth in the 80 % interval [%] | forecasts | all lives | "
             + " | ".join(f"lives ended by {end}" for end in ("flank wear", "interface wear", "bearing", "fatigue"))
             + " |", "|---" * 7 + "|"]
    for name, (_, rows) in results.items():
        causes = " | ".join(held(rows, chosen) for chosen in (rows["end"] >= 0, rows["end"] == 0, rows["end"] == 1,
                                                              rows["end"] == 3, rows["end"] >= 4))
        lines.append(f"| {name} | {len(rows)} | {causes} |")
    return lines


def tenth_table(results):
    lines = ["| truth in the 80 % interval [%], by tenth of the forecast life | "
             + " | ".join(f"tenth {tenth + 1}" for tenth in range(10)) + " |", "|---" * 11 + "|"]
    for name, (_, rows) in results.items():
        covered = " | ".join(held(rows, tenth) for tenth in tenths(rows, of_forecast(rows)))
        lines.append(f"| {name} | {covered} |")
    return lines


def score_table(results):
    lines = ["| drives | forecast | mean CRPS [h] | mean CRPS, second half of lives ended by wear [h] "
             "| median within 30 % of the truth [%] "
             "| median within 30 % of the truth, at half of lives ended by wear [%] "
             "| median within 30 % of the truth, at 80 % of lives ended by wear [%] | horizon, lives ended by wear [-] "
             "| truth in the 80 % interval [%] |", "|---" * 9 + "|"]
    for name, (_, rows) in results.items():
        found = [(words, rows[prefix + "crps"], *(rows[prefix + q] for q in ("q10", "q50", "q90")))
                 for words, prefix in (("use alone", "prior_"), ("last assessment", ""),
                                       ("all readings of wear", "read_"))]
        truth, share, worn = rows["remaining"], of_life(rows), rows["end"] <= 1
        for words, score, low, median, high in found:
            good = accurate(rows, median)
            at = " | ".join(f"{100 * numpy.mean(good[worn & (numpy.abs(share - part) < 0.05)]):.0f}"
                            for part in (0.5, 0.8))
            left = lives_judged.horizon(rows["life"][worn], good[worn], share[worn])
            lines.append(f"| {name} | {words} | {numpy.mean(score):.0f} "
                         f"| {numpy.mean(score[worn & (share > 0.5)]):.0f} "
                         f"| {100 * numpy.mean(good):.0f} | {at} | {left:.2f} "
                         f"| {100 * numpy.mean((truth >= low) & (truth <= high)):.0f} |")
    return lines


def main():
    parser = argparse.ArgumentParser(prog="life", description=__doc__)
    parser.add_argument("--tool", type=pathlib.Path, required=True, help=argparse.SUPPRESS)
    parser.add_argument("--duties", type=pathlib.Path, required=True, help=argparse.SUPPRESS)
    parser.add_argument("--docs", type=pathlib.Path, required=True, help="folder that holds life.md")
    parser.add_argument("--work", type=pathlib.Path, required=True, help="folder for the rows")
    parser.add_argument("--lives", type=int, default=60, help="simulated lives of each kind [60]")
    options = parser.parse_args()
    options.work.mkdir(parents=True, exist_ok=True)

    ages = {}
    for name in DUTIES:
        print(f"life: ageing, {DUTIES[name]}", file=sys.stderr)
        ages[name] = age(options, name)
    results = {}
    for name, arguments in TRIALS.items():
        print(f"life: {options.lives} lives, {name}", file=sys.stderr)
        results[name] = trials(options, JUDGED_SEED, *arguments)
    draw_stress(options, options.docs / "images" / "life_stress.png")
    draw_fatigue(options, ages, options.docs / "images" / "life_fatigue.png")
    draw_ageing(ages, options.docs / "images" / "life_ageing.png")
    draw_calibration(results, options.docs / "images" / "life_forecast.png")
    print("life: lives with signals", file=sys.stderr)
    lab.write(options.docs / "life.md", "read", lives_judged.tables(lives_judged.judged(options)))
    lab.write(options.docs / "life.md", "life", [
        "The CSV files give the fatigue of the new drive at the catalogue's torques (`joint_twin life fatigue`), the "
        "scores of the forecasts, the coverage by tenths of the life, and the ends of the lives.", "",
        *fatigue_table(options), "",
        *score_table(results), "",
        *tenth_table(results), "",
        *ends_table(results), "",
        *age_table(ages), "",
        "![S-N curve, the catalogue's torques (dots and arrows, at the cycles it allows) and the phases of the duties "
        "over their lives](images/life_fatigue.png)",
        "![Wear, grease and bearing over the turns of the motor, three duties](images/life_ageing.png)", "",
        *coverage_table(results), "",
        "![Forecasts of three lives each, calibration, accuracy and coverage against the "
        "share of life gone](images/life_forecast.png)"])
    print(f"life: wrote {options.docs / 'life.md'}", file=sys.stderr)


if __name__ == "__main__":
    main()
