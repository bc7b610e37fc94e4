# SPDX-License-Identifier: BSD-3-Clause
"""The best that any detector can do: detectability and Cramer-Rao bound of each fault's severity from the twin's own
sensitivities, by motion and sensors, nuisances projected out.

    y = y0 + s S + N b + w,   w ~ N(0, R),   b unknown, or ~ N(0, B)

y: readings of a motion, S: change of a fault of unit severity, N: changes of the nuisances. What is left of S in the
whitened readings after N is projected out has the length 1/sigma(s): the bound of the severity's standard deviation is
the inverse of that length, and d' = length x severity. A detector at 1 % false alarms finds half of the drives at
d' = 2.33 and 90 % at 3.6; one that does not know the severity's place needs more."""
import argparse
import collections
import json
import math
import pathlib
import subprocess

import numpy
import scipy.ndimage

import lab
from detection_runs import JOINT, RATE, RATIO, Bench, fault_class

SLOWEST = math.radians(3.0)                  # of the joint: slower readings are left out [rad/s]
JOINT_TORQUE_NOISE = 0.1                     # of a strain gauge at the joint, assumed [N.m]
EDGE = 40                                    # readings left out at either end of a stroke
READ = ["motor_angle_encoder", "output_angle_encoder", "motor_torque_reading"]
SENSORS = ["motor encoder, current", "+ output encoder", "+ torque sensor"]
CHANNELS = [("ripple", "motor_torque"), ("ripple", "motor_torque", "torsion"),
            ("ripple", "motor_torque", "torsion", "joint_torque")]

SEVERITY = 0.2
STEP = 0.1                                   # of the severity, to either side
TEMPERATURES = [15.0, 25.0, 35.0]            # [degC]; the middle one is that of the sensitivities
GEARS = 4                                    # of other manufacture
TOOTH = 40

MOTIONS = ["check_up", "work"]
SLOW_SWEEP = ["bearing_inner_race", "bearing_outer_race", "bearing_ball", "bearing_cage"]  # on the full ring
WHOLE = -1
CONDITION = ["  solver.scene: auto", "  input.temperature: 25.0"]
EXACT = ["  sensors.motor_counts_per_turn: 1000000000", "  sensors.output_counts_per_turn: 1000000000"]
LOADS = ["  output.gravity_torque: {grid: [53.4, 56.07]}", "  output.load_inertia: {grid: [3.30, 3.465]}"]
SEEDS = ["  manufacture.flexspline_pitch_seed: {integer: [100, 9999]}",
         "  manufacture.circular_spline_pitch_seed: {integer: [100, 9999]}"]
CHECKED = ("pitting", 0.2)                   # fault and severity of the check by brute force
CHECK_SEEDS = 40
NOISE_SEEDS = 40                             # runs that the noise's spectra are of


class Noise:
    """Spectra of the readings' noise by channel and speed, from sound runs less the exact one: the drive's control
    moves the motor by the noise of its encoder."""

    EDGES = numpy.geomspace(1.0, 0.5 * RATE, 40)  # of the bands [Hz]

    def __init__(self, exact, runs, day):
        readings = Readings(exact, None)
        columns = drifts(Readings(sound_day(day), None, readings.strokes), day)
        parts = [readings.residuals(run) for run in runs]
        self.levels = {}
        for channel in parts[0]:
            same = Projector([column[channel] for column in columns if channel in column])
            sums = collections.defaultdict(lambda: numpy.zeros((2, len(self.EDGES) + 1)))
            for part in parts:
                for (speed, own) in readings.split(same(part[channel])):
                    power = numpy.abs(numpy.fft.rfft(own)) ** 2 / len(own)
                    band = self.bands(own)
                    sums[speed] += [numpy.bincount(band, power, len(self.EDGES) + 1),
                                    numpy.bincount(band, minlength=len(self.EDGES) + 1)]
            # Where the high pass has taken signal and noise alike, nothing is gained: the mean level at least.
            self.levels[channel] = {speed: numpy.maximum(power / numpy.maximum(count, 1), power.sum() / count.sum())
                                    for speed, (power, count) in sums.items()}
        self.levels["joint_torque"] = {speed: numpy.full(len(self.EDGES) + 1, JOINT_TORQUE_NOISE ** 2)
                                       for speed in self.levels["torsion"]}

    def bands(self, values):
        return numpy.digitize(numpy.fft.rfftfreq(len(values), 1.0 / RATE), self.EDGES)

    def whiten(self, channel, speed, values):
        levels = self.levels[channel]
        level = levels[min(levels, key=lambda known: abs(known - speed))][self.bands(values)]
        return numpy.fft.irfft(numpy.fft.rfft(values) / numpy.sqrt(level), len(values))


