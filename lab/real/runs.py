# SPDX-License-Identifier: BSD-3-Clause
"""What the sections of docs/real_robot.md share: runs of the tool, tables, figures."""
import csv
import glob
import json
import os
import subprocess
import time

import numpy as np
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (the backend is chosen before pyplot is loaded)

GREY, BLUE, RED, GREEN = "0.6", "#0072B2", "#D55E00", "#009E73"


class Runner:
    """Runs `joint_twin` in one directory and keeps the commands."""

    def __init__(self, tool, directory):
        self.tool, self.directory, self.commands = tool, directory, []
        self.begin = time.monotonic()

    def path(self, name):
        return os.path.join(self.directory, name)

    def link(self, folder, train):
        """Names of a robot's recordings, FOLDER_NAME.csv in its folder, which stand in the directory as NAME.csv from
        now on. None, and says so, where `train` or any other is missing."""
        prefix = os.path.basename(folder) + "_"
        paths = {os.path.basename(path)[len(prefix):-len(".csv")]: path
                 for path in sorted(glob.glob(os.path.join(folder, f"{prefix}*.csv")))}
        if train not in paths or len(paths) < 2:
            print(f"skipped: no {prefix}{train}.csv and others in {folder}")
            return []
        for name, path in paths.items():
            os.symlink(os.path.abspath(path), self.path(f"{name}.csv"))
        return list(paths)

    def run(self, *arguments, listed=True):
        """Not `listed`: of files that are made here, so the page leaves it out."""
        command = " ".join(["joint_twin", *map(str, arguments)])
        print(f"{time.monotonic() - self.begin:5.0f} s  {command}", flush=True)
        self.commands += [command] if listed else []
        done = subprocess.run([self.tool, *map(str, arguments)], cwd=self.directory, stdout=subprocess.PIPE,
                              universal_newlines=True, check=True)
        return json.loads(done.stdout) if "--json" in arguments else None


def read(path):
    return np.genfromtxt(path, delimiter=",", names=True)


def rms(values):
    return float(np.sqrt(np.mean(np.square(values))))


def write_rows(path, head, rows):
    """A CSV file: numbers to four digits, empty where there is none."""
    with open(path, "w", encoding="utf-8", newline="") as file:
        lines = csv.writer(file, lineterminator="\n")
        lines.writerow(head)
        for row in rows:
            lines.writerow([cell if isinstance(cell, str) else "" if np.isnan(cell) else f"{cell:.4g}" for cell in row])


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return lines + ["| " + " | ".join(row) + " |" for row in rows] + [""]


def regress(columns, values):
    """Least squares: coefficients, half widths of their 95 % intervals (widened by the residual's correlation),
    residual."""
    coefficients = np.linalg.lstsq(columns, values, rcond=None)[0]
    residual = values - columns @ coefficients
    correlation = 1.0
    for lag in range(1, len(residual) // 4):
        share = residual[lag:] @ residual[:-lag] / (residual @ residual)
        if share <= 0.0:
            break
        correlation += 2.0 * share
    variance = residual @ residual / (len(values) - len(coefficients)) * correlation
    return coefficients, 1.96 * np.sqrt(variance * np.diag(np.linalg.inv(columns.T @ columns))), residual


def figure(rows, columns, size, **options):
    return plt.subplots(rows, columns, figsize=size, constrained_layout=True, **options)


def save(drawing, path):
    drawing.savefig(path, dpi=110)
    plt.close(drawing)
