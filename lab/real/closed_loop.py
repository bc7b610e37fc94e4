# SPDX-License-Identifier: BSD-3-Clause
"""The whole arm in closed loop along the recorded targets, not told how the robot moved: its angles and currents beside
the recorded ones."""
import os

import numpy as np

from runs import BLUE, GREY, figure, read, rms, save, write_rows

LOOP_LINES = 200           # a turn of the joint
STEADY = 0.05              # share by which the speed may vary in a stretch whose line is read
STRETCH = 0.5              # [s]
LINE_BAND = (10.0, 55.0)   # frequencies of the lines that the rows resolve [Hz]
SLOW = 3.0                 # below it an error is none of ripple [Hz]
WANTED = 0.8               # of the simple fit's error
GAINS_FROM = "no5"         # recording on which the controller's gains are identified
DELAY_FROM = {"no7", "no7_pushed"}  # recordings of the motion that the delay of the set points was read from
# Files beside the page.
LOOP_ROWS, BUILT_ROWS, PICTURE = "real_robot_loop.csv", "real_robot_built.csv", "images/real_robot/closed_loop.png"
TRACKED = ["tracking_twin [mrad]", "tracking_recorded [mrad]"]
LINES = ["current_line_twin [A]", "current_line_recorded [A]"]
# Errors of the circular spline alone: a gear with errors on both members has no table.
BUILT = ["--config", "as_built.yaml", "--set", "manufacture.flexspline_pitch_deviation=0.0", "--set",
         "manufacture.wave_generator_eccentricity=[0.0,0.0]"]


def tracking(data, joint):
    """Actual less target angle, rms about its mean: an offset is the encoder's zero [mrad]."""
    return 1e3 * float(np.std(data[f"actual_q_{joint}"] - data[f"target_q_{joint}"]))


def likeness(loop, joint):
    """Correlation in time of the run's tracking error with the recorded one."""
    recorded = loop.recording.data
    mine, robots = (data[f"actual_q_{joint}"] - data[f"target_q_{joint}"] for data in (loop.data, recorded))
    return float(np.corrcoef(np.interp(loop.times, loop.data["timestamp"], mine), robots)[0, 1])


def both_ways(ratios, factor):
    """How many of the ratios are within a factor of 1, above and below."""
    return int(np.count_nonzero((ratios <= factor) & (ratios >= 1.0 / factor)))


def line_amplitude(time, speed, values):
    """Amplitude at LOOP_LINES a turn, mean over all stretches of steady speed; NaN: there is none."""
    found = []
    begin = 0
    while begin < len(time):
        end = int(np.searchsorted(time, time[begin] + STRETCH))
        part = slice(begin, end)
        mean = float(np.mean(speed[part])) if end > begin else 0.0
        frequency = abs(mean) * LOOP_LINES / (2.0 * np.pi)
        if (end < len(time) and LINE_BAND[0] < frequency < LINE_BAND[1]
                and np.ptp(speed[part]) < 2.0 * STEADY * abs(mean)):
            phase = 2.0 * np.pi * frequency * time[part]
            columns = np.column_stack([np.cos(phase), np.sin(phase), np.ones_like(phase), time[part]])
            found.append(np.hypot(*np.linalg.lstsq(columns, values[part], rcond=None)[0][:2]))
        begin = end
    return float(np.mean(found)) if len(found) > 2 else float("nan")


def progress(data):
    """Share of its way that the set point has gone, all joints together."""
    way = np.sum([np.abs(np.diff(data[f"target_q_{joint}"])) for joint in range(6)], axis=0)
    return np.concatenate([[0.0], np.cumsum(way)]) / np.sum(way)


class ClosedLoop:
    """A run of `joint_twin arm` along the targets of a recording (ur5.Recording), or along `motion`."""

    def __init__(self, runner, recording, identified, *more, arm="ur5", motion=None):
        self.recording = recording
        out = f"loop_{identified}_{recording.name}.csv"
        runner.run("arm", motion or f"{recording.name}.csv", "--arm", arm, "--identified", identified, "--out", out,
                   "--json", *more)
        self.data = read(runner.path(out))
        recorded = recording.data
        self.stamps = recorded["timestamp"] - recorded["timestamp"][0]
        self.times = recorded["timestamp"]  # of the run at these stamps
        if abs(self.data["timestamp"][-1] - self.times[-1]) > np.median(np.diff(self.times)):
            # Its set points' times were straightened: an instant is known by how far the motion has come.
            self.times = np.interp(progress(recorded), progress(self.data), self.data["timestamp"])

    def residual(self, name, joint):
        """Recorded less simulated current, at the rows that were compared [A]."""
        rows = self.recording.rows["arm", name]
        times = np.interp(rows["time"], self.stamps, self.times)
        return rows["current_measured"] - np.interp(times, self.data["timestamp"],
                                                    self.data[f"actual_current_{joint}"])


