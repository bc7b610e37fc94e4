#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draws docs/images/hysteresis.png: torsion loops of the running twin at four amplitudes of the load.

The brake holds the motor, the load swings slowly. Left with the whole friction of the cup at once (cup.friction_angle =
0), right with its springs and sliders as shipped; the load swings once before, so that the loops are closed.
"""
import argparse
import csv
import math
import os
import subprocess
import tempfile

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

CHECKOUT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
AMPLITUDES = (2.0, 5.0, 14.0, 67.0)  # N.m
PERIOD = 2.0  # s
ROWS = 4000  # of the load, a swing


def loop(tool, directory, amplitude, more):
    """Load [N.m] and torsion [mrad] over a swing, and the energy lost in it [mJ]."""
    profile, out = os.path.join(directory, "profile.csv"), os.path.join(directory, "run.csv")
    with open(profile, "w") as file:
        file.write("time,motor_torque,load_torque,brake\n")
        for i in range(int(1.5 * ROWS) + 1):
            file.write(f"{i * PERIOD / ROWS},0,{amplitude * math.sin(2.0 * math.pi * i / ROWS)},1\n")
    subprocess.run([tool, "simulate", "--profile", profile, "--duration", str(1.5 * PERIOD), "--out", out, "--force",
                    "--set", "input.command_timeout=10.0", "--set", "output.load_inertia=0.3"] + more, check=True,
                   stdout=subprocess.DEVNULL)
    with open(out) as file:
        rows = [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]
    rows = [row for row in rows if row["time"] > 0.5 * PERIOD]
    load = [row["load_torque"] for row in rows]
    torsion = [-1e3 * row["output_angle"] for row in rows]
    area = sum(0.5 * (a + b) * (y - x) for a, b, x, y in zip(load, load[1:], torsion, torsion[1:]))
    return load, torsion, area


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--tool", default=os.path.join(CHECKOUT, "build/devel/lib/harmonic_joint_twin/joint_twin"))
    parser.add_argument("--out", default=os.path.join(CHECKOUT, "docs/images/hysteresis.png"))
    arguments = parser.parse_args()
    figure, axes = plt.subplots(2, 4, figsize=(11, 5.6), sharex="col", sharey="col")
    with tempfile.TemporaryDirectory() as directory:
        for row, (name, more) in zip(axes, (("one Coulomb element", ["--set", "cup.friction_angle=0.0"]),
                                            ("springs and sliders", []))):
            for axis, amplitude in zip(row, AMPLITUDES):
                load, torsion, area = loop(arguments.tool, directory, amplitude, more)
                axis.plot(load, torsion, linewidth=1)
                axis.set_title(f"± {amplitude:g} N·m: {1e3 * area:.0f} µJ a swing", fontsize=9)
                axis.grid(color="0.9")
            row[0].set_ylabel(f"{name}\ntorsion [mrad]")
    for axis in axes[1]:
        axis.set_xlabel("load [N·m]")
    figure.tight_layout()
    figure.savefig(arguments.out, dpi=110)


if __name__ == "__main__":
    main()
