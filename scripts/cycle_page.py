# SPDX-License-Identifier: BSD-3-Clause
"""Times the twin's whole cycle with `joint_cycle_benchmark`, every scene on the full ring and on the response surface,
and writes the table and the figure of it into docs/performance.md."""
import argparse
import json
import os
import pathlib
import subprocess
import sys

import matplotlib
import yaml

import page_section

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (after the choice of its backend)

SURFACE = "surface: "
STEP = 100.0   # [us] at 10 kHz
WANTED = {"full ring": 10.0, "response surface": 0.1}  # [us] a step


def settings(path):
    """An overlay as `--set` takes it, numbers without an exponent."""
    for section, keys in yaml.safe_load(path.read_text()).items():
        for key, value in keys.items():
            text = f"[{', '.join(f'{number:.9f}' for number in value)}]" if isinstance(value, list) else f"{value:.9f}"
            yield f"{section}.{key}={text}"


def measure(options, *arguments):
    done = subprocess.run([options.tool, "--json", "--processor-time", "--duration", str(options.duration), *arguments],
                          capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"performance: {' '.join(map(str, done.args))} failed:\n{done.stderr}")
    return json.loads(done.stdout)


def rows(options):
    gears = {"shipped": [], "as built": [argument for setting in settings(options.config / "as_built.yaml")
                                         for argument in ("--set", setting)]}
    for gear, arguments in gears.items():
        print(f"performance: {gear}", file=sys.stderr)
        for row in measure(options, *(["--watch", "teeth"] if gear != "shipped" else []), *arguments):
            yield {**row, "gear": gear, "joints": 1}
    print("performance: six joints", file=sys.stderr)
    for row in measure(options, "--joints", "6"):
        yield {**row, "gear": "shipped", "joints": 6}


def table(measured):
    lines = ["| gear | joints | scene, 10 kHz | solved by | median [µs] | p99.9 [µs] | times real time, one core | "
             "Newton iterations "
             "| allocations |", "|---|---|---|---|---|---|---|---|---|"]
    for row in measured:
        fast = row["scene"].startswith(SURFACE)
        lines.append(f"| {row['gear']} | {row['joints']} | {row['scene'][len(SURFACE):] if fast else row['scene']} "
                     f"| {'response surface' if fast else 'full ring'} | {row['median_us']:.3g} | {row['p999_us']:.3g} "
                     f"| {row['one_core_factor']:.3g} | {row['iterations']:.2f} | {row['allocations']} |")
    return lines


def draw(measured, path):
    single = [row for row in measured if row["joints"] == 1]
    figure, axis = plt.subplots(figsize=(9, 4.8), constrained_layout=True)
    for place, row in enumerate(reversed(single)):
        fast = row["scene"].startswith(SURFACE)
        axis.plot([row["median_us"], row["p999_us"]], [place, place], "C0" if fast else "C3", linewidth=1)
        axis.plot(row["median_us"], place, "o", color="C0" if fast else "C3", markersize=5)
        axis.plot(row["p999_us"], place, "|", color="C0" if fast else "C3", markersize=9)
    axis.set_yticks(range(len(single)), [f"{row['scene']}, {row['gear']}" for row in reversed(single)], fontsize=8)
    for name, limit in WANTED.items():
        axis.axvline(limit, color="k", linestyle=":", linewidth=0.8)
        axis.text(limit, len(single) - 0.3, f" wanted, {name}", fontsize=7, va="bottom")
    axis.axvline(STEP, color="k", linewidth=0.8)
    axis.text(STEP, len(single) - 0.3, " real time", fontsize=7, va="bottom")
    axis.set_xscale("log")
    axis.set_ylim(-0.7, len(single) + 0.5)
    axis.set_xlabel("processor time of one step at 10 kHz [µs]: median (dot) to p99.9 (bar)")
    axis.grid(alpha=0.3, axis="x")
    figure.savefig(path, dpi=110)
    plt.close(figure)


def main():
    parser = argparse.ArgumentParser(prog="performance", description=__doc__)
    parser.add_argument("--tool", type=pathlib.Path, required=True, help=argparse.SUPPRESS)
    parser.add_argument("--config", type=pathlib.Path, required=True, help=argparse.SUPPRESS)
    parser.add_argument("--docs", type=pathlib.Path, required=True, help="folder that holds performance.md")
    parser.add_argument("--duration", type=float, default=1.0, help="simulated time of a scene [1 s]")
    parser.add_argument("--no-node", action="store_true", help="leave the live node's jitter out")
    options = parser.parse_args()
    load = os.getloadavg()[0]
    measured = list(rows(options))
    draw(measured, options.docs / "images" / "cycle.png")
    page_section.write(options.docs / "performance.md", "cycle", [
        *table(measured), "", "![Time of one step in every scene, and the target](images/cycle.png)", "",
        f"`scripts/performance`: {options.duration:g} s simulated a scene, twenty times that on the surface; load "
        f"average before it "
        f"{load:.1f}."])
    print(f"performance: wrote {options.docs / 'performance.md'}", file=sys.stderr)


if __name__ == "__main__":
    main()
