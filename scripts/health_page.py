# SPDX-License-Identifier: BSD-3-Clause
"""Evaluates the assessment on sound and faulty joints with real sensors, and writes docs/health.md."""
import argparse
import collections
import math
import pathlib
import statistics
import sys

import matplotlib
import numpy

import fault_figures
import health_runs
import health_signatures
import page_section
from health_runs import CHECK_UP, JUDGED, NOISY, POINTS, STEADY_POINTS, TURNING, WARM

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (after the choice of its backend)

ALARM_SHARE = 0.01    # false alarms allowed for the smallest severity detected
# Kinds that a joint's signals tell from each other only by how strong they are, if at all.
CAUSE_SETS = [("rear_section_crack", "flange_crack"), ("tooth_root_crack", "tooth_tip_crack", "pitting")]
ARCSEC = math.pi / 180.0 / 3600.0

Evidence = collections.namedtuple("Evidence", "sound faulty delayed")


def collect(bench, sound_hours):
    """Verdicts on all runs."""
    sound, faulty = [], []
    for condition in (WARM, NOISY):
        reference = bench.reference(condition)
        for point in health_runs.points_of(condition):
            window = health_runs.window_time(point)
            repeats = max(round(3600.0 * sound_hours / (health_runs.SOUND_WINDOWS * window)), 1)
            bags = bench.sound("sound", condition, point, health_runs.SOUND_WINDOWS, repeats, 4)
            sound += bench.judge(bags, condition, point, reference)
            faulty += bench.judge(bench.faulty(JUDGED, condition, point), condition, point, reference)
    return sound, faulty, bench.judge(bench.setting_in(WARM), WARM, CHECK_UP, bench.reference(WARM))


def alarms(run):
    """How often WARN or ERROR begins."""
    levels = ["OK", *[window.level for window in run.windows]]
    return sum(before == "OK" and after != "OK" for before, after in zip(levels, levels[1:]))


def alarm(run):
    """The first window with WARN or ERROR; None: there was none."""
    return next((window for window in run.windows if window.level != "OK"), None)


def sound_table(sound):
    lines = ["| motion | window [s] | hours | windows | beyond the threshold | alarms | 95 % bound of alarms in 1000 h "
             "|",
             "|---|---|---|---|---|---|---|"]
    rows = [(f"{point.name}", [run for run in sound if run.point == point]) for point in POINTS]
    for name, own in [*rows, ("all", sound)]:
        windows = sum(len(run.windows) for run in own)
        hours = sum(len(run.windows) * health_runs.window_time(run.point) for run in own) / 3600.0
        beyond = sum(window.largest > 1.0 for run in own for window in run.windows)
        count = sum(alarms(run) for run in own)
        length = "" if name == "all" else f"{health_runs.window_time(own[0].point):.0f}"
        lines.append(f"| {name} | {length} | {hours:.1f} | {windows} | {beyond} | {count} | "
                     f"{1000.0 * poisson_bound(count) / hours:.0f} |")
    return lines


def poisson_bound(count):
    """What a Poisson variable's mean lies below with 95 %, having counted so many: chi square after Wilson and
    Hilferty."""
    degrees = 2 * (count + 1)
    return 0.5 * degrees * (1.0 - 2.0 / (9.0 * degrees) + 1.6449 * math.sqrt(2.0 / (9.0 * degrees))) ** 3


def limits(sound):
    """By point and condition the score that 1 % of the sound windows exceed."""
    groups = collections.defaultdict(list)
    for run in sound:
        groups[run.point, run.condition] += [window.largest for window in run.windows]
    return {key: float(numpy.quantile(scores, 1.0 - ALARM_SHARE)) for key, scores in groups.items()}


def weakest(run):
    """Smallest score among a faulty run's windows, which decides on an alarm."""
    return min((window.largest for window in run.windows), default=0.0)


def smallest(kind, faulty, limit, points):
    """Smallest severity from which on every window lies beyond the limit, at the best of the points."""
    best = (math.inf, "none")
    for point in points:
        severities = {run.severity: weakest(run) > limit[run.point, run.condition] for run in faulty
                      if (run.kind, run.point, run.condition) == (kind, point, WARM)}
        seen = math.inf
        for severity in sorted(severities, reverse=True):
            if not severities[severity]:
                break
            seen = severity
        best = min(best, (seen, point.name), key=lambda entry: entry[0])
    return best


