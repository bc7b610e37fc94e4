# SPDX-License-Identifier: BSD-3-Clause
"""A UR10e in closed loop: its recordings hold no target angles, so the set points are its measured angles, smoothed."""
import os

import numpy as np

from closed_loop import LINES, WANTED, ClosedLoop, line_amplitude, moving_errors
from runs import read, write_rows
from ur5 import JOINTS, Fit, Recording

FOLDER = "ur10e"
TRAIN = "20_02_12-40sec_12harm"  # the only recording that is identified on
ROWS = "real_robot_ur10e.csv"    # beside the page
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


def section(runner, telemetry, docs, _images):
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
        for number, joint in enumerate(JOINTS):
            errors = moving_errors(recording, joint, fit, loop, number)
            lines = [line_amplitude(data["timestamp"], data[f"actual_qd_{number}"], data[f"actual_current_{number}"])
                     for data in (loop.data, recording.data)]
            rows.append([name, joint, *errors, *lines])
            if name != TRAIN and not np.isnan(errors[0]):
                shares.append(errors[0] / errors[2])
                beside_told.append(errors[0] / errors[1])
    write_rows(os.path.join(docs, ROWS), ["recording", "joint", "current_loop [A]", "current_told [A]",
                                          "current_fit [A]", *LINES], rows)
    shares = np.array(shares)
    return [*heading, f"""
The recordings are of 2020, at 100 Hz (S. Mamedov, *dynamic_calibration*), and contain no target angles. The set points
of `joint_twin arm` are therefore the measured angles, smoothed by polynomials of degree {DEGREE} over {WINDOW} rows.
The twin thus receives the motion without its ripple, and a tracking error cannot be compared. The program identifies
the drives on the recording {TRAIN} alone. The gains of the controller are typical values. [{ROWS}]({ROWS}) has for each
recording and joint the rms error of the current in moving rows [A], for the closed loop, for `follow` and for the
simple fit with the recorded moment. The file also has the amplitude of the current at 200 periods per turn of the joint
[A], of the twin and of the recording. No twin knows the payload of 2.805 kg of the last recording. The simple fit knows
the payload as far as the recorded moment of the controller contains its weight.

The recordings that the drives were not identified on give {len(shares)} cases (one joint in one recording). The twin's
error of the current in moving rows is at most {WANTED:g} of the simple fit's error in
{np.count_nonzero(shares <= WANTED)} of the cases, and below the simple fit's error in {np.count_nonzero(shares < 1.0)}
of the cases. In the median the twin's error is {float(np.median(shares)):.2f} of the simple fit's error and
{float(np.median(beside_told)):.2f} of the error of `follow`, so the closed loop does not limit the prediction. The
drives of `arm` and `follow` have no errors of manufacture, so the ripple of the twin is a fraction of the recorded
ripple.
"""]
