# SPDX-License-Identifier: BSD-3-Clause
"""A 101:1 drive with encoders on both sides: torsion against torque, transmission error without load."""
import os

import numpy as np

from runs import BLUE, GREEN, GREY, RED, figure, read, regress, rms, save, table, write_rows

LOADED, UNLOADED = os.path.join("lara8", "validate.csv"), os.path.join("lara8", "unloaded_transmission_error.csv")
RATIO = 101
STIFFNESS_ROWS, LINE_ROWS = "real_robot_stiffness.csv", "real_robot_lines.csv"  # beside the page
COUNTS = 2 ** 24  # a turn, of both encoders
STEADY = 0.6      # [rad/s] the sweep's constant speed is above it
STRIPE = 10.0     # [deg] of the sweep, in turn to identify on and to judge on
# Per turn of the output: from the circular spline two and four times, from the flexspline likewise, from the motor's
# encoder.
LINES = {200: "circular spline, 2", 400: "circular spline, 4", 202: "flexspline, 2", 404: "flexspline, 4",
         101: "once per motor turn"}
PITCH = 1.0e-5    # [m] of the twin's trial, which the amplitudes are proportional to
TREND = 24        # degree of the polynomial that takes in what is slower than ten waves a turn
TURN = ("--load", 5, "--angle-range", repr(2.0 * np.pi * RATIO), "--steps", 90 * RATIO, "--json")


def unloaded_error(path):
    """Both directions: output angle and transmission error [rad], as published, in the order of the sweep."""
    data = read(path)
    angle, error = np.radians(data["load_angle_deg"]), data["transmission_error_counts"] * 2.0 * np.pi / COUNTS
    turning = int(np.argmax(angle)) + 1
    return {"forwards": (angle[:turning], error[:turning]), "backwards": (angle[turning:], error[turning:])}


def slow_error(sweeps, at):
    """Transmission error without load at other angles: medians per 2 degrees of both directions [rad]."""
    angle, error = (np.concatenate([sweep[i] for sweep in sweeps.values()]) for i in (0, 1))
    bins = np.digitize(np.degrees(angle), np.arange(-150.0, 151.0, 2.0))
    known = np.unique(bins)
    return np.interp(np.degrees(at), 2.0 * known - 151.0, [np.median(error[bins == k]) for k in known])