def right(run):
    cause = alarm(run).cause
    return cause == run.kind, cause == run.kind or any({cause, run.kind} <= set(group) for group in CAUSE_SETS)


def share(flags):
    flags = list(flags)
    return f"{sum(flags)} of {len(flags)}" if flags else "-"


def fault_table(kinds, faulty, limit):
    severities = JUDGED.severities
    lines = ["| kind | " + " | ".join(f"alarms at {severity:g}" for severity in severities)
             + " | smallest severity at 1 % false alarms: check-up | steady, where best | cause right, of alarms | or "
             "of its set |",
             "|---|" + "---|" * (len(severities) + 4)]
    totals = []
    for kind in kinds:
        own = [run for run in faulty if run.kind == kind["kind"]]
        alarmed = [run for run in own if alarm(run)]
        totals += alarmed
        cells = [share(alarm(run) is not None for run in own if run.severity == severity) for severity in severities]
        check_up, (best, where) = smallest(kind["kind"], faulty, limit,
                                           [CHECK_UP]), smallest(kind["kind"], faulty, limit, STEADY_POINTS)
        lines.append(f"| `{kind['kind']}` | " + " | ".join(cells)
                     + f" | {check_up[0] if check_up[0] < math.inf else '> 1'} "
                     f"| {f'{best} ({where})' if best < math.inf else '> 1'} "
                     f"| {share(right(run)[0] for run in alarmed)} | {share(right(run)[1] for run in alarmed)} |")
    lines.append("| all | " + " | ".join(share(alarm(run) is not None for run in faulty if run.severity == severity)
                                         for severity in severities)
                 + f" | | | {share(right(run)[0] for run in totals)} | {share(right(run)[1] for run in totals)} |")
    return lines


def size_table(kinds, sound, faulty):
    """The indicator with the largest change at severity 1, relative to sound drives."""
    lines = ["| kind | where it stands out most | indicator | sound: mean ± spread | severity 1 | change over spread |",
             "|---|---|---|---|---|---|"]
    for kind in kinds:
        rows = []
        for run in faulty:
            if (run.kind, run.severity, run.condition) != (kind["kind"], 1.0, WARM) or not run.windows:
                continue
            window = min(run.windows, key=lambda window: window.largest)
            scored = {name: score for name, score in window.scores.items() if score is not None}
            name = max(scored, key=lambda name: abs(scored[name]))
            rows.append((abs(scored[name]), run.point, name, window.values[name]))
        if not rows:
            continue
        _, point, name, value = max(rows, key=lambda row: row[0])
        healthy = [window.values[name] for run in sound if run.point == point and run.condition is WARM
                   for window in run.windows if window.values[name] is not None]
        mean, spread = statistics.mean(healthy), statistics.stdev(healthy)
        scale, unit = unit_of(name)
        lines.append(f"| `{kind['kind']}` | {point.name} | `{name}` | {scale * mean:.4g} ± {scale * spread:.2g} {unit} "
                     f"| {scale * value:.4g} | {(value - mean) / spread:+.3g} |")
    return lines


def unit_of(name):
    if name.startswith("error") or name in ("kinematic_error", "lost_motion", "residual_rms"):
        return 1.0 / ARCSEC, "″"
    if name.startswith("torque") or name in ("running_torque", "coulomb_torque"):
        return 1e3, "mN·m"
    units = {"torsional_stiffness": (1e-3, "kN·m/rad"), "hysteresis_area": (1e3, "mJ"),
             "viscous_friction": (1e6, "µN·m·s/rad")}
    return units.get(name, (1.0, ""))


