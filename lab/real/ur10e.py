# SPDX-License-Identifier: BSD-3-Clause
"""A UR10e in closed loop: its recordings hold no target angles, so the set points are its measured angles, smoothed."""
import os

import numpy as np

from closed_loop import WANTED, ClosedLoop, cell, line_amplitude, moving_errors
from runs import read, table
from ur5 import JOINTS, Fit, Recording

FOLDER = "ur10e"
TRAIN = "20_02_12-40sec_12harm"  # the only recording that is identified on
WINDOW, DEGREE = 21, 3           # rows and degree of the polynomials that smooth the angles: 0.2 s, ripple falls out


def smoothed(time, values):
    """Value, rate and acceleration by local polynomials (Savitzky and Golay) over WINDOW rows."""
    half = WINDOW // 2
    found = np.empty((3, len(values)))
    for row in range(len(values)):
        part = slice(max(0, min(row - half, len(values) - WINDOW)), max(WINDOW, min(row + half + 1, len(values))))
        powers = np.polynomial.polynomial.polyfit(time[part] - time[row], values[part], DEGREE)
        found[:, row] = powers[0], powers[1], 2.0 * powers[2]
    return found


def write_set_points(runner, name):
    data = read(runner.path(f"{name}.csv"))
    time = data["timestamp"]
    columns, names = [time], ["timestamp"]
    for number in range(len(JOINTS)):
        columns += list(smoothed(time, data[f"actual_q_{number}"]))
        names += [f"{quantity}_{number}" for quantity in ("target_q", "target_qd", "target_qdd")]
    np.savetxt(runner.path(f"motion_{name}.csv"), np.column_stack(columns), delimiter=",", header=",".join(names),
               comments="")
    return f"motion_{name}.csv"


def section(runner, telemetry, _docs, _images):
    """Lines of the page."""
    heading = ["## A UR10e in closed loop"]
    names = runner.link(os.path.join(telemetry, FOLDER), TRAIN)
    if not names:
        return heading + ["", f"*Not run: no recordings in {os.path.join(telemetry, FOLDER)}.*", ""]
    runner.run("identify", f"{TRAIN}.csv", "--arm", "ur10e", "--out", "ur10e_arm")
    recordings = {name: Recording(runner, name, "ur10e", ["arm"], "ur10e") for name in names}
    fit = Fit(recordings[TRAIN])
    rows, shares, beside_told = [], [], []
    for name, recording in recordings.items():
        loop = ClosedLoop(runner, recording, "ur10e_arm", arm="ur10e", motion=write_set_points(runner, name))
        cells = []
        for number, joint in enumerate(JOINTS):
            errors = moving_errors(recording, joint, fit, loop, number)
            lines = [line_amplitude(data["timestamp"], data[f"actual_qd_{number}"], data[f"actual_current_{number}"])
                     for data in (loop.data, recording.data)]
            cells.append(f"{cell(*errors)}; {cell(*lines)}")
            if name != TRAIN and not np.isnan(errors[0]):
                shares.append(errors[0] / errors[2])
                beside_told.append(errors[0] / errors[1])
        rows.append([name + (" (identified on)" if name == TRAIN else ""), *cells])
    shares = np.array(shares)
    return [*heading, f"""
Recordings of 2020 at 100 Hz (S. Mamedov, *dynamic_calibration*). They hold no target angles: `joint_twin arm` gets
the measured ones, smoothed by polynomials of degree {DEGREE} over {WINDOW} rows. So the motion is told but for its
ripple, and there is no tracking error to compare. Drives identified on {TRAIN} alone, gains typical.
In each cell: error of the current in moving rows, rms, closed loop / `follow` / simple fit with the recorded moment
[A]; amplitude of the current at 200 lines a turn, twin / recorded [A], –: no steady motion of a frequency that the rows
resolve. None of them knows the payload of 2.805 kg in ...Load; the fit has it in the moment only as far as the
controller does.

Of what was not identified on, the current in moving rows is within {WANTED:g} of the simple fit's error in
{np.count_nonzero(shares <= WANTED)} of {len(shares)} (recording, joint), and below it in
{np.count_nonzero(shares < 1.0)}; median {float(np.median(shares)):.2f}, and {float(np.median(beside_told)):.2f} of
`follow`'s. The loop does not bound it:
its error is that of `follow`. Both lack errors of manufacture, so their lines are a fraction of the recorded ones.
""", *table(["recording", *JOINTS], rows)]
