# SPDX-License-Identifier: BSD-3-Clause
"""Errors of manufacture: what the output's error over a joint turn says of the part that makes it."""
import csv
import math

import numpy as np

from bounds import AtLeast, AtMost, Between, Within
from evidence import IDENTITY, SELF_CONSISTENT, fitted

ARCSEC = math.pi / 180.0 / 3600.0  # [rad]
JOINT_TURN = 101  # motor turns
# The tooth pass, 200 a motor turn, folds to multiples of 10 orders; with fewer samples its sidebands would reach order
# 4.
STEPS_PER_MOTOR_TURN = 90
# Lines a joint turn of what is met twice a turn of the motor against the housing, and against the output.
FLEXSPLINE, CIRCULAR_SPLINE = 202, 200
LOAD = 5.0  # [N.m], holds the teeth on one flank
GOLDEN = ("--config", "golden.yaml")

LEAD = """
The *kinematic error* is the output's angle less the motor's over the ratio. Taken over one whole turn of the joint, 101
of the motor, its lines identify the part with the error. The two lobes load the teeth under them: errors fixed to the
**flexspline** stand still and are met twice a motor turn, **202** lines a joint turn; those fixed to the **circular
spline** move on with the output and are met **200** times. None of these lines is imposed. Pitch errors shift single
teeth and spaces, errors of centre and roundness shift spaces or the ellipse, and the contacts determine the output's
equilibrium.

Pitch errors here are seeded: a spectrum of amplitudes 1/k with the phases of a random generator, scaled to a stated
total cumulative pitch deviation *Fp* (ISO 1328-1). `config/as_built.yaml` has figures for a good gear.

What follows from an error in theory takes teeth one by one on a rigid wave generator: those rows are of straight flanks
on springs (`config/golden.yaml`). The gear as built is the shipped one, where three times as many teeth carry and
average.
"""

UR5 = """
**A UR5's line at 200.1 ± 0.3.** The line in the current of the recorded joints sits at 200.1 ± 0.3 a joint turn.
The flexspline's 202 is six times that uncertainty away, so the errors of those joints are fixed to the circular spline
or to parts that turn with it: its pitch errors, its roundness, its bearing. The gear as built has the larger errors
there for that reason. The log holds a motor current and no angle, so it gives the order of the line and not its
amplitude in seconds of arc. Amplitudes come from other drives with both encoders, whose readings do not separate 200
from 202.
"""

ECCENTRIC = """
**Effect of an eccentricity.** Errors of the wave generator alone make no line below the tooth pass: one tooth pitch on,
the gear is the same again, turned and renumbered. A circular spline off centre moves the teeth of one lobe ahead and
those of the other back. Their mean does not move, and a line at 200 appears only with the square of the eccentricity,
as long as both lobes carry. A second error that loads the lobes unequally changes that: the output follows the lobe
that carries more, and *odd* orders appear. The twin holds the wave generator on the motor's axis. The Oldham coupling
of a real one lets it centre itself, so an eccentricity here is the remainder after the coupling.
"""


class Turn:
    """The kinematic error over one joint turn."""

    def __init__(self, page, *options, load=LOAD, per_motor_turn=STEPS_PER_MOTOR_TURN, gear=GOLDEN):
        steps = JOINT_TURN * per_motor_turn
        options = (*gear, *options)
        rows = page.tool("turn", "--load", load, "--angle-range", repr(2.0 * math.pi * JOINT_TURN), "--steps", steps,
                         *options)["rows"]
        self.per_motor_turn = per_motor_turn
        self.error = np.array([row["kinematic_error"] for row in rows]) / ARCSEC
        self.torque = np.array([row["wave_generator_torque"] for row in rows[:-1]])
        # One turn of the joint is a whole period: the lines are at whole numbers and do not leak.
        self.lines = 2.0 * np.abs(np.fft.rfft(self.error[:-1])) / steps
        self.lines[0] = 0.0

    def line(self, number):
        """Amplitude at so many lines a joint turn [arcsec]."""
        return self.lines[number]

    @property
    def range(self):
        return self.error.max() - self.error.min()

    @property
    def angle(self):
        """Of the joint, in turns."""
        return np.linspace(0.0, 1.0, len(self.error))

    def low_lines(self):
        """All lines but those that the tooth pass, 200 a motor turn, folds to at this sampling."""
        folded = math.gcd(200, self.per_motor_turn) * JOINT_TURN
        return np.where(np.arange(len(self.lines)) % folded == 0, 0.0, self.lines)

    def band(self, numbers):
        """The error with only these lines left [arcsec], and its envelope."""
        spectrum = np.fft.fft(self.error[:-1])
        analytic = np.zeros_like(spectrum)
        analytic[numbers] = 2.0 * spectrum[numbers]
        signal = np.fft.ifft(analytic)
        return signal.real, np.abs(signal)


