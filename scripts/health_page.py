# SPDX-License-Identifier: BSD-3-Clause
"""Evaluates the assessment on sound and faulty joints with real sensors, and writes docs/health.md."""
import argparse
import itertools
import math
import pathlib
import re
import sys

import matplotlib
import numpy

import fault_figures
import health_runs
import health_signatures
import page_section
from health_runs import CHECK_UP, GREASE, JUDGED, QUICK, SERIES_MOTIONS

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (after the choice of its backend)

SURE = 0.3            # severity from which on the cause should be right
SERIES_WINDOWS = 120  # of each drawn gear, beside those of its reference
SET = 0.9             # probability that the causes of a set have together
BINS = [0.0, 0.5, 0.7, 0.85, 0.95, 1.0]  # of the confidence


def collect(bench, trials, sound_windows):
    """(sound, faulty, not judged) runs of trials, each compared with the reference of its gear and motion."""
    drawn = f"{{uniform: [{GREASE[0]}, {GREASE[1]}]}}"
    sound, faulty = [], []
    for trial, motion in ((trial, motion) for trial in trials for motion in trial.motions):
        bags = bench.sound("sound", trial.gear, motion, drawn, sound_windows, 4)
        sound += bench.judge(bags, trial.gear, motion)
        faulty += bench.judge(bench.faulty(trial, motion, drawn), trial.gear, motion)
    missing = [run for run in [*sound, *faulty] if run.window is None]
    return [run for run in sound if run.window], [run for run in faulty if run.window], missing


def beyond(run):
    return run.window.largest > 1.0


def right(run):
    return run.window.cause == run.kind


def in_set(run):
    """Right, or among the causes that have SET of the probability together."""
    return right(run) or run.kind in run.window.alternatives


def share(flags):
    flags = list(flags)
    return f"{sum(flags)} of {len(flags)}" if flags else "-"


def poisson_bound(count):
    """What a Poisson variable's mean lies below with 95 %, having counted so many: chi square after Wilson and
    Hilferty."""
    degrees = 2 * (count + 1)
    return 0.5 * degrees * (1.0 - 2.0 / (9.0 * degrees) + 1.6449 * math.sqrt(2.0 / (9.0 * degrees))) ** 3


def alarms(runs):
    """(hours, windows beyond the threshold, two in a row of one gear, 95 % bound of the latter in 1000 h, the same if
    windows are independent)."""
    hours = sum(run.motion.window for run in runs) / 3600.0
    count = sum(map(beyond, runs))
    pairs = sum(beyond(one) and beyond(other) and one.gear is other.gear for one, other in zip(runs, runs[1:]))
    share_bound = poisson_bound(count) / len(runs)
    return hours, count, pairs, 1000.0 * poisson_bound(pairs) / hours, 1000.0 * share_bound ** 2 * len(runs) / hours


def sound_table(sound):
    lines = ["| gear, motion | windows | hours | beyond the threshold | two in a row | 95 % bound of alarms in 1000 h "
             "| the same, windows independent |", "|---|---|---|---|---|---|---|"]
    groups = [(f"{gear}, {motion}", list(own)) for (gear, motion), own in
              itertools.groupby(sound, key=lambda run: (run.gear.name, run.motion.name))]
    for name, own in [*groups, ("all", sound)]:
        hours, count, pairs, bound, independent = alarms(own)
        lines.append(f"| {name} | {len(own)} | {hours:.2f} | {count} | {pairs} | {bound:.0f} | {independent:.1f} |")
    return lines


def series(bench, gears):
    """Table of sound runs of many drawn gears, each compared with the reference of its own."""
    temperature = f"{{uniform: [{GREASE[0]}, {GREASE[1]}]}}"
    runs = []
    for number in range(gears):
        gear = health_runs.of_series(number)
        motion = SERIES_MOTIONS[number % len(SERIES_MOTIONS)]
        runs += bench.judge(bench.sound("series", gear, motion, temperature, SERIES_WINDOWS, 10000 + number), gear,
                            motion)
    lines = ["| motion | gears | windows | not judged | hours | beyond the threshold | gears with one | two in a row "
             "| 95 % bound of alarms in 1000 h | the same, windows independent |", "|---|" + "---|" * 9]
    judged = [run for run in runs if run.window]
    for name in [*(motion.name for motion in SERIES_MOTIONS), "all"]:
        own = [run for run in judged if name in (run.motion.name, "all")]
        if own:
            missing = sum(name in (run.motion.name, "all") for run in runs) - len(own)
            hours, count, pairs, bound, independent = alarms(own)
            with_one = len({run.gear.name for run in own if beyond(run)})
            lines.append(f"| {name} | {len({run.gear.name for run in own})} | {len(own)} | {missing} | {hours:.1f} | "
                         f"{count} | {with_one} | {pairs} | {bound:.3g} | {independent:.3g} |")
    return lines


