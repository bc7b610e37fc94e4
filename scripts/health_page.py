# SPDX-License-Identifier: BSD-3-Clause
"""Evaluates the assessment: faults of every kind set in on running drives with real sensors, sound drives run on.

Every run begins sound, so that the reference is learned on the same joint; what the assessment says afterwards is
counted. Runs are made by `joint_twin sweep`, in bags, and taken from there: what is there already is not run again."""
import argparse
import collections
import json
import math
import pathlib
import re
import statistics
import subprocess
import sys

import matplotlib
import numpy
import rosbag

import page_section

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (after the choice of its backend)

RATIO = 101.0
WINDOW_TURNS = 25.0       # of the motor
LEARNING = 10             # windows of the reference
SOUND = 14                # windows before a fault sets in
FAULTY = 8                # and after
SEVERITIES = [0.1, 0.3, 1.0]
ALARM_SHARE = 0.01        # false alarms allowed for the smallest severity detected

Point = collections.namedtuple("Point", "name degrees load temperature")
POINTS = [Point("15°/s, 60 N·m", 15.0, 60.0, 30.0), Point("90°/s, 0 N·m", 90.0, 0.0, 30.0),
          Point("90°/s, 60 N·m", 90.0, 60.0, 40.0), Point("180°/s, 30 N·m", 180.0, 30.0, 40.0)]

Window = collections.namedtuple("Window", "end state level cause score evidence")
Run = collections.namedtuple("Run", "point kind severity windows indicators")


def window_time(point):
    return WINDOW_TURNS * 360.0 / (point.degrees * RATIO)


def onset(point):
    return 0.5 + SOUND * window_time(point)


def kinds(tool):
    listed = subprocess.run([tool, "faults", "--json"], check=True, capture_output=True, text=True).stdout
    return json.loads(listed)


def place(kind):
    """The whole member where that is meant, else a place in the middle."""
    return kind["first_place"] if kind["first_place"] < 0 else min(40, kind["last_place"])


def plan(point, duration, repeats, classes):
    lines = [f"name: health_{point.degrees:.0f}_{point.load:.0f}", "seed: 1", f"duration: {duration:.6f}",
             "overlays: [real_sensors.yaml]", "set:", "  solver.scene: auto",
             f"  input.temperature: {point.temperature}", f"  indicators.window_turns: {WINDOW_TURNS}",
             f"  indicators.baseline_windows: {LEARNING}", "  publish.indicators_rate: 10.0",
             "  publish.joint_states_rate: 0.01", "  publish.encoders_rate: 0.01", "  publish.contact_forces_rate: 0.01",
             "  publish.health_rate: 0.01", f"repeats: {repeats}", "duty:", "  - name: turning",
             f"    speed: {{constant: {math.radians(point.degrees):.6f}}}", "    bandwidth: 8.0",
             f"    load: {{constant: {point.load}}}", "classes:", *classes, "record:", "  format: bag"]
    return "\n".join(lines) + "\n"


def fault_classes(point, faults):
    grid = ", ".join(str(severity) for severity in SEVERITIES)
    for kind in faults:
        yield f"  {kind['kind']}:"
        yield (f"    - {{kind: {kind['kind']}, severity: {{grid: [{grid}]}}, place: {place(kind)}, "
               f"onset: {onset(point):.6f}}}")


def sweep(options, name, text):
    path = options.work / f"{name}.yaml"
    path.write_text(text)
    out = options.work / name
    done = subprocess.run([options.tool, "sweep", path, "--out", out, "--jobs", str(options.jobs)], check=False)
    if done.returncode not in (0, 1) or not (out / "index.csv").exists():  # 1: some run failed, as its row in the index says
        sys.exit(f"evaluate_health: the sweep of {path} ended with {done.returncode}")
    return sorted((out / "runs").glob("*.bag"))


def read_run(point, path):
    windows, indicators, label = {}, {}, {}
    with rosbag.Bag(str(path)) as bag:
        for topic, message, _ in bag.read_messages():
            if topic.endswith("/assessment") and message.windows > 0:
                windows.setdefault(message.windows, Window(message.window_end.to_sec(), message.state, message.level,
                                                           message.cause, message.largest_score, message.evidence))
            elif topic.endswith("/indicators") and message.windows > 0:
                indicators.setdefault(message.windows, message)
            elif topic.endswith("/run"):
                label = json.loads(message.data)
    faults = label.get("faults", [])
    kind, severity = (faults[0]["kind"], faults[0]["severity"]) if faults else ("healthy", 0.0)
    first = min((window.end for window in windows.values()), default=0.0)
    # Stamps count from the epoch of the simulation; windows from the start of the run.
    begin = first - 0.5 - window_time(point) if windows else 0.0
    ordered = [windows[number]._replace(end=windows[number].end - begin) for number in sorted(windows)]
    return Run(point, kind, severity, ordered, [indicators[number] for number in sorted(indicators)])