def setting(key, value):
    return "--set", f"manufacture.{key}={value}"


def pitch(member, deviation, seed=None):
    options = setting(f"{member}_pitch_deviation", f"{deviation:.7f}")
    return options if seed is None else options + setting(f"{member}_pitch_seed", seed)


def vector(key, along, across):
    return setting(key, f"[{along:.8f}, {across:.8f}]")


def harmonic(values, k):
    """Amplitude of the k-th order of the deviations over one turn of their member."""
    return 2.0 * abs(np.fft.fft(values)[k]) / len(values)


def radius(page):
    """Of the teeth's mid-height at the major axis [m]."""
    gear = page.tool("parameters")["gear"]
    return (gear["flexspline_inner_radius"] + gear["rim_thickness"] + 0.5 * gear["tooth_height_flexspline"] +
            gear["wave_amplitude"])


def build(page):
    page.text(LEAD)
    pitch_errors(page)
    as_built(page)
    if not page.fast:
        sampling(page)
        eccentricities(page)
        tables(page)


def pitch_errors(page):
    page.heading("Whose teeth")
    only_flexspline = pitch("flexspline", 8e-6)
    only_spline = pitch("circular_spline", 8e-6)
    flexspline, spline = Turn(page, *only_flexspline), Turn(page, *only_spline)
    both = Turn(page, *only_flexspline, *only_spline)
    mean_radius = radius(page)
    for name, title, turn, own, other, options in [
            ("flexspline", "flexspline", flexspline, FLEXSPLINE, CIRCULAR_SPLINE, only_flexspline),
            ("circular_spline", "circular spline", spline, CIRCULAR_SPLINE, FLEXSPLINE, only_spline)]:
        deviations = page.tool("manufacture", *options)[name]["pitch_deviation"]
        for order in (2, 4):
            expected = harmonic(deviations, order) / mean_radius / ARCSEC
            page.check(f"manufacture.{name}_order_{order}",
                       f"Fp 8 µm on the {title} alone: line at {own * order // 2} a joint turn",
                       f"order {order} of its deviations, as an angle at the teeth", Within(expected, relative=0.05),
                       turn.line(own * order // 2), "″",
                       "a lobe averages over some ten teeth, and carries them unequally", evidence=SELF_CONSISTENT)
        page.check(f"manufacture.{name}_not_the_other", f"the same: line at {other}", "none",
                   AtMost(1e-3), turn.line(other), "″", "rounding of the equilibrium", evidence=IDENTITY)
    for number, alone in ((FLEXSPLINE, flexspline), (CIRCULAR_SPLINE, spline)):
        page.check(f"manufacture.both_line_{number}", f"Fp 8 µm on both: line at {number}", "that of the one alone",
                   Within(alone.line(number), relative=0.05), both.line(number), "″",
                   "errors add but for contacts that open and close", evidence=SELF_CONSISTENT)
    _, envelope = both.band([CIRCULAR_SPLINE, CIRCULAR_SPLINE + 1, FLEXSPLINE])
    largest = both.line(FLEXSPLINE) + both.line(CIRCULAR_SPLINE)
    smallest = abs(both.line(FLEXSPLINE) - both.line(CIRCULAR_SPLINE))
    page.check("manufacture.beat_largest", "both: order 2 of the motor, largest over the joint turn",
               "sum of the two lines", Within(largest, relative=0.05), envelope.max(), "″",
               "the line between them, 201", evidence=IDENTITY)
    page.check("manufacture.beat_smallest", "both: order 2 of the motor, smallest over the joint turn",
               "difference of the two lines", Within(smallest, absolute=0.05 * largest), envelope.min(), "″",
               "5 % of the largest", evidence=IDENTITY)
    page.check("manufacture.beats", "both: times a joint turn that order 2 swells", "202 − 200", Within(2),
               swells(envelope), "", "a count", evidence=IDENTITY)
    page.check("manufacture.closure", "both: error after a joint turn less that before", "none",
               Within(0.0, absolute=1e-6), both.error[-1] - both.error[0], "″", "rounding of the equilibrium",
               evidence=IDENTITY)
    page.check("manufacture.work", "both: mean wave generator torque × 101 over the load",
               "virtual work: errors do no net work", Within(-1.0, absolute=5e-4),
               both.torque.mean() * JOINT_TURN / LOAD, "", "the mean is taken over samples, not integrated",
               evidence=IDENTITY)
    shipped = Turn(page, *only_flexspline, *only_spline, per_motor_turn=210, gear=())
    page.check("manufacture.work_shipped", "the same of the shipped gear", "virtual work: errors do no net work",
               Within(-1.0, absolute=5e-4), shipped.torque.mean() * JOINT_TURN / LOAD, "",
               "the mean is taken over more samples: its teeth push less evenly", evidence=IDENTITY)
    for line in (CIRCULAR_SPLINE, FLEXSPLINE):
        page.check(f"manufacture.averaged_{line}", f"line at {line} of the shipped gear over that on straight flanks",
                   "more teeth in mesh average", Between(0.6, 1.0), shipped.line(line) / both.line(line), "",
                   "an average cannot add; 0.6 is that over a lobe of 45° to either side", evidence=IDENTITY)


def sampling(page):
    """The tooth pass is sampled too seldom to be seen; what it folds to must not be taken for a line."""
    options = pitch("circular_spline", 8e-6)
    page.check("manufacture.sampling", "CS pitch 8 µm: line at 200 with 90 samples a motor turn over that with 130",
               "1", Within(1.0, absolute=1e-3),
               Turn(page, *options).line(200) / Turn(page, *options, per_motor_turn=130).line(200), "",
               "the tooth pass folds elsewhere; its sidebands are below 0.1 %", evidence=IDENTITY)


def swells(envelope):
    """Maxima of an envelope over a whole period, counted where it passes its middle upwards."""
    high = envelope > 0.5 * (envelope.max() + envelope.min())
    return int(np.sum(high & ~np.roll(high, 1)))


def as_built(page):
    page.heading("A gear as built")
    page.text(UR5)
    options = ("--config", "config/as_built.yaml")
    turn, unloaded, perfect = (Turn(page, *options, gear=()), Turn(page, *options, load=0.0, gear=()),
                               Turn(page, load=0.0, gear=()))
    page.check("manufacture.perfect", "perfect gear, no load: error from peak to peak over a joint turn",
               "drives with both encoders, order 2: 2.8″ and more", AtMost(0.28), perfect.range, "″",
               "the tooth pass alone: a tenth of the least line that is put down to errors", evidence=IDENTITY)
    page.value("manufacture.as_built_range", unloaded.range, "″")
    page.check("manufacture.as_built_order_2", "as built: line of the circular spline, 200",
               "drives with both encoders, order 2", Between(3.0, 13.0), turn.line(200), "″",
               "measured: 2.8, 6.9 and 13″",
               evidence=fitted("config/as_built.yaml was set so that this line lies there"))
    page.check("manufacture.as_built_order_4",
               "as built: line at 400 over line at 200 (per turn of the joint) of the position error",
               "the drive that shows both: 3.1 / 6.9", Within(3.1 / 6.9, relative=0.2), turn.line(400) / turn.line(200),
               "", "one drive; errors of no two gears are alike, and as_built.yaml's were drawn for straight flanks",
               known="no two gears have the same errors, and the errors of `as_built.yaml` were drawn for straight "
                     "flanks",
               evidence=fitted("config/as_built.yaml was set so that these lines lie there"))
    strongest = 150 + int(np.argmax(turn.lines[150:250]))
    page.check("manufacture.as_built_place", "as built: strongest line about order 2", "UR5 log: 200.1 ± 0.3",
               Within(200.1, absolute=0.3), strongest, "a joint turn", "as measured",
               evidence=fitted("config/as_built.yaml was set so that the line at 200 is the largest"))
    if page.fast:
        return
    seeds = [Turn(page, *options, *pitch("flexspline", 4e-6, 10 + seed), *pitch("circular_spline", 9.5e-6, 20 + seed),
                  gear=()) for seed in range(4)]
    page.value("manufacture.series_range", max(one.range for one in seeds), "″")
    page.value("manufacture.series_order_2", min(one.line(200) for one in seeds), "″")
    twice = Turn(page, *options, "--set", "manufacture.circular_spline_pitch_seed=2",
                 gear=())  # a run of its own, the same gear
    page.check("manufacture.reproducible", "the same seeds again: largest difference of the error", "0", Within(0.0),
               np.abs(twice.error - turn.error).max(), "″", "to the bit", evidence=IDENTITY)


def eccentricities(page):
    page.heading("Eccentricity and roundness")
    page.text(ECCENTRIC)
    generator = vector("wave_generator_eccentricity", 10e-6, 0.0)
    spline = vector("circular_spline_eccentricity", 10e-6, 0.0)
    teeth = pitch("flexspline", 8e-6)
    oval = vector("circular_spline_ellipticity", 2e-6, 0.0)
    cases = {
        "WG eccentric 10 µm": Turn(page, *generator),
        "WG too oval by 3 µm": Turn(page, *setting("wave_generator_ellipticity", "3.0e-6")),
        "CS eccentric 10 µm": Turn(page, *spline),
        "CS oval by 2 µm": Turn(page, *oval),
        "WG and CS eccentric 10 µm": Turn(page, *generator, *spline),
        "WG eccentric 10 µm, FS pitch 8 µm": Turn(page, *generator, *teeth),
    }
    for name, title in [("wave_generator_eccentricity", "WG eccentric 10 µm"),
                        ("wave_generator_ellipticity", "WG too oval by 3 µm")]:
        page.check(f"manufacture.{name}", f"{title}: largest line below the tooth pass",
                   "none: the gear repeats every tooth pitch", AtMost(1e-3), cases[title].low_lines().max(), "″",
                   "rounding of the equilibrium", evidence=IDENTITY)
    small, double = (Turn(page, *vector("circular_spline_eccentricity", size, 0.0)) for size in (0.5e-6, 1e-6))
    page.check("manufacture.spline_eccentricity_square", "CS eccentric: line at 200, 1 µm over 0.5 µm", "its square: 4",
               Within(4.0, relative=0.05), double.line(200) / small.line(200), "",
               "the next order, as long as both lobes carry", evidence=SELF_CONSISTENT)
    page.check("manufacture.spline_eccentricity_odd", "CS eccentric 10 µm: line at 100",
               "none: half a turn brings the same ellipse", AtMost(1e-3), cases["CS eccentric 10 µm"].line(100), "″",
               "rounding of the equilibrium", evidence=SELF_CONSISTENT)
    page.check("manufacture.spline_ellipticity", "CS oval by 2 µm: line at 200", "half of it, as an angle at the teeth",
               Within(1e-6 / radius(page) / ARCSEC, relative=0.05), cases["CS oval by 2 µm"].line(200), "″",
               "a ring bent without stretch moves its teeth along by half; flanks add some", evidence=SELF_CONSISTENT)
    together = cases["WG and CS eccentric 10 µm"]
    page.check("manufacture.eccentricities_together", "WG and CS eccentric: line at 100 over that at 200",
               "unequal lobes: odd orders appear", AtLeast(1.0), together.line(100) / together.line(200), "",
               "absent with either alone", evidence=SELF_CONSISTENT)
    with_teeth, teeth_only = cases["WG eccentric 10 µm, FS pitch 8 µm"], Turn(page, *teeth)
    page.check("manufacture.odd_teeth_alone", "FS pitch 8 µm alone: line at 101, order 1",
               "none: half a turn brings the same ellipse", AtMost(1e-3), teeth_only.line(101), "″",
               "rounding of the equilibrium", evidence=SELF_CONSISTENT)
    page.check("manufacture.odd_teeth_with", "WG eccentric as well: line at 101", "appears",
               AtLeast(0.5 * with_teeth.line(202)), with_teeth.line(101), "″", "its half", evidence=SELF_CONSISTENT)


def tables(page):
    page.heading("Measured gears")
    page.text("Pitch deviations measured on a gear go in as a table, `manufacture.flexspline_pitch_table` and "
              "`manufacture.circular_spline_pitch_table`. `joint_twin manufacture` writes such tables from seeds.")
    seeded = (*pitch("flexspline", 4e-6), *pitch("circular_spline", 9.5e-6))
    files = {member: page.scratch(f"{member}.csv") for member in ("flexspline", "circular_spline")}
    page.tool("manufacture", *seeded, "--flexspline-csv", files["flexspline"], "--circular-spline-csv",
              files["circular_spline"], "--force")
    with open(files["circular_spline"], encoding="utf-8") as file:
        written = [float(row["deviation"]) for row in csv.DictReader(file)]
    page.check("manufacture.table_deviation", "total deviation in the circular spline's table", "the parameter, 9.5 µm",
               Within(9.5, relative=1e-12), (max(written) - min(written)) * 1e6, "µm", "rounding", evidence=IDENTITY)
    tabled = [option for member, path in files.items() for option in setting(f"{member}_pitch_table", path)]
    page.check("manufacture.table_as_seeded",
               "gear from these tables and gear from the seeds: largest difference of the error", "0", Within(0.0),
               np.abs(Turn(page, *tabled).error - Turn(page, *seeded).error).max(), "″", "to the bit",
               evidence=IDENTITY)
