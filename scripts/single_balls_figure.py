#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draws docs/images/single_balls.png: the ball-pass line of a sound drive, and the loads of its bearing's balls.

The output's error comes from `joint_twin turn`, friction left out, over whole turns of the balls past the lobes; the
loads from `joint_twin stiffness`.
"""
import argparse
import json
import os
import subprocess

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

CHECKOUT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
SUPPORT = "contact.support=single_balls"
LOADS = (14.0, 67.0, 150.0)
TURNS = 20
STEPS = 500  # a turn
ARCSECOND = np.pi / 180.0 / 3600.0


def run(tool, options, *words):
    out = subprocess.run([tool, *words, "--json", *options], check=True, stdout=subprocess.PIPE).stdout
    return json.loads(out)["rows"]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--tool", default=os.path.join(CHECKOUT, "build/devel/lib/harmonic_joint_twin/joint_twin"))
    parser.add_argument("--out", default=os.path.join(CHECKOUT, "docs/images/single_balls.png"))
    parser.add_argument("--config", action="append", default=[], metavar="FILE", help="overlay")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="further parameters")
    arguments = parser.parse_args()
    tool = arguments.tool
    settings = [word for overlay in arguments.config for word in ("--config", overlay)]
    settings += [word for setting in (SUPPORT, *arguments.set) for word in ("--set", setting)]

    figure, axes = plt.subplots(1, 2, figsize=(10, 3.6))
    highest = 0.0
    for load, colour, front in zip(LOADS, ("tab:green", "tab:blue", "tab:red"), (3, 1, 2)):
        turned = run(tool, settings, "turn", "--load", str(load), "--angle-range", str(2.0 * np.pi * TURNS),
                     "--steps", str(TURNS * STEPS))
        error = np.array([row["kinematic_error"] for row in turned[:-1]]) / ARCSECOND
        window = np.hanning(error.size)
        spectrum = 2.0 * np.abs(np.fft.rfft((error - error.mean()) * window)) / window.sum()
        order = np.arange(spectrum.size) / TURNS
        axes[0].plot(order, spectrum, color=colour, lw=1.2, zorder=front,
                     label=f"{load:g} N.m")
        low = order < 60.0
        highest = max(highest, spectrum[low].max())
        strongest = np.argmax(np.where(low, spectrum, 0.0))
        print(f"{load:g} N.m: strongest line below order 60 at {order[strongest]:.2f} a motor turn, "
              f"{2.0 * spectrum[strongest]:.3f} arcsec peak to peak; all {np.ptp(error):.3f} arcsec")
        force = run(tool, settings, "stiffness", "--torques", str(load))[0]["ball_force"]
        axes[1].plot(range(len(force)), force, "o-", ms=3, lw=0.9, color=colour, label=f"{load:g} N.m")
        print(f"{load:g} N.m: hardest ball {max(force):.0f} N, {sum(f > 0.0 for f in force)} balls carry, "
              f"{sum(force):.0f} N in all")
    axes[0].set_xlim(0.0, 60.0)
    axes[0].set_ylim(top=1.2 * highest)
    axes[0].set_title("error of the output [arcsec]")
    axes[0].set_xlabel("order [per motor turn]")
    axes[1].set_title("force on a ball [N]")
    axes[1].set_xlabel("ball, from the major axis on")
    for axis in axes:
        axis.set_ylim(bottom=0.0)
        axis.grid(color="0.9")
        axis.legend()
    figure.tight_layout()
    figure.savefig(arguments.out, dpi=110)


if __name__ == "__main__":
    main()
