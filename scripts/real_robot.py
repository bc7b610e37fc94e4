#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Identifies the joints of a recorded UR5 on a part of the recording, judges on the rest, writes docs/real_robot.md.
Started by scripts/compare_real."""
import argparse
import json
import os
import subprocess
import sys
import tempfile

import numpy as np
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (the backend is chosen before pyplot is loaded)

RECORDING = os.path.join("ur5_cb", "ur5_cb_no6.csv")
JOINTS = ["base", "shoulder", "elbow"]
FIRST_REPEAT = 26.936  # [s] where the second repeat of the recorded motion begins
JOIN = 0.8             # [s] the recording was put together from three; the controller's jolt at each join
MOVING = 0.01          # [rad/s]
GREY, BLUE, RED = "0.6", "#0072B2", "#D55E00"


class Runner:
    def __init__(self, tool, directory):
        self.tool, self.directory, self.commands = tool, directory, []

    def run(self, *arguments):
        done = subprocess.run([self.tool, *map(str, arguments)], cwd=self.directory, stdout=subprocess.PIPE,
                              universal_newlines=True, check=True)
        self.commands.append(" ".join(["joint_twin", *map(str, arguments)]))
        return json.loads(done.stdout)


def repeatability(data, joint):
    """What one repeat of the motion differs from another, rms over sqrt 2 [A]: moving and resting rows."""
    period = round(FIRST_REPEAT / 0.008)
    current, speed = data[f"actual_current_{joint}"], data[f"actual_qd_{joint}"]
    rows = np.arange(round(JOIN / 0.008), period - 2)
    moving = np.abs(speed[rows + period]) > MOVING
    differences = (current[rows + 2 * period] - current[rows + period]) / np.sqrt(2.0)
    return [rms(differences[mask]) for mask in (moving, ~moving)]


def spectrum(angle, residual, orders):
    """Amplitude of each order of the joint angle in the residual [A]."""
    residual = residual - residual.mean()
    return np.array([2.0 * abs(np.mean(residual * np.exp(-1j * order * angle))) for order in orders])


def rms(values):
    return float(np.sqrt(np.mean(np.square(values))))


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return lines + ["| " + " | ".join(row) + " |" for row in rows] + [""]


def examine(runner, path, data):
    """Of each joint: what was identified, and every row with the prediction beside it."""
    results = {}
    for joint in JOINTS:
        overlay = f"{joint}_identified.yaml"
        configuration = ["--joint", joint, "--config", f"joints/{joint}.yaml"]
        found = runner.run("identify", path, *configuration, "--train", f"0,{FIRST_REPEAT}", "--judge",
                           f"{FIRST_REPEAT},1000", "--out", overlay, "--json")
        runner.run("follow", path, *configuration, "--config", overlay, "--out", f"{joint}.csv", "--json")
        rows = np.genfromtxt(os.path.join(runner.directory, f"{joint}.csv"), delimiter=",", names=True)
        results[joint] = (found, rows)
    return results


def errors(results, data):
    rows = []
    for number, joint in enumerate(JOINTS):
        judged = results[joint][0]["judged"]
        later = data["timestamp"] >= FIRST_REPEAT
        controller = rms((data[f"target_current_{number}"] - data[f"actual_current_{number}"])[later])
        repeat = repeatability(data, number)

        def cell(name):
            error = judged[name]
            return f"{error['all']:.3f} ({error['moving']:.3f}, {error['resting']:.3f})"

        rows.append([joint, f"{judged['identified']['signal']:.3f}", f"{controller:.3f}", cell("gain_coulomb_viscous"),
                     cell("configured"), cell("identified"), cell("identified_with_lines"),
                     f"{repeat[0]:.3f}, {repeat[1]:.3f}"])
    return rows


def values(results):
    names = [value["name"] for value in results[JOINTS[0]][0]["values"]]
    rows = []
    for i, name in enumerate(names):
        row = [name]
        for joint in JOINTS:
            value = results[joint][0]["values"][i]
            row.append(f"{value['value']:.3g} ± {value['half_width']:.1g} {value['unit']}" if not value["refusal"]
                       else f"*{value['refusal']}*")
        rows.append(row)
    for i, line in enumerate(results[JOINTS[0]][0]["lines"]):
        row = [f"ripple, {line['order']:g} a joint turn"]
        for joint in JOINTS:
            line = results[joint][0]["lines"][i]
            row.append(f"{line['amplitude']:.2g} ± {line['half_width']:.1g} N·m" if not line["refusal"]
                       else f"*{line['refusal']}*")
        rows.append(row)
    return rows


def draw_current(path, results):
    figure, all_axes = plt.subplots(3, 1, figsize=(9.0, 7.0), sharex=True, constrained_layout=True)
    for axes, joint in zip(all_axes, JOINTS):
        rows = results[joint][1]
        part = (rows["time"] >= FIRST_REPEAT) & (rows["time"] < 2 * FIRST_REPEAT)
        time = rows["time"][part] - FIRST_REPEAT
        axes.plot(time, rows["current_measured"][part], color=GREY, lw=0.8, label="measured")
        predicted, band = rows["current_predicted"][part], rows["current_band"][part]
        axes.fill_between(time, predicted - band, predicted + band, color=BLUE, alpha=0.2, lw=0,
                          label="band of a healthy joint")
        axes.plot(time, predicted, color=BLUE, lw=0.8, label="twin")
        axes.set_title(f"{joint}: motor current [A]")
        axes.set_ylim(*(np.array([-0.6, 0.6]) + np.percentile(rows["current_measured"][part], [0.5, 99.5])))
    all_axes[0].legend(loc="lower right", fontsize=8, ncol=3)
    all_axes[-1].set_xlabel("time in the second repeat [s]; identified on the first")
    figure.savefig(path, dpi=110)
    plt.close(figure)


def draw_spectrum(path, results):
    figure, all_axes = plt.subplots(3, 1, figsize=(9.0, 6.0), sharex=True, constrained_layout=True)
    orders = np.arange(20.0, 460.0, 0.5)
    for axes, joint in zip(all_axes, JOINTS):
        rows = results[joint][1]
        for sign, colour, name in ((1.0, BLUE, "turning positive"), (-1.0, RED, "negative")):
            part = (sign * rows["velocity_measured"] > 0.1) & (rows["time"] % FIRST_REPEAT > JOIN)
            axes.plot(orders, spectrum(rows["position_measured"][part], rows["current_residual"][part], orders), color=colour,
                      lw=0.8, label=name)
        for order in (200.0, 202.0, 400.0, 404.0):
            axes.axvline(order, color="0.8", lw=0.6, zorder=0)
        axes.set_title(f"{joint}: residual of the current without ripple [A]")
    all_axes[0].legend(fontsize=8)
    all_axes[-1].set_xlabel("order per turn of the joint; grey: two and four a turn of the wave generator")
    figure.savefig(path, dpi=110)
    plt.close(figure)


def write_page(docs, results, data, commands):
    lines = ["""# Beside a real robot