def residuals_of(recording, name, fit, loop, number):
    """Of a joint's current: closed loop, told the motion, simple fit [A]."""
    return (loop.residual(name, number), recording.rows["arm", name]["current_residual"],
            fit.residual(recording, name))


def moving_errors(recording, name, fit, loop, number):
    """Rms errors of a joint's current in moving rows: closed loop, told the motion, simple fit [A]; NaN: none moves."""
    moving = recording.moving(name)
    return [rms(residual[moving]) if moving.any() else float("nan")
            for residual in residuals_of(recording, name, fit, loop, number)]


def slow_and_fast(recording, name, residual):
    """Rms below and above SLOW of a residual in moving rows [A]."""
    moving = recording.moving(name)
    lines = np.fft.fft(np.where(moving, residual, 0.0))
    slow = np.abs(np.fft.fftfreq(len(residual), recording.period())) < SLOW
    powers = np.abs(lines) ** 2 / len(residual) / np.count_nonzero(moving)
    return np.sqrt([np.sum(powers[slow]), np.sum(powers[~slow])])


def draw(path, loop, joints):
    drawing, all_axes = figure(len(joints), 1, (9.0, 5.0), sharex=True)
    recorded = loop.recording.data
    start = recorded["timestamp"][0]
    for axes, (number, name) in zip(all_axes, joints):
        for data, colour, label in ((recorded, GREY, "recorded"), (loop.data, BLUE, "twin in closed loop")):
            axes.plot(data["timestamp"] - start,
                      1e3 * (data[f"actual_q_{number}"] - data[f"target_q_{number}"]
                             - np.mean(data[f"actual_q_{number}"] - data[f"target_q_{number}"])),
                      color=colour, lw=0.8, label=label)
        most = 1.5 * np.percentile(np.abs(recorded[f"actual_q_{number}"] - recorded[f"target_q_{number}"]), 99.0)
        axes.set(ylim=(-1e3 * most, 1e3 * most), title=f"{name}: actual less target angle [mrad]")
    all_axes[0].legend(loc="upper right", fontsize=8, ncol=2)
    all_axes[-1].set_xlabel(f"time in {loop.recording.name} [s]")
    save(drawing, path)


def line_of(data, joint, values):
    return line_amplitude(data["timestamp"], data[f"target_qd_{joint}"], values)


def built_section(runner, recordings, fit, joints, train, docs):
    """Lines of the page: drives with errors of manufacture, the controller's gains identified on one recording."""
    runner.run("identify", f"{train}.csv", "--arm", "ur5", "--out", "built")
    gains = runner.run("identify", f"{GAINS_FROM}.csv", "--arm", "ur5", "--controller", "--out", "built", "--json")
    rows, ratios, errors = [], {name: [] for name in joints}, []
    for recording in recordings:
        loop = ClosedLoop(runner, recording, "built", *BUILT)
        for number, name in enumerate(joints):
            current, _, simple = moving_errors(recording, name, fit, loop, number)
            both = loop.data, recording.data
            currents, angles = ([line_of(data, number, data[f"actual_current_{number}"]) for data in both],
                                [1e6 * line_of(data, number, data[f"actual_q_{number}"] - data[f"target_q_{number}"])
                                 for data in both])
            rows.append([recording.name, name, *(tracking(data, number) for data in both), current, simple, *currents,
                         *angles])
            ratios[name].append(currents[0] / currents[1])
            errors.append(current / simple)
    write_rows(os.path.join(docs, BUILT_ROWS), ["recording", "joint", *TRACKED, "current_loop [A]", "current_fit [A]",
                                                *LINES, "angle_line_twin [urad]", "angle_line_recorded [urad]"], rows)
    known = np.concatenate([np.array(values)[~np.isnan(values)] for values in ratios.values()])
    found = ", ".join(f"{joint['joint']} {joint['speed']:.0f} N·m·s/rad, {joint['position']:.0f} 1/s"
                      for joint in gains["joints"] if not joint["refusal"])
    within = np.count_nonzero((known <= 2.0) & (known >= 0.5))
    return [f"""
**With errors of manufacture and identified gains.** In a second simulation the drives have the circular splines of
`config/as_built.yaml` (7″ at {LOOP_LINES} periods per turn of the joint) and equal flexsplines, so that each drive has
a table. `identify --controller` found the controller's gains of speed [N·m·s/rad] and position [1/s] from {GAINS_FROM}:
{found}. [{BUILT_ROWS}]({BUILT_ROWS}) has all figures.

The current has a ripple with {LOOP_LINES} periods per turn of the joint. The simulated amplitude of the ripple is
within a factor of two of the recorded amplitude in {within} of {len(known)} cases. In the median the simulated
amplitude is {float(np.median(known)):.2f} times the recorded amplitude. The error of the simulated current in moving
rows is {float(np.nanmedian(errors)):.2f} of the simple fit's error in the median.
[arm_twin.md](arm_twin.md#errors-of-manufacture) says what limits the prediction of ripple.
"""]


