# SPDX-License-Identifier: BSD-3-Clause
"""Fits the signatures of the causes to the model's own faults: how the indicators change with the severity, and how far
that is to be trusted on another gear. Written as data of the source and as a table."""
import collections
import itertools
import math
import re

import numpy

import page_section
from health_runs import CALIBRATED, FITTED, GREASE, split_table

SEVERITIES = [0.1, 0.16, 0.25, 0.4, 0.63, 1.0]    # of the rows, between those run in straight lines through 0
# Lines that stand alone by kinematics, whatever the motion; a damaged tooth of the circular spline is no kind of fault.
# Sizes at severity 1 are assumed [rad], [N.m]; of the torque one per cent of what the motor is rated at, since load and
# speed make it larger or smaller by more than tenfold.
KINEMATICS = {"bearing_inner_race": {"error_inner": 5e-6, "torque_inner": 1e-2},
              "bearing_outer_race": {"error_outer": 5e-6, "torque_outer": 1e-2},
              "bearing_ball": {"error_ball": 5e-6, "torque_ball": 1e-2},
              "bearing_cage": {"error_cage_lobes": 1e-5, "torque_cage_lobes": 1e-2},
              "circular_spline_tooth": {"error_circular_spline_2": 5e-5}}
ERRORS = [0.15, 0.2, 0.3, 0.45, 0.6]       # tried, of each number of a signature,
# of its length, no more: with 0.06 strong faults no longer have their own signature,
LENGTH_ERRORS = [0.01, 0.02, 0.03]
LINE_ERRORS = [0.05, 0.1, 0.2, 0.4, 0.8]   # and of the lines of a sound drive
NEIGHBOURS = ["wave_generator_2", "circular_spline_2"]
UNKNOWN_STRENGTHS = [3.0, 10.0, 30.0, 100.0]      # as in the source

Table = collections.namedtuple("Table", "causes motions severities changes")  # a row each


class Layout:
    """Names of the numbers of a signature, and the indicators they are made of."""

    def __init__(self, indicators):
        lines = [name for name in indicators if name.endswith("_cos")]
        self.locked = [name[:-4] for name in lines]
        self.names = [name for name in indicators if not name.endswith(("_cos", "_sin"))]

    def numbers(self, window, sound):
        """Change of a window; a line with a phase: length of its change. Not determined: 0."""
        def change(name):
            return (window[name] - sound[name]) if None not in (window[name], sound[name]) else 0.0
        return numpy.array([math.hypot(change(name + "_cos"), change(name + "_sin")) if name in self.locked
                            else change(name) for name in self.names])

    def terms(self, window):
        """(number, has a phase, half the square of the sound line's amplitude, residual) of each that was compared."""
        residual = window["residual"]
        for number, name in enumerate(self.names):
            parts = [name + "_cos", name + "_sin"] if name in self.locked else [name]
            parts = [part for part in parts if residual[part] is not None]
            # Orders 2 and 1.98 are told apart so little in a motion to and fro that they count as one.
            lines = [name.replace(one, other) for one in NEIGHBOURS for other in NEIGHBOURS if name.endswith(one)]
            sound = [window["indicators"][part] - residual[part][0]
                     for line in lines or [name] for part in (line + "_cos", line + "_sin")
                     if name in self.locked and residual[part] is not None]
            for part in parts:
                yield number, name in self.locked, 0.5 * sum(value ** 2 for value in sound), residual[part]


def windows_of(bench, bags):
    """Indicators of the runs, by bag."""
    report = bench.indicators([bag for bag, _ in bags])
    return {window["recording"]: window["indicators"] for window in report["windows"]}


def changes(bench):
    """(layout, sound values of the scalars in the check-up, changes by cause, motion and severity)."""
    found = collections.defaultdict(list)
    layout, values = None, None
    for motion, sound, faulty in bench.differences():
        windows = windows_of(bench, [*sound, *faulty])
        same = {row["set.input.temperature"]: windows[str(bag)] for bag, row in sound}
        layout = layout or Layout(next(iter(same.values())))
        if values is None:
            values = [numpy.mean([window[name] or 0.0 for window in same.values()]) for name in layout.names]
        for bag, row in faulty:
            if str(bag) in windows:
                found[row["class"], motion.tag, float(row["fault_severity"])].append(
                    layout.numbers(windows[str(bag)], same[row["set.input.temperature"]]))
    return layout, values, {key: numpy.mean(own, axis=0) for key, own in found.items()}


def table_of(layout, kinds, found):
    rows = []
    for kind in kinds:
        for motion in FITTED.motions:
            own = {severity: change for (cause, tag, severity), change in found.items()
                   if (cause, tag) == (kind["kind"], motion.tag)}
            if not own:
                continue
            known = [0.0, *sorted(own)]
            numbers = numpy.array([numpy.zeros(len(layout.names)), *(own[severity] for severity in known[1:])])
            for severity in SEVERITIES:
                rows.append((kind["kind"], motion.tag, severity,
                             [numpy.interp(severity, known, column) for column in numbers.T]))
    for cause, lines in KINEMATICS.items():
        for (line, size), severity in itertools.product(lines.items(), SEVERITIES):
            rows.append((cause, "kinematics", severity,
                         [severity * size if name == line else 0.0 for name in layout.names]))
    return Table([row[0] for row in rows], [row[1] for row in rows], numpy.array([row[2] for row in rows]),
                 numpy.array([row[3] for row in rows]))