def collect(options):
    faults = kinds(options.tool)
    runs = []
    for point in POINTS:
        tag = f"{point.degrees:.0f}_{point.load:.0f}"
        print(f"evaluate_health: {point.name}", file=sys.stderr)
        length = onset(point) + FAULTY * window_time(point)
        paths = sweep(options, f"faults_{tag}", plan(point, length, 1, list(fault_classes(point, faults))))
        sound = 0.5 + (LEARNING + options.sound_windows) * window_time(point)
        paths += sweep(options, f"sound_{tag}", plan(point, sound, options.sound_runs, ["  healthy: []"]))
        runs += [read_run(point, path) for path in paths]
    return faults, runs


def judged(run):
    """Windows held against the reference: of a sound run all, of a faulty one those wholly after its onset."""
    if run.kind == "healthy":
        return [window for window in run.windows if window.state == 2]
    return [window for window in run.windows if window.end > onset(run.point) + window_time(run.point)]


def first_alarm(run):
    """Motor turns from the onset to the first WARN or ERROR, and its window; None: there was none."""
    for window in run.windows:
        if window.end > onset(run.point) and window.level > 0:
            return (window.end - onset(run.point)) * run.point.degrees / 360.0 * RATIO, window
    return None


def settled_cause(run):
    """The cause most windows with an alarm name."""
    named = collections.Counter(window.cause for window in judged(run) if window.level > 0)
    return named.most_common(1)[0][0] if named else "none"


def detection_table(faults, runs, threshold):
    lines = ["| kind | " + " | ".join(f"detected at {severity:g}" for severity in SEVERITIES)
             + " | smallest severity at 1 % false alarms | delay at 1 [motor turns] | cause right at 1 | strongest evidence at 1 |",
             "|---|" + "---|" * (len(SEVERITIES) + 4)]
    for kind in faults:
        own = [run for run in runs if run.kind == kind["kind"]]
        cells = []
        for severity in SEVERITIES:
            at = [run for run in own if run.severity == severity]
            cells.append(f"{sum(first_alarm(run) is not None for run in at)} of {len(at)}" if at else "no run")
        seen = [severity for severity in SEVERITIES
                if statistics.mean([max((window.score for window in judged(run)), default=0.0) > threshold
                                    for run in own if run.severity == severity] or [0.0]) > 0.5]
        full = [run for run in own if run.severity == SEVERITIES[-1]]
        alarms = [first_alarm(run) for run in full]
        delays = [alarm[0] for alarm in alarms if alarm]
        right = sum(settled_cause(run) == kind["kind"] for run in full)
        evidence = collections.Counter(re.split(" ", window.evidence)[0] for run in full for window in judged(run)
                                       if window.level > 0)
        lines.append(f"| `{kind['kind']}` | " + " | ".join(cells)
                     + f" | {min(seen) if seen else '> 1'} | {f'{statistics.median(delays):.0f}' if delays else 'none'} "
                     f"| {right} of {len(full)} | {evidence.most_common(1)[0][0] if evidence else 'none'} |")
    return lines


def sound_table(runs):
    lines = ["| operating point | hours | windows judged | beyond the threshold | alarms (WARN or ERROR begins) | 95 % bound of alarms in 1000 h |",
             "|---|---|---|---|---|---|"]
    for point in POINTS:
        own = [run for run in runs if run.point == point and run.kind == "healthy"]
        windows = [window for run in own for window in judged(run)]
        alarms = sum(after.level > before.level for run in own for before, after in zip(run.windows, run.windows[1:]))
        hours = len(windows) * window_time(point) / 3600.0
        bound = 0.5 * _chi2_quantile(2 * (alarms + 1))
        lines.append(f"| {point.name} | {hours:.2f} | {len(windows)} | {sum(window.score > 1.0 for window in windows)} "
                     f"| {alarms} | {1000.0 * bound / hours if hours else float('nan'):.0f} |")
    return lines


def _chi2_quantile(degrees):
    """0.95 quantile of chi square, Wilson and Hilferty: within 1 % from 2 degrees on."""
    return degrees * (1.0 - 2.0 / (9.0 * degrees) + 1.6449 * math.sqrt(2.0 / (9.0 * degrees))) ** 3


def draw_confusion(faults, runs, path):
    names = [kind["kind"] for kind in faults]
    causes = names + ["circular_spline_tooth", "none"]
    matrix = numpy.zeros((len(names), len(causes)))
    for run in runs:
        if run.kind in names and run.severity == SEVERITIES[-1]:
            cause = settled_cause(run)
            matrix[names.index(run.kind), causes.index(cause if cause in causes else "none")] += 1
    figure, axis = plt.subplots(figsize=(10, 7.4), constrained_layout=True)
    axis.imshow(matrix, cmap="Blues", vmin=0, vmax=len(POINTS))
    for (row, column), count in numpy.ndenumerate(matrix):
        if count:
            axis.text(column, row, f"{count:.0f}", ha="center", va="center",
                      color="white" if count > len(POINTS) / 2 else "black")
    axis.set_xticks(range(len(causes)), causes, rotation=60, ha="right")
    axis.set_yticks(range(len(names)), names)
    axis.set_xlabel("cause said")
    axis.set_ylabel("fault at severity 1")
    figure.savefig(path, dpi=110)
    plt.close(figure)


