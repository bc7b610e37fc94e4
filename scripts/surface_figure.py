#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draws docs/images/response_surface.png: one profile on the full ring and on the response surface.

The profile is open loop: speeding up, a load of 60 N.m, slowing down, brake, start. Torsion is the motor's angle over
the ratio less the output's.
"""
import argparse
import csv
import math
import os
import subprocess
import sys
import tempfile

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

CHECKOUT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
ARC_SECOND = math.pi / 180 / 3600
RATIO = 101
PROFILE = "time,motor_torque,load_torque,brake\n0,0.25,0,0\n0.2,0.8,60,0\n0.5,0.45,60,0\n0.8,0,60,1\n1.1,0.85,60,0\n"


def simulate(tool, directory, scene, more):
    """Rows of the run and the time it took."""
    out = os.path.join(directory, f"{scene}.csv")
    command = [tool, "simulate", "--profile", os.path.join(directory, "profile.csv"), "--duration", "1.3", "--out", out,
               "--set", f"solver.scene={scene}", "--set", "input.command_timeout=10.0", "--force"]
    begin = os.times().children_user
    subprocess.run(command + more, check=True)
    spent = os.times().children_user - begin
    with open(out) as file:
        return [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)], spent


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--tool", default=os.path.join(CHECKOUT, "build/devel/lib/harmonic_joint_twin/joint_twin"))
    parser.add_argument("--out", default=os.path.join(CHECKOUT, "docs/images/response_surface.png"))
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as directory:
        with open(os.path.join(directory, "profile.csv"), "w") as file:
            file.write(PROFILE)
        simulate(arguments.tool, directory, "auto", [])  # builds the surface where there is none yet
        full, full_time = simulate(arguments.tool, directory, "full_ring", [])
        auto, auto_time = simulate(arguments.tool, directory, "auto", [])
        no_cup = ["--set", "cup.friction_torque=0.0"]
        smooth_full, _ = simulate(arguments.tool, directory, "full_ring", no_cup)
        smooth_auto, _ = simulate(arguments.tool, directory, "auto", no_cup)

    def torsion(row):
        return (row["motor_angle"] / RATIO - row["output_angle"]) / ARC_SECOND

    moment = [row["time"] for row in full]
    figure, axes = plt.subplots(3, 1, figsize=(9, 7), sharex=True)
    axes[0].plot(moment, [row["motor_velocity"] for row in full], color="0.6", label="motor [rad/s]")
    axes[0].plot(moment, [row["joint_torque"] for row in full], label="joint torque [N.m]")
    axes[0].legend(loc="upper right")
    axes[1].plot(moment, [torsion(row) for row in full], color="0.6", linewidth=3, label="full ring")
    axes[1].plot(moment, [torsion(row) for row in auto], linewidth=1, label="surface")
    axes[1].set_ylabel("torsion [arcsec]")
    axes[1].legend(loc="upper right")
    axes[2].plot(moment, [torsion(a) - torsion(b) for a, b in zip(auto, full)], linewidth=0.8, label="as shipped")
    axes[2].plot(moment, [torsion(a) - torsion(b) for a, b in zip(smooth_auto, smooth_full)], linewidth=0.8,
                 label="without the cup's friction")
    axes[2].set_ylabel("surface less full ring,\ntorsion [arcsec]")
    axes[2].set_xlabel("time [s]")
    axes[2].legend(loc="upper right")
    for axis in axes:
        axis.grid(color="0.9")
    figure.tight_layout()
    figure.savefig(arguments.out, dpi=110)
    print(f"whole program, processor time: full ring {full_time:.2f} s, surface {auto_time:.2f} s", file=sys.stderr)


if __name__ == "__main__":
    main()