def loop_table(sound, faulty):
    """Stiffness, lost motion and loop over severity, in the check-up."""
    names = ["torsional_stiffness", "lost_motion", "hysteresis_area"]

    def means(runs):
        values = [[window.values[name] for run in runs for window in run.windows if window.values[name] is not None]
                  for name in names]
        return [f"{unit_of(name)[0] * statistics.mean(own):.2f}" if own else "-" for name, own in zip(names, values)]

    lines = ["| kind | severity | K1 [kN·m/rad] | lost motion [″] | loop [mJ] |", "|---|---|---|---|---|",
             "| sound | 0 | "
             + " | ".join(means([run for run in sound if run.point == CHECK_UP and run.condition is WARM]))
             + " |"]
    for kind in ["interface_wear", "tooth_wear", "wave_generator_wear", "rear_section_crack", "flange_crack",
                 "buckling"]:
        for severity in JUDGED.severities:
            own = [run for run in faulty if (run.kind, run.severity, run.point, run.condition)
                   == (kind, severity, CHECK_UP, WARM)]
            lines.append(f"| `{kind}` | {severity:g} | " + " | ".join(means(own)) + " |")
    return lines


def delay_table(kinds, delayed):
    lines = ["| kind | from the onset to the end of the window with the alarm [motor turns] |", "|---|---|"]
    for kind in kinds:
        for run in delayed:
            if run.kind == kind["kind"]:
                first = alarm(run)
                turns = (first.number - health_runs.SET_IN) * health_runs.WINDOW_TURNS if first else math.inf
                lines.append(f"| `{run.kind}` | {f'{turns:.0f}' if first else 'no alarm'} |")
    return lines


def draw_seen(kinds, faulty, path):
    """Score by kind and motion, at two severities."""
    severities = [0.3, 1.0]
    figure, axes = plt.subplots(1, len(severities), figsize=(12, 6), sharey=True, constrained_layout=True)
    for axis, severity in zip(axes, severities):
        table = numpy.full((len(kinds), len(POINTS)), numpy.nan)
        for row, kind in enumerate(kinds):
            for column, point in enumerate(POINTS):
                for run in faulty:
                    if (run.kind, run.severity, run.point, run.condition) == (kind["kind"], severity, point, WARM):
                        table[row, column] = weakest(run)
        image = axis.imshow(numpy.log10(numpy.maximum(table, 0.1)), cmap="RdBu_r", vmin=-1.0, vmax=1.0, aspect="auto")
        for (row, column), value in numpy.ndenumerate(table):
            if numpy.isfinite(value):
                axis.text(column, row, f"{value:.1f}", ha="center", va="center", fontsize=8,
                          color="white" if abs(math.log10(max(value, 0.1))) > 0.6 else "black")
        axis.set_title(f"severity {severity:g}")
        axis.set_xticks(range(len(POINTS)), [point.name.split(":")[0] for point in POINTS], rotation=40, ha="right",
                        fontsize=8)
        axis.set_yticks(range(len(kinds)), [kind["kind"] for kind in kinds], fontsize=8)
    figure.colorbar(image, ax=axes, ticks=[-1, 0, 1], shrink=0.6).set_ticklabels(["0.1", "1: threshold", "10"])
    figure.savefig(path, dpi=90)
    plt.close(figure)


def draw_confusion(kinds, faulty, path):
    names = [kind["kind"] for kind in kinds]
    causes = names + ["circular_spline_tooth"]
    matrix = numpy.zeros((len(names), len(causes)))
    for run in faulty:
        if alarm(run):
            matrix[names.index(run.kind), causes.index(alarm(run).cause)] += 1
    figure, axis = plt.subplots(figsize=(9, 7), constrained_layout=True)
    axis.imshow(matrix / numpy.maximum(matrix.sum(axis=1, keepdims=True), 1), cmap="Blues", vmin=0, vmax=1)
    for (row, column), count in numpy.ndenumerate(matrix):
        if count:
            axis.text(column, row, f"{count:.0f}", ha="center", va="center",
                      color="white" if count > matrix[row].sum() / 2 else "black")
    axis.set_xticks(range(len(causes)), causes, rotation=60, ha="right")
    axis.set_yticks(range(len(names)), names)
    axis.set_xlabel("cause at the first alarm")
    axis.set_ylabel("fault, all severities and motions")
    figure.savefig(path, dpi=90)
    plt.close(figure)