def scores(runs, chosen):
    return numpy.array([window.score for run in runs if chosen(run) for window in judged(run)])


def draw_roc(runs, sound, path):
    figure, axis = plt.subplots(figsize=(6.4, 5), constrained_layout=True)
    thresholds = numpy.unique(numpy.concatenate([sound, numpy.linspace(0.0, 5.0, 400)]))
    alarms = [(sound > threshold).mean() for threshold in thresholds]
    for severity in SEVERITIES:
        faulty = scores(runs, lambda run, s=severity: run.kind != "healthy" and run.severity == s)
        axis.step(alarms, [(faulty > threshold).mean() for threshold in thresholds], label=f"severity {severity:g}")
    axis.set_xscale("symlog", linthresh=1e-3)
    axis.set_xlim(0, 1)
    axis.set_ylim(0, 1)
    axis.set_xlabel("share of sound windows beyond the threshold")
    axis.set_ylabel("share of faulty windows beyond it")
    axis.grid(alpha=0.3)
    axis.legend(frameon=False, loc="lower right")
    figure.savefig(path, dpi=110)
    plt.close(figure)


def draw_signals(faults, runs, path):
    """For each kind the indicator that speaks loudest, window by window, over the onset."""
    figure, axes = plt.subplots(4, 4, figsize=(13, 10), constrained_layout=True, sharex=True)
    for kind, axis in zip(faults, axes.flat):
        full = [run for run in runs if run.kind == kind["kind"] and run.severity == SEVERITIES[-1] and run.windows]
        axis.set_title(kind["kind"], loc="left", fontsize=9)
        if not full:
            continue
        run = max(full, key=lambda run: max((window.score for window in judged(run)), default=0.0))
        loudest = max(judged(run) or run.windows, key=lambda window: window.score)
        name = (loudest.evidence.split(" ") + [""])[0] or "kinematic_error"
        if not hasattr(run.indicators[0], name):
            name = "kinematic_error"
        values = [getattr(message, name) for message in run.indicators]
        numbers = numpy.arange(1, len(values) + 1)
        axis.plot(numbers, values, "o-", markersize=3, color="C0" if loudest.level == 0 else "C3")
        axis.axvline(SOUND + 0.5, color="k", linewidth=0.8, linestyle=":")
        axis.text(0.02, 0.95, f"{name}\n{run.point.name}", transform=axis.transAxes, va="top", fontsize=7)
        axis.tick_params(labelsize=7)
        axis.margins(y=0.25)
    for axis in axes[-1]:
        axis.set_xlabel(f"window of {WINDOW_TURNS:.0f} motor turns", fontsize=8)
    figure.savefig(path, dpi=110)
    plt.close(figure)


def main():
    parser = argparse.ArgumentParser(prog="evaluate_health", description=__doc__)
    parser.add_argument("--tool", type=pathlib.Path, required=True, help=argparse.SUPPRESS)
    parser.add_argument("--docs", type=pathlib.Path, required=True, help="folder that holds health.md")
    parser.add_argument("--work", type=pathlib.Path, required=True, help="folder for plans and bags")
    parser.add_argument("--jobs", type=int, default=2, help="runs at a time [2]")
    parser.add_argument("--sound-runs", type=int, default=10, help="sound drives at each operating point [10]")
    parser.add_argument("--sound-windows", type=int, default=60, help="windows judged of each [60]")
    options = parser.parse_args()
    options.work.mkdir(parents=True, exist_ok=True)

    faults, runs = collect(options)
    sound = scores(runs, lambda run: run.kind == "healthy")
    threshold = float(numpy.quantile(sound, 1.0 - ALARM_SHARE))
    images = options.docs / "images" / "health"
    images.mkdir(parents=True, exist_ok=True)
    draw_signals(faults, runs, images / "signals.png")
    draw_confusion(faults, runs, images / "confusion.png")
    draw_roc(runs, sound, images / "roc.png")
    page_section.write(options.docs / "health.md", "health", [
        f"{len(runs)} runs; {len(sound)} sound windows judged. Score: strongest deviation over its threshold; 1 % of sound windows lie "
        f"beyond {threshold:.2f}.", "", "### Sound drives", "", *sound_table(runs), "", "### Faults", "",
        *detection_table(faults, runs, threshold), "",
        "![For each kind of fault the indicator that speaks loudest, before and after the onset](images/health/signals.png)", "",
        "![Fault against the cause said, at severity 1](images/health/confusion.png)", "",
        "![Share of faulty windows beyond a threshold against that of sound ones, by severity](images/health/roc.png)"])
    print(f"evaluate_health: wrote {options.docs / 'health.md'}", file=sys.stderr)


if __name__ == "__main__":
    main()
