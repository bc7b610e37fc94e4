# SPDX-License-Identifier: BSD-3-Clause
"""What the coupling of an arm's drives costs and how far off it is, for lab/run arm_coupling: rows of
bench/arm_coupling.cpp as a section of docs/arm_twin.md, docs/arm_coupling.csv and a figure."""
import argparse
import csv
import pathlib
import subprocess

import matplotlib.ticker

import lab
from lab import BLUE, GREEN, RED, plt

ORDERS = {0: "held", 1: "linear, as shipped", 2: "quadratic"}
COLOURS = {0: RED, 1: BLUE, 2: GREEN}
RATE = 10e3            # of the steps [Hz]
SHIPPED = 1            # order


def rows_of(bench, config, what):
    done = subprocess.run([bench, config, what], stdout=subprocess.PIPE, universal_newlines=True, check=True)
    return [{name: float(value) for name, value in row.items()} for row in csv.DictReader(done.stdout.splitlines())]


def draw(path, rows):
    drawing, all_axes = plt.subplots(1, 2, figsize=(9.0, 3.8), constrained_layout=True)
    for axes, column, scale, title in zip(all_axes, ("energy_error", "angle_error"), (1e3, 1e6),
                                          ("error of the arm's energy, largest [mJ]",
                                           "angle, from a quarter of the step, largest [µrad]")):
        for order, label in ORDERS.items():
            part = [row for row in rows if row["order"] == order]
            axes.plot([1e3 * row["cost"] for row in part], [scale * row[column] for row in part], "o-",
                      color=COLOURS[order], lw=1.0, ms=4, label=label)
        axes.set_yscale("log")
        axes.margins(0.12)
        axes.set_ylim(*((10.0, 1000.0) if column == "angle_error" else (None, None)))
        axes.set_xlabel("processor time for a second of the arm [ms]")
        axes.set_title(title, fontsize=10)
        axes.grid(alpha=0.3)
        axes.yaxis.set_minor_formatter(matplotlib.ticker.NullFormatter())
    for row in rows:
        if row["order"] == SHIPPED:
            all_axes[0].annotate(f"{row['mass_rate']:g} Hz", (1e3 * row["cost"], 1e3 * row["energy_error"]), fontsize=7,
                                 xytext=(3, 4), textcoords="offset points")
    all_axes[0].legend(title="torques of the other drives", fontsize=8, title_fontsize=8)
    drawing.savefig(path, dpi=110)
    plt.close(drawing)


def write_table(path, rows):
    with open(path, "w", encoding="utf-8", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["mass_matrix_rate_hz", "torques", "cost_ms", "energy_error_mj", "angle_error_urad"])
        for row in sorted(rows, key=lambda row: (-row["mass_rate"], row["order"])):
            table.writerow([f"{row['mass_rate']:g}", ORDERS[row["order"]].split(",")[0], f"{1e3 * row['cost']:.0f}",
                            f"{1e3 * row['energy_error']:.2g}", f"{1e6 * row['angle_error']:.2g}"])


def speed_table(rows):
    names = {0: "six drives on response surfaces", 1: "five on surfaces, the elbow on its full ring",
             3: "three wrists on surfaces, three large joints on full rings", 6: "six full rings"}
    return ["| drives of the arm | speed [times real time] | processor time of a step [µs] |", "|---|---|---|",
            *(f"| {names[int(row['rings'])]} | {1.0 / row['cost']:.{0 if row['cost'] < 0.1 else 1}f} | "
              f"{1e6 * row['cost'] / RATE:.1f} |" for row in rows)]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--bench", required=True)
    parser.add_argument("--config", required=True)
    parser.add_argument("--docs", required=True, type=pathlib.Path)
    options = parser.parse_args()
    speeds = speed_table(rows_of(options.bench, options.config, "scenes"))
    lab.write(options.docs / "arm_twin.md", "arm_speed", speeds)
    rows = rows_of(options.bench, options.config, "coupling")
    draw(options.docs / "images" / "arm_twin" / "coupling.png", rows)
    write_table(options.docs / "arm_coupling.csv", rows)
    print("\n".join(speeds))


if __name__ == "__main__":
    main()
