#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draws two runs of `joint_twin arm`: angle and current of the elbow, and distance of the tool from its set point."""
import argparse

import numpy as np

from drawing import BLUE, RED, plt

ELBOW = 2


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    for name in ("SOUND.csv", "WORN.csv", "OUT.png"):
        parser.add_argument(name.split(".", maxsplit=1)[0].lower(), metavar=name)
    options = parser.parse_args()
    figure, axes = plt.subplots(3, 1, figsize=(8.0, 7.0), sharex=True, constrained_layout=True)
    runs = ((options.sound, BLUE, "sound"), (options.worn, RED, "old grease in the elbow"))
    for path, colour, label in runs:
        run = np.genfromtxt(path, delimiter=",", names=True)
        tool = [np.column_stack([run[f"{kind}_TCP_pose_{i}"] for i in range(3)]) for kind in ("target", "actual")]
        axes[0].plot(run["timestamp"], run[f"actual_q_{ELBOW}"], color=colour, label=label)
        axes[1].plot(run["timestamp"], run[f"actual_current_{ELBOW}"], color=colour, lw=0.8)
        axes[2].plot(run["timestamp"], 1e3 * np.linalg.norm(tool[1] - tool[0], axis=1), color=colour, lw=0.8)
    for axis, title in zip(axes, ("elbow, angle [rad]", "elbow, current [A]", "tool off its set point [mm]")):
        axis.set_title(title, loc="left", fontsize=10)
        axis.grid(alpha=0.3)
    axes[0].legend(loc="upper left", fontsize=9)
    axes[-1].set_xlabel("time [s]")
    figure.savefig(options.out, dpi=110)
    print(f"figure: {options.out}")


if __name__ == "__main__":
    main()