def detectabilities(page):
    """d' by kind from the table of the bound on the page: motor and output encoder, current; check-up and at work."""
    text = page.read_text(encoding="utf-8")
    table = text[text.index("<!-- bound:begin -->"):text.index("<!-- bound:end -->")]
    rows = re.findall(r"^\| `(\w+)` \|(.*)\|$", table, re.MULTILINE)
    return {kind: [cell.strip() for cell in cells.split("|")] for kind, cells in rows}


def severities_of(faulty):
    return sorted({run.severity for run in faulty})


def fault_table(kinds, faulty, bound):
    severities = severities_of(faulty)
    lines = ["| kind | " + " | ".join(f"check-up, {severity:g}" for severity in severities) + " | d′ at best, 0.2 | "
             + " | ".join(f"at work, {severity:g}" for severity in severities) + " | d′ at best, 0.2 |",
             "|---|" + "---|" * (2 * len(severities) + 2)]
    names = [kind["kind"] for kind in kinds]
    for name in [*names, "all"]:
        cells = []  # of the check-up, then at work
        for at_work, column in ((False, 1), (True, 4)):
            cells += [share(beyond(run) for run in faulty if name in (run.kind, "all") and run.severity == severity
                            and (run.motion != CHECK_UP) == at_work) for severity in severities]
            cells.append(bound[name][column] if name in bound else "")
        lines.append(f"| {name if name == 'all' else f'`{name}`'} | " + " | ".join(cells) + " |")
    return lines


def cause_table(kinds, faulty):
    lines = [f"| kind | cause right, of alarms, severity {SURE} on | or in the set | named instead | severity: "
             "estimate less true, mean ± spread | its stated deviation |", "|---|---|---|---|---|---|"]
    for name in [*[kind["kind"] for kind in kinds], "all"]:
        own = [run for run in faulty if name in (run.kind, "all") and run.severity >= SURE and beyond(run)]
        if not own:
            lines.append(f"| `{name}` | - | - | | | |")
            continue
        wrong = [run.window.cause for run in own if not right(run)]
        instead = ", ".join(f"`{cause}` {wrong.count(cause)}" for cause in dict.fromkeys(wrong) if name != "all")
        errors = [run.window.severity - run.severity for run in own if right(run)]
        stated = [run.window.deviation for run in own if right(run)]
        sizes = f"{numpy.mean(errors):+.2f} ± {numpy.std(errors):.2f} | {numpy.mean(stated):.2f}" if errors else "|"
        lines.append(f"| {name if name == 'all' else f'`{name}`'} | {share(map(right, own))} "
                     f"| {share(map(in_set, own))} | {instead} | {sizes} |")
    return lines


def reliability(faulty):
    """(mean confidence, share right, number) by class of confidence, and the mean distance of the first two."""
    alarms = [run for run in faulty if beyond(run)]
    rows = []
    for low, high in zip(BINS, BINS[1:]):
        own = [run for run in alarms if low < run.window.confidence <= high]
        if own:
            rows.append((numpy.mean([run.window.confidence for run in own]), numpy.mean([right(run) for run in own]),
                         len(own)))
    return rows, sum(abs(stated - found) * count for stated, found, count in rows) / max(len(alarms), 1)


def draw_reliability(rows, path):
    figure, axis = plt.subplots(figsize=(4.6, 4.2), constrained_layout=True)
    axis.plot([0, 1], [0, 1], "k:", linewidth=1)
    for stated, found, count in rows:
        error = math.sqrt(max(found * (1.0 - found), 0.25 / count) / count)
        axis.errorbar(stated, found, error, fmt="o", color="tab:blue", capsize=3)
        axis.annotate(f"{count}", (stated, found), textcoords="offset points", xytext=(7, -12))
    axis.set_xlim(0, 1.05)
    axis.set_ylim(0, 1.05)
    axis.set_xlabel("stated confidence")
    axis.set_ylabel("share of alarms with the right cause")
    axis.grid(alpha=0.3)
    figure.savefig(path, dpi=90)
    plt.close(figure)


def draw_scores(kinds, sound, faulty, path):
    """Score of every window over the threshold, by kind and severity; sound ones on top."""
    names = ["sound", *[kind["kind"] for kind in kinds]]
    severities = severities_of(faulty)
    colours = dict(zip(dict.fromkeys(run.motion.name for run in sound), plt.get_cmap("tab10").colors))
    figure, axis = plt.subplots(figsize=(9, 7), constrained_layout=True)
    for run in [*sound, *faulty]:
        row = names.index("sound" if run.kind == "healthy" else run.kind)
        shift = 0.0 if run.kind == "healthy" else 0.28 * (severities.index(run.severity) - (len(severities) - 1) / 2)
        axis.plot(max(run.window.largest, 0.02), row + shift, "o" if run.motion == CHECK_UP else "x",
                  color=colours[run.motion.name], markersize=4, alpha=0.7)
    for name, colour in colours.items():
        axis.plot([], [], "o" if name == CHECK_UP.name else "x", color=colour, label=name)
    axis.axvline(1.0, color="k", linewidth=1)
    axis.set_xscale("log")
    axis.set_yticks(range(len(names)), names)
    axis.invert_yaxis()
    axis.set_xlabel("score of the window over the threshold; from top to bottom severity "
                    + ", ".join(f"{severity:g}" for severity in severities))
    axis.grid(alpha=0.3, axis="x")
    axis.legend(frameon=False, loc="lower center", bbox_to_anchor=(0.5, 1.0), ncol=len(colours))
    figure.savefig(path, dpi=90)
    plt.close(figure)