def strokes_of(base):
    """Readings between two reversals, of one direction each."""
    speed = scipy.ndimage.gaussian_filter1d(numpy.gradient(base.motor, base.time), RATE * 0.005) / RATIO
    moving = numpy.sign(speed) * (numpy.abs(speed) > SLOWEST)
    edges = numpy.flatnonzero(numpy.diff(moving)) + 1
    return [slice(first + EDGE, last - EDGE) for first, last in zip([0, *edges], [*edges, len(moving)])
            if moving[first] != 0 and last - first > 4 * EDGE]


class Readings:
    """Residuals of a run against the sound one, reading by reading: torsion and torques at the motor angle of the
    sample, so that the drive's own way along the motion is none of them; the motor's ripple by time, above 3 Hz."""

    def __init__(self, base, noise, strokes=None):
        self.base = base
        self.noise = noise
        self.strokes = strokes or strokes_of(base)
        self.size = sum(stroke.stop - stroke.start for stroke in self.strokes)

    def split(self, gathered):
        """(speed of the joint at the middle [deg/s, in steps of ten], values) of each stroke."""
        ends = numpy.cumsum([stroke.stop - stroke.start for stroke in self.strokes])
        for stroke, own in zip(self.strokes, numpy.split(gathered, ends[:-1])):
            middle = (stroke.start + stroke.stop) // 2
            speed = (self.base.motor[middle + 1] - self.base.motor[middle - 1]) * 0.5 * RATE / RATIO
            yield 10.0 * round(abs(math.degrees(speed)) / 10.0), own

    def gather(self, values):
        return numpy.concatenate([values[stroke] for stroke in self.strokes])

    def residuals(self, run):
        """By channel."""
        base = self.base
        found = {"ripple": self.gather(high_pass(run.motor - base.motor))}
        for channel in ("motor_torque", "torsion", "joint_torque"):
            own, sound = getattr(run, channel), getattr(base, channel)
            if own is None:
                continue
            parts = []
            for stroke in self.strokes:
                wide = slice(stroke.start - EDGE, stroke.stop + EDGE)
                order = 1 if base.motor[stroke.stop] > base.motor[stroke.start] else -1
                expected = numpy.interp(run.motor[stroke], base.motor[wide][::order], sound[wide][::order])
                parts.append(own[stroke] - expected)
            found[channel] = numpy.concatenate(parts)
        found["torsion"] -= found["ripple"] / RATIO  # left: the output encoder's own noise
        return found

    def whitened(self, residuals, channels):
        return numpy.concatenate([
            numpy.concatenate([self.noise.whiten(channel, speed, own) for speed, own in self.split(residuals[channel])])
            if channel in residuals else numpy.zeros(self.size) for channel in channels])


def high_pass(values):
    return values - scipy.ndimage.gaussian_filter1d(values, RATE * 0.05, mode="nearest")


class Projector:
    """Takes the span of the nuisances out of whitened readings."""

    def __init__(self, nuisances):
        columns = numpy.array([column / numpy.linalg.norm(column) for column in nuisances if column.any()])
        left, sizes, _ = numpy.linalg.svd(columns.T, full_matrices=False)
        self.basis = left[:, sizes > 1e-6 * sizes[0]]

    def __call__(self, values):
        return values - self.basis @ (self.basis.T @ values)


def sound_day(day):
    """The run of the nuisances in which there is none."""
    return next(run for row, run in day if key_of(row) == (25.0, 53.4, 3.30, 0.0))