def section(runner, recordings, fit, joints, shown, docs, train):
    """Lines of the page. `fit`: of the current, on another recording, told the motion."""
    rows, tracked, alike, currents, parts = [], [], [], [], []
    for recording in recordings:
        loop = ClosedLoop(runner, recording, "identified_arm")
        if recording.name == shown:
            draw(os.path.join(docs, PICTURE), loop, list(enumerate(joints))[1:4])
        for number, name in enumerate(joints):
            current, told, simple = moving_errors(recording, name, fit, loop, number)
            errors = tracking(loop.data, number), tracking(recording.data, number)
            lines = [line_amplitude(data["timestamp"], data[f"actual_qd_{number}"], data[f"actual_current_{number}"])
                     for data in (loop.data, recording.data)]
            rows.append([recording.name, name, *errors, current, told, simple, *lines])
            if recording.name not in DELAY_FROM:
                tracked.append(errors[0] / errors[1])
                alike.append(likeness(loop, number))
            if not np.isnan(current):
                currents.append(current / simple)
                parts.append([[*slow_and_fast(recording, name, residual), rms(residual[recording.moving(name)])]
                              for residual in residuals_of(recording, name, fit, loop, number)])
    write_rows(os.path.join(docs, LOOP_ROWS), ["recording", "joint", *TRACKED, "current_loop [A]", "current_told [A]",
                                               "current_fit [A]", *LINES], rows)
    tracked, currents, parts = np.array(tracked), np.array(currents), np.array(parts)
    (loop_slow, loop_fast), (told_slow, told_fast) = (np.median(parts[:, k, :2] / parts[:, 2, :2], axis=0)
                                                      for k in (0, 1))
    bound = np.count_nonzero(parts[:, 2, 1] > WANTED * parts[:, 2, 2])
    return [f"""
### In closed loop

`joint_twin arm` simulates the arm with its controller. The controller follows the recorded set points of each
recording, with typical gains of position and speed. The drives have the parameters identified on {train}. The twin gets
neither the measured angles nor the currents. [{LOOP_ROWS}]({LOOP_ROWS}) has for each recording and joint the tracking
error (actual − target angle, rms about its mean) and the rms error of the current in moving rows. The error of the
current is given for the closed loop, for the prescribed motion (`follow`) and for the simple fit. If a joint moves
steadily, the file also has the amplitude of the current at {LOOP_LINES} periods per turn of the joint.

The delay between a set point and the controller's reaction (`delay` in `ur5.yaml`) was estimated from no6, whose motion
no7 and no7_pushed repeat. The recordings of motions other than this one give {len(tracked)} cases (one joint in one
recording). The twin's tracking error is within a factor of 1.5 of the recorded tracking error in
{both_ways(tracked, 1.5)} cases, and within a factor of two in {both_ways(tracked, 2.0)} cases. The correlation in time
between the twin's and the recorded tracking error is {np.median(alike):.2f} in the median of the cases and
{np.min(alike):.2f} at least. The twin's error of the current in moving rows is at most {WANTED:g} of the simple fit's
error in {np.count_nonzero(currents <= WANTED)} of {len(currents)} cases, and below the simple fit's error in
{np.count_nonzero(currents < 1.0)} cases.

Ripple limits the prediction of the current. The closed loop's error of the current, divided by that of the simple fit,
is in the median {loop_slow:.2f} for frequencies below {SLOW:g} Hz, and {loop_fast:.2f} above {SLOW:g} Hz. With the
prescribed motion (`follow`) the medians are {told_slow:.2f} below and {told_fast:.2f} above {SLOW:g} Hz. The simulated
drives have no errors of manufacture and make no ripple, but the prescribed motion contains the ripple of the robot. In
{bound} of {len(currents)} cases the part of the simple fit's error above {SLOW:g} Hz is more than {WANTED:g} of the
whole error of the simple fit.
""", *built_section(runner, recordings, fit, joints, train, docs), f"""
![Tracking error of three joints in {shown}, recorded and in closed loop]({PICTURE})
"""]
