# SPDX-License-Identifier: BSD-3-Clause
"""Evaluates the assessment on sound and faulty joints with real sensors, and writes docs/health.md."""
import argparse
import collections
import itertools
import math
import pathlib
import sys

import matplotlib
import numpy

import fault_figures
import health_carried
import health_file
import health_motions
import health_runs
import health_signatures
import lab
from health_runs import CHECK_UP, DRAWN, GREASE, JUDGED, QUICK, SERIES_FIRST, SERIES_MOTIONS, SOUND_WINDOWS

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (after the choice of its backend)

SURE = 0.3            # severity from which on the cause should be right
SOUND_CHECK_UPS = 40  # of each gear
SOUND_RUNS = 12       # at work
SERIES_RUNS = 48      # of a drawn gear
SET = 0.9             # probability that the causes of a set have together
BLOCK = 10            # windows that a verdict at work is made of the mean of
LEAST_WINDOWS = 3     # of them before the verdict may change
TAIL = 0.6            # score over the threshold from which on the tail is taken
CARRIED_BY = {health_runs.MODEL.name: "eccentricities unknown",
              health_runs.CALIBRATED_MODEL.name: "eccentricities known"}
BINS = health_motions.CLASSES
SLIPS = (0.0, 0.01, 0.02)  # of the bearing's cage


def collect(bench, trials, model=None):
    """(sound, faulty, not judged) runs of trials, each compared with the reference of its gear and motion; with a
    model motions to and fro at work, with that of the check-up."""
    sound, faulty = [], []
    for trial, motion in ((trial, motion) for trial in trials for motion in trial.motions):
        if model and not motion.moves:
            continue
        sound += sound_runs(bench, "sound", trial.gear, motion, 4,
                            SOUND_CHECK_UPS if motion.windows == 1 else SOUND_RUNS, model)
        bags = bench.faulty(trial, motion, DRAWN)
        faults = len(bench.kinds) * len(trial.severities)
        models = bench.beside(model, bags, motion, DRAWN, trial.seed, faults) if model else ()
        faulty += bench.judge(bags, trial.gear, motion, model, models)
    missing = [run for run in [*sound, *faulty] if not run.windows]
    return [run for run in sound if run.windows], [run for run in faulty if run.windows], missing


def sound_runs(bench, purpose, gear, motion, seed, runs, model=None):
    motion = motion if motion.windows == 1 else health_runs.at_work(motion, SOUND_WINDOWS)
    bags = bench.sound(purpose, gear, motion, DRAWN, runs, seed)
    models = bench.beside(model, bags, motion, DRAWN, seed, paths=runs) if model else ()
    return bench.judge(bags, gear, motion, model, models)


def last(run):
    return run.windows[-1]


def alarmed(run):
    """At its end: faults are there from the start of a run on."""
    return last(run).level != "OK"


def right(run):
    return last(run).cause == run.kind


def in_set(run):
    """Right, or among the causes that have SET of the probability together."""
    return right(run) or run.kind in last(run).alternatives


def share(flags):
    flags = list(flags)
    return f"{sum(flags)} of {len(flags)}" if flags else "-"


def poisson_bound(count):
    """What a Poisson variable's mean lies below with 95 %, having counted so many: chi square after Wilson and
    Hilferty."""
    degrees = 2 * (count + 1)
    return 0.5 * degrees * (1.0 - 2.0 / (9.0 * degrees) + 1.6449 * math.sqrt(2.0 / (9.0 * degrees))) ** 3


def alarms(run):
    """Times that the level left OK."""
    levels = ["OK", *(window.level for window in run.windows)]
    return sum(one == "OK" and other != "OK" for one, other in zip(levels, levels[1:]))


def largest_of_blocks(runs):
    """Largest score over the threshold of every BLOCK windows that follow each other, once a verdict may change."""
    scores = [[window.largest for window in run.windows if window.averaged >= LEAST_WINDOWS] for run in runs]
    return [max(own[first:first + BLOCK]) for own in scores for first in range(0, len(own), BLOCK)]


def tail(blocks, hours):
    """Blocks beyond the threshold expected in 1000 h, with 95 % bound, if scores beyond TAIL are exponential."""
    beyond = [score - TAIL for score in blocks if score > TAIL]
    if not beyond:
        return 0.0, 1000.0 * poisson_bound(0) / hours
    degrees = 2 * len(beyond)  # 2 n mean / true mean: chi square of so many, here its 5 % quantile
    low = degrees * (1.0 - 2.0 / (9.0 * degrees) - 1.6449 * math.sqrt(2.0 / (9.0 * degrees))) ** 3
    mean = numpy.mean(beyond)
    return (1000.0 * len(beyond) / hours * math.exp(-(1.0 - TAIL) / mean),
            1000.0 * poisson_bound(len(beyond)) / hours * math.exp(-(1.0 - TAIL) / (mean * degrees / low)))


