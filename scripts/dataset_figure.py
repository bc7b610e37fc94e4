#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Reads a data set of `joint_twin sweep` and draws one column of some of its runs.

  dataset_figure.py DIR --group signals --column motor_torque_reading --label fault_severity --out figure.png
"""
import argparse
import csv
import os

import h5py
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (the backend comes first)


def read_index(directory):
    """The rows of the index whose runs went through."""
    with open(os.path.join(directory, "index.csv"), newline="") as file:
        return [row for row in csv.DictReader(file) if row["status"] == "ok"]


def read_column(directory, row, group, column):
    """(time [s], values, unit) of one run."""
    with h5py.File(os.path.join(directory, row["file"]), "r") as file:
        data = file[group][column]
        return file[group]["time"][:], data[:], data.attrs["unit"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("directory")
    parser.add_argument("--group", required=True)
    parser.add_argument("--column", required=True)
    parser.add_argument("--label", required=True, help="column of the index that names the curves")
    parser.add_argument("--select", action="append", default=[], metavar="COLUMN=VALUE",
                        help="of the index; repeatable")
    parser.add_argument("--until", type=float, help="last instant drawn [s]")
    parser.add_argument("--out", required=True)
    arguments = parser.parse_args()

    rows = read_index(arguments.directory)
    for selection in arguments.select:
        column, value = selection.split("=", 1)
        rows = [row for row in rows if row[column] == value]
    figure, axes = plt.subplots(figsize=(9.0, 3.6), constrained_layout=True)
    for row in rows:
        time, values, unit = read_column(arguments.directory, row, arguments.group, arguments.column)
        axes.plot(time, values, linewidth=0.9, label=row[arguments.label] or "none")
    axes.set_xlabel("time [s]")
    axes.set_ylabel(f"{arguments.column} [{unit}]")
    axes.set_xlim(right=arguments.until)
    axes.grid(linewidth=0.4)
    axes.legend(title=arguments.label, fontsize="small", loc="upper left", bbox_to_anchor=(1.01, 1.0))
    figure.savefig(arguments.out, dpi=110)


if __name__ == "__main__":
    main()