def drifts(readings, nuisance_runs):
    """What differs from one day to another on one drive: temperature, load, payload, gain and zeros."""
    runs = {key_of(row): run for row, run in nuisance_runs}
    found = [runs[key] for key in ((15.0, 53.4, 3.30, 0.0), (35.0, 53.4, 3.30, 0.0), (25.0, 56.07, 3.30, 0.0),
                                   (25.0, 53.4, 3.465, 0.0), (25.0, 53.4, 3.30, 1.0))]
    columns = [readings.residuals(run) for run in found]
    ones = numpy.ones(readings.size)
    for channel in ("motor_torque", "joint_torque"):
        columns += [{channel: readings.gather(getattr(readings.base, channel))}, {channel: ones}]
    return [*columns, {"torsion": ones}]


def key_of(row):
    """Temperature, weight, inertia and load of a run."""
    load = next(value for key, value in row.items() if key.endswith("load.constant") and value)
    return tuple(float(row[f"set.{key}"]) for key in ("input.temperature", "output.gravity_torque",
                                                      "output.load_inertia")) + (float(load),)


def unknown_drive(readings, gears):
    """What differs from one sound drive to another: pitch errors, lines of encoders and motor."""
    base = readings.base
    motor, output = readings.gather(base.motor), readings.gather(base.output)
    load = readings.gather(base.joint_torque) / 50.0
    columns = [readings.residuals(run) for run in gears]
    for channel in ("torsion", "motor_torque"):
        for angle in (motor, 2.0 * motor, 4.0 * motor, 2.0 * (motor - output), 4.0 * (motor - output), output,
                      2.0 * output):
            for part in (numpy.cos(angle), numpy.sin(angle)):
                columns += [{channel: part}, {channel: part * load}]
    return columns


def kinds_of(tool):
    listed = subprocess.run([tool, "faults", "--json"], check=True, capture_output=True, text=True).stdout
    return [kind["kind"] for kind in json.loads(listed)]


def place_of(kind):
    if kind.startswith("bearing_"):
        return 5
    return TOOTH if kind in ("tooth_root_crack", "tooth_tip_crack", "pitting", "flexspline_crack") else WHOLE


# Of one kind in one motion, by sensors: detectability at SEVERITY against the drive's own reference and without one,
# bound of the severity's standard deviation, the weakest severity with d' = FOUND, what is left by the projection.
Bound = collections.namedtuple("Bound", "kind motion sensors detectability stranger deviation weakest left direction")
FOUND = 3.6


def bounds(bench, kinds, nuisances, noise):
    healthy = ["  healthy: []"]
    fast = [kind for kind in kinds if kind not in SLOW_SWEEP]
    faults = bench.sweep("faults", CONDITION + EXACT, healthy + [
        line for kind in fast
        for line in fault_class(kind, f"{{grid: [{SEVERITY - STEP:.1f}, {SEVERITY}, {SEVERITY + STEP:.1f}]}}",
                                place_of(kind))], MOTIONS, [JOINT])
    bearing = bench.sweep("bearing", ["  solver.scene: full_ring", "  input.temperature: 25.0", *EXACT], healthy + [
        line for kind in SLOW_SWEEP for line in fault_class(kind, SEVERITY, place_of(kind))], ["check_up"], [JOINT])
    gears = bench.sweep("gears", CONDITION + EXACT + SEEDS, healthy, MOTIONS, [JOINT, "as_built.yaml"], GEARS)
    found = []
    for motion in MOTIONS:
        own = by_fault(faults, motion)
        readings = Readings(own["healthy", ""], noise)
        drift = drifts(readings, [(row, run) for row, run in nuisances if row["duty"] == motion])
        stranger = unknown_drive(readings, [run for row, run in gears if row["duty"] == motion])
        groups = [(readings, own)]
        if motion == "check_up":
            own = by_fault(bearing, motion)
            groups.append((Readings(own["healthy", ""], noise, readings.strokes), own))
        for sensors, channels in zip(SENSORS, CHANNELS):
            same = Projector([readings.whitened(column, channels) for column in drift])
            other = Projector([readings.whitened(column, channels) for column in [*drift, *stranger]])
            for own_readings, runs in groups:
                found += [bound_of(kind, motion, sensors, own_readings, runs, channels, same, other)
                          for kind in kinds if (kind, f"{SEVERITY}") in runs]
    return found