def log_likelihoods(layout, window, table, error, length_error, line_error):
    """Of a sound drive, of every row of the table and of what is in none; the law is in fault_signatures.hpp."""
    number, phase, line, residual = zip(*layout.terms(window))
    number, phase, line = list(number), numpy.array(phase), numpy.array(line)
    difference, own, *common = numpy.array(residual).T
    common = numpy.array(common).T
    change = numpy.vstack([numpy.zeros((1, len(number))), table.changes[:, number],
                           numpy.zeros((len(UNKNOWN_STRENGTHS), len(number)))])
    severity = numpy.concatenate([[0.0], table.severities, numpy.zeros(len(UNKNOWN_STRENGTHS))])
    strength = numpy.sum(numpy.where(phase, 0.5, 1.0) * change ** 2 / own, axis=1) * length_error ** 2
    strength[-len(UNKNOWN_STRENGTHS):] = numpy.square(UNKNOWN_STRENGTHS)
    variance = own * (1.0 + strength[:, None]) + numpy.where(phase, 0.5, error ** 2) * change ** 2
    variance += (line_error * severity[:, None]) ** 2 * line
    left = difference - numpy.where(phase, 0.0, change)
    inner = numpy.eye(common.shape[1]) + numpy.einsum("ia,hi,ib->hab", common, 1.0 / variance, common)
    projected = (left / variance) @ common
    square = numpy.sum(left ** 2 / variance, axis=1)
    square -= numpy.einsum("ha,ha->h", projected, numpy.linalg.solve(inner, projected[..., None])[..., 0])
    logarithm = numpy.sum(numpy.log(variance / own), axis=1) + numpy.linalg.slogdet(inner)[1]
    freedom = window["freedom"]
    return -0.5 * (logarithm + (freedom + len(number)) * numpy.log1p(numpy.maximum(square, 0.0) / freedom))


def posterior(layout, window, table, *errors):
    """(probability by cause, log odds against a sound drive)."""
    found = log_likelihoods(layout, window, table, *errors)
    sound, rows, unknown = found[0], found[1:-len(UNKNOWN_STRENGTHS)], found[-len(UNKNOWN_STRENGTHS):]
    largest = found.max()
    means = {cause: numpy.mean(numpy.exp(rows[[own == cause for own in table.causes]] - largest))
             for cause in dict.fromkeys(table.causes)}
    odds = math.log(max(sum(means.values()) / len(means), 1e-300)) + largest - sound
    means["none"] = numpy.mean(numpy.exp(unknown - largest))
    total = sum(means.values())
    return {cause: mean / total for cause, mean in means.items()}, odds


def calibration_windows(bench):
    """(kind, severity, window as the tool reports it) of faulty and sound runs of other gears."""
    drawn = f"{{uniform: [{GREASE[0]}, {GREASE[1]}]}}"
    found = []
    for trial in CALIBRATED:
        for motion in trial.motions:
            bags = bench.faulty(trial, motion, drawn)
            bags += bench.sound("sound_calibrated", trial.gear, motion, drawn, 20, 4)
            report = bench.indicators([bag for bag, _ in bags], ["--baseline", bench.reference(trial.gear, motion)])
            rows = {str(bag): row for bag, row in bags}
            found += [(rows[window["recording"]]["class"], float(rows[window["recording"]]["fault_severity"] or 0.0),
                       window) for window in report["windows"] if window["assessment"]["state"] == "assessed"]
    return found


def is_alarm(window, odds):
    return window["assessment"]["largest_score"] > 1.0 or odds > math.log(1000.0)


def trust(layout, windows, table):
    """(error, length error, line error) with the largest mean log probability of the cause, over the windows that
    raise an alarm."""
    best = None
    for errors in itertools.product(ERRORS, LENGTH_ERRORS, LINE_ERRORS):
        found = [(kind, window, *posterior(layout, window, table, *errors)) for kind, _, window in windows]
        alarms = [(kind, probability) for kind, window, probability, odds in found
                  if kind != "healthy" and is_alarm(window, odds)]
        score = numpy.mean([math.log(max(probability[kind], 1e-3)) for kind, probability in alarms])
        right = sum(max(probability, key=probability.get) == kind for kind, probability in alarms)
        print(f"evaluate_health: errors {errors}: mean log probability {score:.3f} of {len(alarms)} alarms, {right} "
              f"right; log odds of sound windows up to "
              f"{max(odds for kind, _, _, odds in found if kind == 'healthy'):.1f}")
        if best is None or score > best[0]:
            best = score, errors
    return best[1]