class Torsion:
    """Recorded, predicted from the catalogue alone, and identified on one half of the sweep, judged on the other.
    `tool`: runs `joint_twin ARGUMENTS --json` and gives its document. `with_motor`: the motor's own friction counts."""

    def __init__(self, tool, data, sweeps, with_motor=False):
        speed = data["joint_velocity_3"]
        steady = speed > STEADY
        angle = data["joint_angles_3"][steady]
        torque = data["joint_torque_current_3"][steady]
        torsion = (2.0 * np.pi / COUNTS * (data["encoder_motorinc_3"] / RATIO - data["encoder_loadinc_3"]))[steady]
        losses = tool("losses", "--positions", 4, "--speeds", f"{RATIO * np.median(speed[steady]):.4g}", "--loads",
                      f"{np.median(np.abs(torque)):.4g}")["rows"][0]
        self.friction = RATIO * (losses["gear_loss"] + (losses["motor"] if with_motor else 0.0))
        self.loads = np.linspace(-160.0, 160.0, 65)
        rows = tool("stiffness", "--torques", ",".join(f"{load:g}" for load in self.loads))["rows"]
        self.twist = -np.array([row["output_angle"] for row in rows])

        self.torque = torque - self.friction
        self.torsion = torsion - slow_error(sweeps, angle)
        self.predicted = predicted = np.interp(self.torque, self.loads, self.twist)
        train = np.floor(np.degrees(angle) / STRIPE) % 2 == 0
        columns = np.column_stack([predicted, np.ones_like(predicted)])
        line = np.column_stack([torque, np.ones_like(predicted)])
        self.origin = np.mean((self.torsion - predicted)[train])
        (self.scale, offset), (self.width, _), _ = regress(columns[train], self.torsion[train])
        self.halves = [regress(columns[half], self.torsion[half])[0][0] for half in (angle < 0.0, angle >= 0.0)]
        judged = {"twin, catalogue": predicted + self.origin, "twin, identified": self.scale * predicted + offset,
                  "a straight line": line @ regress(line[train], self.torsion[train])[0]}
        self.errors = {name: (rms((self.torsion - values)[train]), rms((self.torsion - values)[~train]))
                       for name, values in judged.items()}
        self.shift = offset - self.origin
        stiffness = np.gradient(self.loads, self.twist)
        self.stiffness = {load: float(np.interp(load, self.loads, stiffness)) for load in (5.0, 30.0, 100.0)}

    def draw(self, path):
        drawing, axes = figure(1, 1, (7.5, 4.2))
        axes.plot(self.torque, 1e3 * (self.torsion - self.origin), ".", ms=2, color=GREY, label="recorded")
        axes.plot(self.loads, 1e3 * self.twist, color=BLUE, label="twin, predicted from the catalogue")
        axes.plot(self.loads, 1e3 * (self.scale * self.twist + self.shift), color=RED, lw=1.0,
                  label="twin, compliance identified on every second stripe")
        axes.set(xlim=(-90.0, 120.0), ylim=(-3.0, 3.2), xlabel="torque at the joint less friction [N·m]",
                 title="Torsion of a 101:1 drive with both encoders [mrad]")
        axes.legend(fontsize=8)
        save(drawing, path)

    def rows(self):
        return [[f"{load:g}", f"{1e-3 * value:.1f}", f"{1e-3 * value / self.scale:.1f}",
                 f"{1e-3 * value * self.width / self.scale ** 2:.1f}"] for load, value in self.stiffness.items()]

    def page(self):
        return [f"""
**Torsion.** The figure shows the torsion (motor angle / 101 − output angle), minus the torsion without load at the same
angle. The abscissa is the motor's torque at the joint minus {self.friction:.1f} N·m, the twin's friction at the speed
of the sweep. The blue curve is the torsion of the catalogue's gear. Only the origin of the blue curve comes from the
recording, because the zeros of the encoders are arbitrary. The red curve has the catalogue's compliance times
{self.scale:.3f} ± {self.width:.3f} (95 %). The program identified the factor on every second stripe of {STRIPE:g}° of
the joint's angle and tested it on the stripes between.

![Torsion against torque](images/real_robot/torsion.png)
""", *table(["rms difference of the recorded torsion from", "stripes that were fitted [mrad]",
             "stripes between [mrad]"],
            [[name, f"{1e3 * a:.2f}", f"{1e3 * b:.2f}"] for name, (a, b) in self.errors.items()]),
                f"""
[{STIFFNESS_ROWS}]({STIFFNESS_ROWS}) has the stiffness by load.

*Weakness:* a fit to the negative joint angles alone gives {self.halves[0]:.2f} times the catalogue's compliance, a fit
to the positive angles {self.halves[1]:.2f} times. These two factors differ by more than the stated interval, so the
interval is too narrow. With a factor identified on one half of the angles the error of the torsion on the other half is
larger than with the catalogue's curve. The error that remains is slow waves of the transmission error, which depend on
load and mounting. One sweep cannot separate the slow waves from torsion. The catalogue's compliance lies between those
of the two fits.
"""]


def amplitudes(angle, error):
    """Amplitude of each line and half width of its 95 % interval [rad], what is slow taken out by a polynomial."""
    order = np.argsort(angle)
    angle, error = angle[order], error[order]
    columns = [np.polynomial.chebyshev.chebvander(angle / 2.62, TREND)]
    columns += [np.column_stack([np.cos(line * angle), np.sin(line * angle)]) for line in LINES]
    found, width, _ = regress(np.hstack(columns), error)
    at = TREND + 1
    return {line: (np.hypot(*found[at + 2 * i:at + 2 * i + 2]), width[at + 2 * i:at + 2 * i + 2].max())
            for i, line in enumerate(LINES)}


