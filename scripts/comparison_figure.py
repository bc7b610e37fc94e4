#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draws what `joint_twin follow --out` wrote: measured and predicted, the current's band, what the joint gives and
bears.

  comparison_figure.py FOLLOW.csv --out figure.png
"""
import argparse

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (the backend comes first)
import numpy  # noqa: E402

GREY, BLUE, RED = "0.45", "#1f5fa8", "#b5302a"


def draw_pair(axes, rows, quantity, unit):
    axes.plot(rows["time"], rows[f"{quantity}_measured"], color=GREY, lw=1.8, label="measured")
    axes.plot(rows["time"], rows[f"{quantity}_predicted"], color=BLUE, lw=0.8, label="healthy twin")
    axes.set_ylabel(f"{quantity} [{unit}]")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("rows")
    parser.add_argument("--begin", type=float, default=-numpy.inf, help="first instant drawn [s]")
    parser.add_argument("--end", type=float, default=numpy.inf, help="last instant drawn [s]")
    parser.add_argument("--out", required=True)
    arguments = parser.parse_args()

    rows = numpy.genfromtxt(arguments.rows, delimiter=",", names=True)
    rows = rows[(rows["time"] >= arguments.begin) & (rows["time"] <= arguments.end)]
    figure, all_axes = plt.subplots(4, 1, figsize=(9.0, 8.6), sharex=True, constrained_layout=True)
    draw_pair(all_axes[0], rows, "position", "rad")
    draw_pair(all_axes[1], rows, "velocity", "rad/s")
    predicted, band = rows["current_predicted"], rows["current_band"]
    all_axes[2].fill_between(rows["time"], predicted - band, predicted + band, color=BLUE, alpha=0.15, lw=0,
                             label="band of a healthy joint")
    draw_pair(all_axes[2], rows, "current", "A")
    all_axes[3].plot(rows["time"], rows["joint_torque"], color=GREY, lw=1.2, label="joint, net of friction")
    all_axes[3].plot(rows["time"], rows["load_torque"], color=BLUE, lw=0.8, label="load")
    all_axes[3].plot(rows["time"], rows["residual_torque"], color=RED, lw=0.8, label="residual of the current")
    all_axes[3].set_ylabel("torque [N·m]")
    all_axes[3].set_xlabel("time [s]")
    for axes in all_axes[[0, 2, 3]]:
        axes.legend(fontsize="small", loc="upper right", ncol=3)
    for axes in all_axes:
        axes.grid(linewidth=0.4)
    figure.savefig(arguments.out, dpi=110)


if __name__ == "__main__":
    main()