def by_fault(rows, motion):
    return {(row["class"], row["fault_severity"]): run for row, run in rows if row["duty"] == motion}


def bound_of(kind, motion, sensors, readings, runs, channels, same, other):
    def change(severity):
        return readings.whitened(readings.residuals(runs[kind, f"{severity:.1f}"]), channels)

    own = change(SEVERITY)
    left = same(own)
    seen = numpy.linalg.norm(left)
    slope, power = left / SEVERITY, 1.0
    if (kind, f"{SEVERITY + STEP:.1f}") in runs:
        low, high = same(change(SEVERITY - STEP)), same(change(SEVERITY + STEP))
        slope = (high - low) / (2.0 * STEP)
        growth = numpy.linalg.norm(high) / numpy.linalg.norm(low)
        power = math.log(growth) / math.log((SEVERITY + STEP) / (SEVERITY - STEP))
    return Bound(kind, motion, sensors, seen, numpy.linalg.norm(other(own)), 1.0 / numpy.linalg.norm(slope),
                 SEVERITY * (FOUND / seen) ** (1.0 / power), seen / numpy.linalg.norm(own),
                 (left / seen).astype(numpy.float32))


def number(value):
    return f"{value:.2g}" if value < 100.0 else f"{value:.0f}"


def weakest(severity):
    """Outside of what was run: the bound only."""
    least = SEVERITY - STEP
    return f"< {least:.1f}" if severity < least else "> 1" if severity > 1.0 else number(severity)


def table(kinds, found):
    """Bound by kind: d' with each set of sensors in each motion, then what follows in the check-up."""
    lines = ["| kind | " + " | ".join(f"d′, {name}" for name in SENSORS)
             + " | d′, both encoders, no reference of the drive | d′, both encoders, at work "
             "| σ(s), both encoders | weakest s, both encoders |", "|---|" + "---|" * (len(SENSORS) + 4)]
    for kind in kinds:
        own = {(bound.motion, bound.sensors): bound for bound in found if bound.kind == kind}
        best = own.get(("check_up", SENSORS[1]))
        if best is None:
            continue
        work = own.get(("work", SENSORS[1]))
        cells = [number(own["check_up", name].detectability) for name in SENSORS]
        lines.append(f"| `{kind}` | " + " | ".join(cells) + f" | {number(best.stranger)} "
                     f"| {number(work.detectability) if work else '-'} | {number(best.deviation)} "
                     f"| {weakest(best.weakest)} |")
    return lines


def alike(kinds, found, sensors=SENSORS[1], least=0.9):
    """Pairs of kinds whose changes are nearly parallel once the nuisances are out."""
    own = [bound for kind in kinds for bound in found
           if (bound.kind, bound.motion, bound.sensors) == (kind, "check_up", sensors)]
    return [(one.kind, other.kind, float(one.direction @ other.direction))
            for i, one in enumerate(own) for other in own[i + 1:]
            if abs(one.direction @ other.direction) > least]


def nuisance_runs(bench):
    return bench.sweep("nuisance", ["  solver.scene: auto", "  input.temperature: {grid: [15.0, 25.0, 35.0]}", *EXACT,
                                    *LOADS], ["  healthy: []"], MOTIONS, [JOINT], loads="{grid: [0.0, 1.0]}")


# Each run has its own temperature and load, by which the motor's way differs by a count or two: else the counts would
# fall alike in all runs.
LITTLE = ["  solver.scene: auto", "  input.temperature: {uniform: [24.8, 25.2]}"]
LITTLE_LOAD = "{uniform: [-0.1, 0.1]}"


# Counts as white noise of the same size: a count over the root of 12, beside the sensors' own.
WHITE = [*EXACT, "  sensors.motor_noise: 4.229e-4", "  sensors.output_noise: 1.249e-5",
         "  sensors.torque_resolution: 0.0"]