def severity_error(layout, windows, table, errors):
    """Of the estimate, as a share of it, rms over the alarms with the right cause."""
    shares = []
    for kind, severity, window in windows:
        if kind == "healthy":
            continue
        probability, odds = posterior(layout, window, table, *errors)
        if is_alarm(window, odds) and max(probability, key=probability.get) == kind:
            own = [cause == kind for cause in table.causes]
            found = log_likelihoods(layout, window, table, *errors)[1:-len(UNKNOWN_STRENGTHS)][own]
            weights = numpy.exp(found - found.max())
            shares.append(1.0 - severity / numpy.average(table.severities[own], weights=weights))
    return math.sqrt(numpy.mean(numpy.square(shares)))


def cause_name(cause):
    """As the source has it."""
    if cause == "circular_spline_tooth":
        return "Cause::CIRCULAR_SPLINE_TOOTH"
    return f"causeOf(FaultKind::{cause.upper()})"


def numbers_text(numbers):
    return ", ".join(f"{number:.3g}" for number in numbers)


def write(bench, source, page):
    layout, sound, found = changes(bench)
    table = table_of(layout, bench.kinds, found)
    windows = calibration_windows(bench)
    errors = trust(layout, windows, table)
    of_severity = severity_error(layout, windows, table, errors)
    scalars = [name for name in layout.names if not name.startswith(("error_", "torque_", "ripple_"))]
    lines = ["// SPDX-License-Identifier: BSD-3-Clause", "// Written by `scripts/evaluate_health --fit`.",
             "#pragma once", "", '#include "harmonic_joint_twin/health/fault_signatures.hpp"', "", "namespace hjt", "{",
             "// clang-format off",
             "/// Of each number of a signature, and of its length, on another gear in another motion [-].",
             f"inline constexpr double SIGNATURE_ERROR = {errors[0]};",
             f"inline constexpr double SIGNATURE_LENGTH_ERROR = {errors[1]};",
             "/// Share of the lines of a sound drive that a fault of severity 1 changes [-].",
             f"inline constexpr double LINE_ERROR = {errors[2]};",
             "/// Of the severity by them, as a share of it [-].",
             f"inline constexpr double SEVERITY_ERROR = {of_severity:.2f};", "",
             "/// Of the sound gear in the check-up.",
             "inline constexpr std::array<double, SCALAR_COUNT> SOUND_VALUES{ "
             f"{numbers_text(sound[:len(scalars)])} }};", "",
             "inline constexpr Signature FITTED_SIGNATURES[] = {"]
    lines += [f"{{ {cause_name(cause)}, {severity}, {{ {numbers_text(change)} }} }},  // {motion}"
              for cause, motion, severity, change in zip(*table)]
    source.write_text("\n".join([*lines, "};", "// clang-format on", "}  // namespace hjt"]) + "\n")
    write_table(layout, table, page)


def read(source):
    """(table, errors) of what `write` wrote."""
    text = source.read_text(encoding="utf-8")
    values = dict(re.findall(r"double (\w+) = ([^;]+);", text))
    rows = re.findall(r"\{ (?:Cause::|causeOf\(FaultKind::)(\w+)\)?, (\S+), \{ (.*) \} \},  // (\w+)", text)
    causes, severities, changes, motions = zip(*rows)
    table = Table([cause.lower() for cause in causes], motions, numpy.array(severities, float),
                  numpy.array([row.split(", ") for row in changes], float))
    return table, [float(values[name]) for name in ("SIGNATURE_ERROR", "SIGNATURE_LENGTH_ERROR", "LINE_ERROR")]


def write_table(layout, table, page):
    """Severity 0.4, in the check-up: the numbers in which the kinds differ most."""
    shown = [("torsional_stiffness", 1e-3, "K1 [kN·m/rad]"), ("second_stiffness", 1e-3, "K2 [kN·m/rad]"),
             ("lost_motion", 206265.0, "lost motion [″]"),
             ("hysteresis_area", 1e3, "loop [mJ]"), ("running_torque", 1e3, "running torque [mN·m]"),
             ("viscous_friction", 1e6, "viscous [µN·m·s/rad]"), ("kinematic_error", 206265.0, "kinematic error [″]"),
             ("error_wave_generator_1", 206265.0, "order 1 [″]"), ("error_wave_generator_2", 206265.0, "order 2 [″]"),
             ("error_circular_spline_2", 206265.0, "circular spline [″]"), ("error_cage_lobes", 206265.0, "cage [″]"),
             ("error_outer", 206265.0, "outer [″]"), ("error_inner", 206265.0, "inner [″]")]
    lines = split_table(("signatures fitted to", [FITTED]), ("their errors fitted to", CALIBRATED))
    lines += ["", "| cause | " + " | ".join(text for _, _, text in shown) + " |", "|---|" + "---|" * len(shown)]
    for cause, motion, severity, change in zip(*table):
        if motion == FITTED.motions[0].tag and severity == 0.4:
            by_name = dict(zip(layout.names, change))
            lines.append(f"| `{cause}` | " + " | ".join(f"{scale * by_name[name]:.2g}" for name, scale, _ in shown)
                         + " |")
    page_section.write(page, "signatures", lines)