SOUND_COLUMNS = ["runs", "windows judged", "windows not judged", "hours judged", "alarms",
                 "alarms in 1000 h, 95 % upper bound", "largest score over threshold",
                 "scores above threshold in 1000 h, estimate", "scores above threshold in 1000 h, 95 % upper bound"]


def rounded(number, digits):
    """To so many digits, without an exponent."""
    return f"{float(f'{number:.{digits}g}'):g}"


def sound_row(runs):
    """Of SOUND_COLUMNS; windows that were not judged lie at an operating point with no reference."""
    judged = [run for run in runs if run.windows]
    windows = sum(len(run.windows) for run in judged)
    missing = sum(run.motion.windows for run in runs) - windows
    hours = sum(len(run.windows) * run.motion.window for run in judged) / 3600.0
    found = sum(map(alarms, judged))
    blocks = largest_of_blocks(judged)
    expected, bound = tail(blocks, hours)
    return (f"{len(judged)} | {windows} | {missing} | {hours:.1f} | {found} | "
            f"{rounded(1000.0 * poisson_bound(found) / hours, 3)} | {max(blocks):.2f} | {rounded(expected, 2)} | "
            f"{rounded(bound, 2)}")


def sound_table(groups, with_all=True):
    """Of (name, runs); the last row is of all."""
    lines = ["| sound drives | " + " | ".join(SOUND_COLUMNS) + " |", "|---|" + "---|" * len(SOUND_COLUMNS)]
    for name, runs in [*groups, *[("all", [run for _, runs in groups for run in runs])][:with_all]]:
        lines.append(f"| {name} | {sound_row(runs)} |")
    return lines


def check_up_line(sound):
    runs = [run for run in sound if run.motion == CHECK_UP]
    found = sum(map(alarmed, runs))
    gears = len({run.gear.name for run in runs})
    return (f"- {len(runs)} check-ups of {gears} sound gears gave {found} alarm{'s' * (found != 1)}. With 95 % "
            f"confidence at most {100.0 * poisson_bound(found) / len(runs):.2g} % of sound check-ups give an alarm.")


def series(bench, gears):
    """Table of work of many drawn gears without a fault, each compared with the reference of its own."""
    groups = {motion.name: [] for motion in SERIES_MOTIONS}
    for number in range(gears):
        motion = SERIES_MOTIONS[number % len(SERIES_MOTIONS)]
        groups[motion.name] += sound_runs(bench, "series", health_runs.of_series(SERIES_FIRST + number), motion,
                                          10000 + number, SERIES_RUNS)
    counts = {name: len({run.gear.name for run in runs}) for name, runs in groups.items()}
    return sound_table([(f"{name}, {counts[name]} gears", runs) for name, runs in groups.items() if runs])


def severities_of(faulty):
    return sorted({run.severity for run in faulty})


def found_in(check_up, severity):
    """Name of a column."""
    return f"found {'in check-ups' if check_up else 'at work'}, severity {severity:g}"


def kind_table(kinds, faulty):
    """What was found of each kind, and as what."""
    severities = severities_of(faulty)
    places = [(at_work, severity) for at_work in (False, True) for severity in severities]
    lines = ["| kind of fault | " + " | ".join(found_in(not at_work, severity) for at_work, severity in places)
             + f" | named cause right, of alarms from severity {SURE} on | true cause in the set, of these alarms "
             "| wrong causes named | severity less true severity, mean ± spread "
             "| stated deviation of the severity, mean |",
             "|---" * (len(places) + 6) + "|"]
    for name in [*[kind["kind"] for kind in kinds], "all"]:
        own = [run for run in faulty if name in (run.kind, "all")]
        cells = [share(alarmed(run) for run in own if run.severity == severity and (run.motion != CHECK_UP) == at_work)
                 for at_work, severity in places]
        sure = [run for run in own if run.severity >= SURE and alarmed(run)]
        wrong = [last(run).cause for run in sure if not right(run)]
        instead = ", ".join(f"`{cause}` {wrong.count(cause)}" for cause in dict.fromkeys(wrong) if name != "all")
        errors = [last(run).severity - run.severity for run in sure if right(run)]
        stated = [last(run).deviation for run in sure if right(run)]
        sizes = ([f"{numpy.mean(errors):+.2f} ± {numpy.std(errors):.2f}", f"{numpy.mean(stated):.2f}"] if errors
                 else ["", ""])
        cells += [share(map(right, sure)), share(map(in_set, sure)), instead, *sizes]
        lines.append(f"| {name if name == 'all' else f'`{name}`'} | " + " | ".join(cells) + " |")
    return lines