def measured_noise(bench, day):
    """Runs with the sensors' lasting errors alone, and the noise of others beside them."""
    kind, severity = CHECKED
    classes = ["  healthy: []", *fault_class(kind, severity, place_of(kind))]
    overlays = [JOINT, "real_sensors.yaml"]
    quiet = [f"  sensors.{name}: 0.0" for name in ("motor_noise", "output_noise", "torque_noise", "torque_resolution")]
    exact = {row["class"]: run for row, run in
             bench.sweep("check_exact", CONDITION + EXACT + quiet, classes, ["check_up"], overlays, columns=READ)}
    runs = bench.sweep("noise", LITTLE + WHITE, ["  healthy: []"], ["check_up"], overlays, NOISE_SEEDS, LITTLE_LOAD,
                       READ, seed=2)
    return exact, Noise(exact["healthy"], [run for _, run in runs], day)


def check(bench, day, exact, noise, name, settings):
    """Matched filter on noisy readings: (predicted d', measured d', scores of sound, of faulty runs)."""
    kind, severity = CHECKED
    noisy = bench.sweep(name, LITTLE + settings, ["  healthy: []", *fault_class(kind, severity, place_of(kind))],
                        ["check_up"], [JOINT, "real_sensors.yaml"], CHECK_SEEDS, LITTLE_LOAD, READ)
    readings = Readings(exact["healthy"], noise)
    sound = Readings(sound_day(day), noise, readings.strokes)
    project = Projector([readings.whitened(column, CHANNELS[1]) for column in drifts(sound, day)])
    matched = project(readings.whitened(readings.residuals(exact[kind]), CHANNELS[1]))
    seen = numpy.linalg.norm(matched)
    values = collections.defaultdict(list)
    for row, run in noisy:
        values[row["class"]].append(readings.whitened(readings.residuals(run), CHANNELS[1]) @ matched / seen)
    sound, faulty = numpy.array(values["healthy"]), numpy.array(values[kind])
    spread = math.sqrt(0.5 * (sound.var(ddof=1) + faulty.var(ddof=1)))
    return seen, (faulty.mean() - sound.mean()) / spread, sound, faulty


def main():
    parser = argparse.ArgumentParser(prog="detection_bound", description=__doc__)
    parser.add_argument("--tool", type=pathlib.Path, required=True, help="joint_twin")
    parser.add_argument("--work", type=pathlib.Path, required=True, help="folder for plans and runs")
    parser.add_argument("--docs", type=pathlib.Path, help="folder that holds health.md; else to the terminal")
    parser.add_argument("--jobs", type=int, default=2, help="runs at a time [2]")
    options = parser.parse_args()
    bench = Bench(options.tool, options.work.resolve(), options.jobs)
    kinds = kinds_of(options.tool)
    nuisances = nuisance_runs(bench)
    day = [(row, run) for row, run in nuisances if row["duty"] == "check_up"]
    exact, noise = measured_noise(bench, day)
    found = bounds(bench, kinds, nuisances, noise)
    pairs = "; ".join(f"`{one}` and `{other}`, with a cosine of {cosine:.2f} between their changes"
                      for one, other, cosine in alike(kinds, found))
    lines = [*table(kinds, found), "",
             f"These faults change the signals nearly alike: {pairs or 'none'}.", "",
             f"{CHECK_SEEDS} sound and {CHECK_SEEDS} faulty runs with noise check the bound for `{CHECKED[0]}` of "
             f"severity {CHECKED[1]}:",
             "", "| resolution of the encoders | d′ predicted | d′ of the matched filter | found at 5 % false alarms "
             "| found at 5 % false alarms, predicted |",
             "|---|---|---|---|---|"]
    for name, what, settings in (("check_white", "as white noise", WHITE), ("check_counts", "counts", [])):
        predicted, measured, sound, faulty = check(bench, day, exact, noise, name, settings)
        share = 0.5 * math.erfc((1.645 - predicted) / math.sqrt(2.0))
        error = math.sqrt((2.0 + 0.25 * measured ** 2) / CHECK_SEEDS)
        lines.append(f"| {what} | {predicted:.2f} | {measured:.2f} ± {error:.2f} "
                     f"| {100.0 * (faulty > numpy.quantile(sound, 0.95)).mean():.0f} % | {100.0 * share:.0f} % |")
    lab.write_or_print(options.docs, "health.md", "bound", lines)


if __name__ == "__main__":
    main()