class TransmissionError:
    """Lines of the recording beside the twin's, whose pitch deviations make up the lines at 200 and 202."""

    def __init__(self, runner, sweeps):
        self.recorded = {name: amplitudes(*sweep) for name, sweep in sweeps.items()}
        trial = self.twin(runner, {"circular_spline": PITCH, "flexspline": PITCH})
        self.pitch = {member: PITCH * np.mean([lines[line][0] for lines in self.recorded.values()]) / trial[line]
                      for member, line in (("circular_spline", 200), ("flexspline", 202))}
        self.lines = self.twin(runner, self.pitch)

    @staticmethod
    def twin(runner, pitch):
        settings = [text for member, deviation in pitch.items()
                    for text in ("--set", f"manufacture.{member}_pitch_deviation={deviation:.8f}")]
        rows = runner.run("turn", *TURN, *settings)["rows"][:-1]
        error = np.array([row["kinematic_error"] for row in rows])
        lines = 2.0 * np.abs(np.fft.rfft(error)) / len(error)
        return {line: lines[line] for line in LINES}

    def draw(self, path):
        drawing, axes = figure(1, 1, (7.5, 3.6))
        at = np.arange(len(LINES))
        for shift, (name, lines), colour in zip((-0.25, 0.0), self.recorded.items(), (GREY, GREEN)):
            values = np.array([lines[line] for line in LINES]) * 1e6
            axes.bar(at + shift, values[:, 0], 0.22, yerr=values[:, 1], color=colour, ecolor="0.3",
                     error_kw={"lw": 0.8}, label=f"recorded, {name}")
        axes.bar(at + 0.25, [1e6 * self.lines[line] for line in LINES], 0.22, color=BLUE, label="twin")
        axes.set_xticks(at)
        axes.set_xticklabels([f"{line}\n{name}" for line, name in LINES.items()])
        axes.set_title("Transmission error without load, lines a turn of the output [µrad]")
        axes.legend(fontsize=8)
        save(drawing, path)

    def rows(self):
        return [[f"{line}", name, *(f"{1e6 * value:.1f}" for lines in self.recorded.values() for value in lines[line]),
                 f"{1e6 * self.lines[line]:.1f}"] for line, name in LINES.items()]

    def page(self):
        return [f"""
**Transmission error without load.** The figure compares the lines of the published error in each direction of rotation
with the lines of the twin's kinematic error, computed at 5 N·m. Two pitch deviations of the twin are fitted to the
published lines. The line at 200 per turn of the joint gives a total cumulative pitch deviation of the circular spline
of {1e6 * self.pitch['circular_spline']:.1f} µm. The line at 202 per turn of the joint gives a total cumulative pitch
deviation of the flexspline of {1e6 * self.pitch['flexspline']:.1f} µm. The scatter of the published points nearly hides
the line at 202. ISO 1328 allows a pitch deviation of 17 µm in grade 5 and 12 µm in grade 4 at this size. The twin's
lines at 400 and 404 result from the same two pitch deviations. The line of the circular spline (200) is larger than
that of the flexspline (202), as in the current of the UR5.

![Lines of the transmission error](images/real_robot/transmission_error.png)

[{LINE_ROWS}]({LINE_ROWS}) has the amplitudes of the lines. The twin has no line at 101 per turn of the joint (once per
turn of the motor), because pitch deviations make no such line. The two lobes share the load, and the lead of one lobe
cancels the lag of the other lobe. Errors of other parts can make the line at 101. A wave generator off its axis
together with run-out of the flexspline, 10 µm each, makes 10 µrad without load and 7 µrad at 67 N·m
(`manufacture.wave_generator_eccentricity`, `manufacture.flexspline_eccentricity`). A motor encoder with an error of 1.1
mrad by eccentricity makes 11 µrad at the output, whatever the load. A recording without load cannot separate the errors
of wave generator and encoder. The recorded error has an amplitude of 0.6 mrad once and 0.35 mrad twice per turn of the
output. The whole error of a gear of this kind may be 1 minute of arc (0.29 mrad). The recorded amplitudes are larger
than this error, so the output encoder is eccentric.

*Limits of this recording:* the size of the drive is inferred from its ratio and torque. The sweep turns in one
direction only and takes 7 s. The torque is computed from the current. The error without load comes from a published
figure, whose points scatter by 0.03 mrad.
"""]


def section(runner, telemetry, docs, images):
    """Lines of the page."""
    heading = ["## A 101:1 drive with both encoders", """
The drive is the elbow of a NEURA LARA 8, not of a UR. The recording of this drive (A. Lucious, 2024) is the only public
recording of a drive with this ratio and encoders at motor and output.
"""]
    paths = [os.path.join(telemetry, name) for name in (LOADED, UNLOADED)]
    missing = [path for path in paths if not os.path.isfile(path)]
    if missing:
        print("skipped: no " + ", ".join(missing))
        return heading + [f"*Not run: no {', '.join(missing)}.*", ""]
    sweeps = unloaded_error(paths[1])
    torsion = Torsion(lambda *words: runner.run(*words, "--json"), read(paths[0]), sweeps)
    torsion.draw(os.path.join(images, "torsion.png"))
    write_rows(os.path.join(docs, STIFFNESS_ROWS), ["load [N.m]", *(f"{name} [1e3 N.m/rad]" for name in (
        "catalogue", "identified", "half width of the identified"))], torsion.rows())
    error = TransmissionError(runner, sweeps)
    error.draw(os.path.join(images, "transmission_error.png"))
    write_rows(os.path.join(docs, LINE_ROWS), ["lines per turn of the joint", "cause", *(
        f"{name} [urad]" for way in error.recorded for name in (way, f"half width, {way}")), "twin [urad]"],
               error.rows())
    return heading + torsion.page() + error.page()