def draw_confusion(kinds, faulty, path):
    names = [kind["kind"] for kind in kinds]
    causes = names + ["circular_spline_tooth", "none"]
    matrix = numpy.zeros((len(names), len(causes)))
    for run in faulty:
        if beyond(run):
            matrix[names.index(run.kind), causes.index(run.window.cause)] += 1
    figure, axis = plt.subplots(figsize=(9, 7), constrained_layout=True)
    axis.imshow(matrix / numpy.maximum(matrix.sum(axis=1, keepdims=True), 1), cmap="Blues", vmin=0, vmax=1)
    for (row, column), count in numpy.ndenumerate(matrix):
        if count:
            axis.text(column, row, f"{count:.0f}", ha="center", va="center",
                      color="white" if count > matrix[row].sum() / 2 else "black")
    axis.set_xticks(range(len(causes)), causes, rotation=60, ha="right")
    axis.set_yticks(range(len(names)), names)
    axis.set_xlabel("cause named in the window with the alarm")
    axis.set_ylabel("fault, all severities and motions")
    figure.savefig(path, dpi=90)
    plt.close(figure)


def report(bench, trials, sound, faulty, missing, page):
    bound = detectabilities(page)
    rows, error = reliability(faulty)
    return [f"{len(sound)} sound and {len(faulty)} faulty windows, a run each; grease anywhere in {GREASE[0]:g} to "
            f"{GREASE[1]:g} °C. {len(missing)} more were not judged, whose operating point has "
            "fewer than eight windows of the reference.", "", *health_runs.split_table(("judged by", trials)), "",
            "### Sound drives", "", *sound_table(sound), "",
            "### Faults found", "", *fault_table(bench.kinds, faulty, bound), "",
            "![Score of every window over the threshold](images/health/seen.png)", "",
            "### Cause and severity", "", *cause_table(bench.kinds, faulty), "",
            "![Fault against the assessed cause](images/health/confusion.png)", "",
            f"Calibration error {error:.3f}: stated confidence less share of right causes, mean over the alarms by "
            "class of confidence.", "",
            "![Share of right causes against the stated confidence](images/health/reliability.png)"]


def main():
    parser = argparse.ArgumentParser(prog="evaluate_health", description=__doc__)
    parser.add_argument("--tool", type=pathlib.Path, required=True, help=argparse.SUPPRESS)
    parser.add_argument("--docs", type=pathlib.Path, required=True, help="folder that holds health.md")
    parser.add_argument("--work", type=pathlib.Path, required=True, help="folder for plans and bags")
    parser.add_argument("--jobs", type=int, default=2, help="runs at a time [2]")
    parser.add_argument("--fit", action="store_true", help="fit the signatures of the causes again, and nothing else")
    parser.add_argument("--quick", action="store_true", help="one gear, one severity: tables on the "
                        "terminal, the page stays")
    parser.add_argument("--series", type=int, metavar="GEARS", help="sound runs of so many drawn gears, into the "
                        "page's table of them, and nothing else; half a minute each on two cores")
    parser.add_argument("--figures", action="store_true", help="draw the figures of the single faults again too")
    options = parser.parse_args()
    bench = health_runs.Bench(options.tool, options.work, options.jobs)
    page = options.docs / "health.md"
    if options.fit:
        source = options.docs.parent / "src" / "health" / "fitted_signatures.hpp"
        health_signatures.write(bench, source, options.docs / "indicators.md")
        print(f"evaluate_health: wrote {source}; scripts/build takes it up", file=sys.stderr)
        return
    if options.quick:
        print("\n".join(report(bench, QUICK, *collect(bench, QUICK, 40), page)))
        return
    if options.series:
        page_section.write(page, "series", series(bench, options.series))
        return
    images = options.docs / "images" / "health"
    if options.figures:
        fault_figures.draw_all(options.tool, options.work, bench.kinds, images)
    sound, faulty, missing = collect(bench, JUDGED, 40)
    draw_scores(bench.kinds, sound, faulty, images / "seen.png")
    draw_confusion(bench.kinds, faulty, images / "confusion.png")
    draw_reliability(reliability(faulty)[0], images / "reliability.png")
    page_section.write(page, "health", report(bench, JUDGED, sound, faulty, missing, page))
    print(f"evaluate_health: wrote {page}", file=sys.stderr)


if __name__ == "__main__":
    main()