Written by `scripts/compare_real`; do not edit. A UR5, CB series, moving for 82 s (K. Kufieta, *Force Estimation in Robotic
Manipulators*, NTNU 2014; 125 Hz). The recording is not part of this project. The same motion comes three times: each joint is
identified on the first (`joint_twin identify`), and judged on the other two. The twin is **motion-driven**: measured angle and
the controller's rigid-body torque in, motor current out.

## Error of the predicted current [A rms]

All rows, and in brackets those that move faster than 0.01 rad/s and those that rest.
"""]
    lines += table(["joint", "the current", "controller's target_current", "gain, Coulomb, viscous fitted", "twin as shipped",
                    "twin identified", "with ripple", "repeat against repeat: moving, resting"], errors(results, data))
    lines += ["""
The right column is what no model of this motion can go below: one repeat differs from the next by so much. While a joint rests,
stiction holds it, and within the band the current is the controller's choice, not the motion's: the twin then tells the band. Three rows of
four rest, so the figure for all rows says more of that than of the drive.

These figures are those of a fit, not of an unseen motion: the second and third repeat were looked at while the model was chosen (relaxation at
rest, ripple left out at rest, order of the refusals).

*What came out otherwise than hoped:* half the error of the gain, Coulomb and viscous fit was the aim. It is reached on the elbow's moving rows
and nowhere else; over all rows the base is no better than that fit. Left on base and shoulder is ripple whose size depends on the
speed in a way that a speed loop of second order does not catch.

![Current of the three joints, measured and predicted](images/real_robot/current.png)

## What was identified

With 95 % intervals, widened by the residual's correlation. What this motion cannot tell is refused, with the reason, and stays
as configured.
"""]
    lines += table(["quantity", *JOINTS], values(results))
    lines += ["""
## Ripple

![Residual of the current by order of the joint angle](images/real_robot/spectrum.png)

## What this recording cannot show

No encoder on the other side of the gear, so no torsion; no temperature; no payload; a rigid-body torque that is the
controller's, whose errors of mass look like load. Time is a count of 8 ms, put together from three recordings: at the joins a
jolt of the controller stands in the rows, and counts.

## Runs

```sh"""]
    lines += commands + ["```", ""]
    with open(os.path.join(docs, "real_robot.md"), "w", encoding="utf-8") as file:
        file.write("\n".join(lines))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--tool", required=True)
    parser.add_argument("--docs", required=True)
    parser.add_argument("--telemetry", required=True)
    settings = parser.parse_args()
    path = os.path.join(settings.telemetry, RECORDING)
    if not os.path.isfile(path):
        print(f"skipped: no recording {RECORDING} in {settings.telemetry}; name its folder as argument or in "
              "$HJT_TELEMETRY_DIR")
        return 0
    images = os.path.join(settings.docs, "images", "real_robot")
    os.makedirs(images, exist_ok=True)
    data = np.genfromtxt(path, delimiter=",", names=True)
    with tempfile.TemporaryDirectory() as directory:
        os.symlink(os.path.abspath(path), os.path.join(directory, "ur5.csv"))
        runner = Runner(settings.tool, directory)
        results = examine(runner, "ur5.csv", data)
    draw_current(os.path.join(images, "current.png"), results)
    draw_spectrum(os.path.join(images, "spectrum.png"), results)
    write_page(settings.docs, results, data, runner.commands)
    for row in errors(results, data):
        print("  ".join(row))
    return 0


if __name__ == "__main__":
    sys.exit(main())