def draw_roc(sound, faulty, path):
    figure, axes = plt.subplots(1, 2, figsize=(10, 4.2), sharey=True, constrained_layout=True)
    for axis, name, points in ((axes[0], "steady speed and load", STEADY_POINTS),
                               (axes[1], "swinging load", [TURNING, CHECK_UP])):
        healthy = numpy.array([window.largest for run in sound if run.point in points for window in run.windows])
        thresholds = numpy.unique(numpy.concatenate([healthy, numpy.linspace(0.0, 5.0, 400)]))
        share_sound = [(healthy > threshold).mean() for threshold in thresholds]
        for severity in JUDGED.severities:
            scores = numpy.array([window.largest for run in faulty if run.severity == severity and run.point in points
                                  for window in run.windows])
            axis.step(share_sound, [(scores > threshold).mean() for threshold in thresholds],
                      label=f"severity {severity:g}")
        axis.set_xscale("symlog", linthresh=1e-3)
        axis.set_xlim(0, 1)
        axis.set_ylim(0, 1)
        axis.set_title(name, fontsize=9)
        axis.set_xlabel("share of sound windows beyond the threshold")
        axis.grid(alpha=0.3)
    axes[0].set_ylabel("share of faulty windows beyond it")
    axes[1].legend(frameon=False, loc="lower right")
    figure.savefig(path, dpi=90)
    plt.close(figure)


def main():
    parser = argparse.ArgumentParser(prog="evaluate_health", description=__doc__)
    parser.add_argument("--tool", type=pathlib.Path, required=True, help=argparse.SUPPRESS)
    parser.add_argument("--docs", type=pathlib.Path, required=True, help="folder that holds health.md")
    parser.add_argument("--work", type=pathlib.Path, required=True, help="folder for plans and bags")
    parser.add_argument("--jobs", type=int, default=2, help="runs at a time [2]")
    parser.add_argument("--fit", action="store_true", help="fit the signatures of the causes again, and nothing else")
    parser.add_argument("--sound-hours", type=float, default=2.0, help="of sound running in each motion [2]")
    options = parser.parse_args()
    bench = health_runs.Bench(options.tool, options.work, options.jobs)
    if options.fit:
        source = options.docs.parent / "include" / "harmonic_joint_twin" / "health" / "fitted_signatures.hpp"
        health_signatures.write(bench, source, options.docs / "indicators.md")
        print(f"evaluate_health: wrote {source}; scripts/build takes it up", file=sys.stderr)
        return
    images = options.docs / "images" / "health"
    fault_figures.draw_all(options.tool, options.work, bench.kinds, images)
    sound, faulty, delayed = collect(bench, options.sound_hours)
    draw_seen(bench.kinds, faulty, images / "seen.png")
    draw_confusion(bench.kinds, faulty, images / "confusion.png")
    draw_roc(sound, faulty, images / "roc.png")
    page_section.write(options.docs / "health.md", "health", [
        f"{len(sound)} sound and {len(faulty) + len(delayed)} faulty runs; " + ", ".join(
            f"`{condition.name}`: {condition.temperatures[0]:g} to {condition.temperatures[1]:g} °C, noise of the "
            f"encoders × {condition.noise:g}"
            for condition in sorted({run.condition for run in faulty}, key=lambda condition: condition.noise)) + ".",
        "",
        "### Sound drives", "", *sound_table(sound), "",
        "### Faults", "", *fault_table(bench.kinds, faulty, limits(sound)), "",
        "![Score of every fault in every motion, over the threshold](images/health/seen.png)", "",
        "![Share of faulty windows beyond a threshold against that of sound ones](images/health/roc.png)", "",
        "![Fault against the assessed cause](images/health/confusion.png)", "",
        "### Sizes against the noise", "", *size_table(bench.kinds, sound, faulty), "",
        "### Stiffness and loop", "", *loop_table(sound, faulty), "",
        "### Faults that set in on the way", "", *delay_table(bench.kinds, delayed)])
    print(f"evaluate_health: wrote {options.docs / 'health.md'}", file=sys.stderr)


if __name__ == "__main__":
    main()