def reliability(faulty):
    """(mean confidence, share right, number) by class of confidence, and the mean distance of the first two."""
    found = list(filter(alarmed, faulty))
    rows = []
    for low, high in zip(BINS, BINS[1:]):
        own = [run for run in found if low < last(run).confidence <= high]
        if own:
            rows.append((numpy.mean([last(run).confidence for run in own]), numpy.mean([right(run) for run in own]),
                         len(own)))
    return rows, sum(abs(stated - share) * count for stated, share, count in rows) / max(len(found), 1)


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
    """Score of every run's end over the threshold, by kind and severity; sound ones on top."""
    names = ["sound", *[kind["kind"] for kind in kinds]]
    severities = severities_of(faulty)
    colours = dict(zip(dict.fromkeys(run.motion.name for run in sound), plt.get_cmap("tab10").colors))
    figure, axis = plt.subplots(figsize=(9, 7), constrained_layout=True)
    for run in [*sound, *faulty]:
        row = names.index("sound" if run.kind == "healthy" else run.kind)
        shift = 0.0 if run.kind == "healthy" else 0.28 * (severities.index(run.severity) - (len(severities) - 1) / 2)
        axis.plot(max(last(run).largest, 0.02), row + shift, "o" if run.motion == CHECK_UP else "x",
                  color=colours[run.motion.name], markersize=4, alpha=0.7)
    for name, colour in colours.items():
        axis.plot([], [], "o" if name == CHECK_UP.name else "x", color=colour, label=name)
    axis.axvline(1.0, color="k", linewidth=1)
    axis.set_xscale("log")
    axis.set_yticks(range(len(names)), names)
    axis.invert_yaxis()
    axis.set_xlabel("score over the threshold; from top to bottom severity "
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
        if alarmed(run):
            matrix[names.index(run.kind), causes.index(last(run).cause)] += 1
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


def by_motion(runs):
    """(name, runs) of each gear in each motion."""
    return [(f"{gear}, {motion}", list(own)) for (gear, motion), own in
            itertools.groupby(runs, key=lambda run: (run.gear.name, run.motion.name))]


def never_found(runs):
    kinds = [kind for kind in dict.fromkeys(run.kind for run in runs)
             if not any(alarmed(run) for run in runs if run.kind == kind)]
    return ", ".join(f"`{kind}`" for kind in kinds) or "none"


def carried_report(bench, trials, own):
    """Motions to and fro of trials without references of their own; `own`: faulty runs compared with such."""
    columns = {"of the same motion": [run for run in own if run.motion.moves]}
    sound = {}
    for model in health_runs.MODELS:
        name = f"carried, {CARRIED_BY[model.name]}"
        sound[name], columns[name], _ = collect(bench, trials, model)
    severities = severities_of(columns["of the same motion"])
    lines = ["| reference | " + " | ".join(f"found, severity {severity:g}" for severity in severities)
             + f" | named cause right, of alarms from severity {SURE} on | true cause in the set, of these alarms "
             "| calibration error | never found |",
             "|---" * (len(severities) + 5) + "|"]
    for name, runs in columns.items():
        sure = [run for run in runs if alarmed(run) and run.severity >= SURE]
        cells = [share(alarmed(run) for run in runs if run.severity == severity) for severity in severities]
        cells += [share(map(right, sure)), share(map(in_set, sure)), f"{reliability(runs)[1]:.2f}", never_found(runs)]
        lines.append(f"| {name} | " + " | ".join(cells) + " |")
    runs = [run for own in sound.values() for run in own]
    hours = sum(len(run.windows) * run.motion.window for run in runs) / 3600.0
    return [f"Sound drives judged by carried references gave {sum(map(alarms, runs))} alarms in {hours:.1f} h.", "",
            *sound_table(list(sound.items()), False), "", *lines]


def slip_table(bench, trials):
    """Faults of the bearing, whose balls are not where its lines are sought; a sound one is the same with slip."""
    kinds = [kind["kind"] for kind in bench.kinds if kind["kind"].startswith("bearing_")]
    runs = collections.defaultdict(list)
    for trial, slip in itertools.product(trials, SLIPS):
        gear = trial.gear._replace(name=f"{trial.gear.name} slip {slip:g}",
                                   settings=[*trial.gear.settings, f"  bearing.cage_slip: {slip}"])
        for motion in trial.motions:
            bags = bench.faulty(trial._replace(gear=gear), motion, DRAWN, kinds)
            runs[slip] += bench.judge(bags, trial.gear, motion)
    columns = list(itertools.product((True, False), severities_of(runs[SLIPS[0]])))
    lines = ["| slip | " + " | ".join(found_in(*column) for column in columns)
             + " | named cause right, of alarms | true cause in the set, of alarms |",
             "|---" * (len(columns) + 3) + "|"]
    for slip, own in runs.items():
        own = [run for run in own if run.windows]
        found = [run for run in own if alarmed(run)]
        cells = [share(alarmed(run) for run in own if (run.motion == CHECK_UP, run.severity) == column)
                 for column in columns]
        lines.append(f"| {100.0 * slip:g} % | " + " | ".join(cells)
                     + f" | {share(map(right, found))} | {share(map(in_set, found))} |")
    return lines


def by_occurrence(faulty, occurrence):
    """Share of alarms with the right cause, where the kinds come as often as they are rated; the others as the mean."""
    found = list(filter(alarmed, faulty))
    mean = numpy.mean(list(occurrence.values()))
    return numpy.average(list(map(right, found)), weights=[occurrence.get(run.kind, mean) for run in found])


def report(bench, trials, occurrence, sound, faulty, missing):
    rows, error = reliability(faulty)
    groups = by_motion([run for run in sound if run.motion != CHECK_UP])
    return [f"The evaluation has {len(sound)} sound and {len(faulty)} faulty runs, with grease between {GREASE[0]:g} "
            f"and {GREASE[1]:g} °C. For {len(missing)} further runs the reference has fewer than the eight "
            "windows that a verdict needs.", "",
            *health_runs.split_table(("evaluation", trials)), "",
            *kind_table(bench.kinds, faulty), "",
            f"The calibration error of the confidence is {error:.3f}. The named cause is right in "
            f"{share(map(right, filter(alarmed, faulty)))} alarms. If faults were as frequent as the FMECA rates them, "
            f"the named cause would be right in {100.0 * by_occurrence(faulty, occurrence):.0f} % of the alarms.",
            "",
            "![Score of every run over the threshold](images/health/seen.png)",
            "![Fault against the assessed cause](images/health/confusion.png)",
            "![Share of right causes against the stated confidence](images/health/reliability.png)", "",
            "### Sound drives", "", check_up_line(sound), "", *sound_table(groups)]


def main():
    parser = argparse.ArgumentParser(prog="evaluate_health", description=__doc__)
    parser.add_argument("--tool", type=pathlib.Path, required=True, help=argparse.SUPPRESS)
    parser.add_argument("--docs", type=pathlib.Path, required=True, help="folder that holds health.md")
    parser.add_argument("--work", type=pathlib.Path, required=True, help="folder for plans and bags")
    parser.add_argument("--jobs", type=int, default=2, help="runs at a time [2]")
    parser.add_argument("--fit", action="store_true", help="fit the signatures of the causes, and the errors of a "
                        "reference that is carried, again, and nothing else")
    parser.add_argument("--quick", action="store_true", help="one gear, one severity: tables on the "
                        "terminal, the page stays; with --fit: errors alone, by one gear in the check-up and "
                        "two in other motions")
    parser.add_argument("--motions", action="store_true", help="a drawn gear and another model in motions "
                        "that no signature was made in, into the page's table of them, and nothing else; some "
                        "ten minutes on two cores")
    parser.add_argument("--series", type=int, metavar="GEARS", help="sound runs of so many drawn gears, into the "
                        "page's table of them, and nothing else; four minutes each on two cores")
    parser.add_argument("--figures", action="store_true", help="draw the figures of the single faults again too")
    options = parser.parse_args()
    bench = health_runs.Bench(options.tool, options.work, options.jobs)
    page = options.docs / "health.md"
    file = options.docs.parent / "config" / "signatures" / "size_25.yaml"
    if options.fit:
        if not options.quick:
            health_carried.write(bench, file)
        health_signatures.write(bench, file, options.docs / "indicators.md",
                                health_runs.CALIBRATED_QUICK if options.quick else health_runs.CALIBRATED,
                                options.quick)
        print(f"evaluate_health: wrote {file}", file=sys.stderr)
        return
    occurrence = health_file.read(file)["occurrence"]
    if options.quick:
        print("\n".join(report(bench, QUICK, occurrence, *collect(bench, QUICK))))
        return
    if options.motions:
        lab.write(page, "motions", health_motions.judged_table(bench))
        return
    if options.series:
        lab.write(page, "series", series(bench, options.series))
        return
    images = options.docs / "images" / "health"
    if options.figures:
        fault_figures.draw_all(options.tool, options.work, bench.kinds, images)
    sound, faulty, missing = collect(bench, JUDGED)
    draw_scores(bench.kinds, sound, faulty, images / "seen.png")
    draw_confusion(bench.kinds, faulty, images / "confusion.png")
    draw_reliability(reliability(faulty)[0], images / "reliability.png")
    lab.write(page, "health", report(bench, JUDGED, occurrence, sound, faulty, missing))
    lab.write(page, "slip", slip_table(bench, [trial for trial in JUDGED if trial.gear.alike]))
    lab.write(page, "carried", carried_report(bench, JUDGED, faulty))
    print(f"evaluate_health: wrote {page}", file=sys.stderr)


if __name__ == "__main__":
    main()
