#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draws docs/images/warm_up.png: an elbow turns for two hours from a cold start and stands for one more.

The drive holds the speed at its limit, 1 rad/s at the joint; nothing hangs on the output. Then the brake holds.
"""
import argparse
import csv
import os
import subprocess
import sys
import tempfile

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

CHECKOUT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
RATIO = 101
TORQUE_PER_CURRENT = 10.7  # N.m/A at the joint
BLOCK = 200  # rows
PROFILE = "time,motor_torque,brake\n0,0.6,0\n7200,0,1\n10800,0,1\n"
OPTIONS = {"thermal.model": "two_nodes", "solver.scene": "auto", "solver.rate": "2000", "motor.speed_limit": "103.0",
           "output.gravity_torque": "0.0", "input.command_timeout": "20000.0", "publish.joint_states_rate": "10.0",
           "publish.encoders_rate": "1.0", "publish.contact_forces_rate": "1.0"}


def simulate(tool, directory):
    """Columns of the run, means over 20 s: the current has ripple."""
    profile, out = (os.path.join(directory, name) for name in ("profile.csv", "run.csv"))
    with open(profile, "w", encoding="utf-8") as file:
        file.write(PROFILE)
    settings = [word for key, value in OPTIONS.items() for word in ("--set", f"{key}={value}")]
    subprocess.run([tool, "simulate", "--profile", profile, "--config", "joints/elbow.yaml", *settings, "--out", out],
                   check=True, stdout=sys.stderr)
    with open(out, encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    means = range(0, len(rows) - BLOCK + 1, BLOCK)
    return {key: [sum(float(row[key]) for row in rows[k:k + BLOCK]) / BLOCK for k in means] for key in rows[0]}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--tool", default=os.path.join(CHECKOUT, "build/devel/lib/harmonic_joint_twin/joint_twin"))
    parser.add_argument("--out", default=os.path.join(CHECKOUT, "docs/images/warm_up.png"))
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as directory:
        run = simulate(arguments.tool, directory)

    moment = [time / 60.0 for time in run["time"]]
    turning = [k for k, brake in enumerate(run["brake"]) if brake == 0.0]
    figure, axes = plt.subplots(1, 3, figsize=(10, 3.2))
    axes[0].plot(moment, run["temperature"], label="grease")
    axes[0].plot(moment, run["housing_temperature"], label="housing")
    axes[0].set_title("temperature [°C]")
    axes[0].legend()
    axes[1].plot([moment[k] for k in turning], [RATIO * run["friction_torque"][k] for k in turning])
    axes[1].set_title("friction at the joint [N.m]")
    axes[2].plot([moment[k] for k in turning],
                 [RATIO * run["motor_torque"][k] / TORQUE_PER_CURRENT for k in turning])
    axes[2].set_title("motor current [A]")
    for axis in axes[1:]:
        axis.set_ylim(bottom=0.0)
    for axis in axes:
        axis.set_xlabel("time [min]")
        axis.grid(color="0.9")
    figure.tight_layout()
    figure.savefig(arguments.out, dpi=110)
    first, last = turning[0], turning[-1]
    print(f"friction {RATIO * run['friction_torque'][first]:.2f} to {RATIO * run['friction_torque'][last]:.2f} N.m, "
          f"grease {run['temperature'][first]:.1f} to {run['temperature'][last]:.1f} degC, housing "
          f"{run['housing_temperature'][last]:.1f} degC")


if __name__ == "__main__":
    main()
