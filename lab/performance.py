# SPDX-License-Identifier: BSD-3-Clause
"""Times the twin's whole cycle with `joint_cycle_benchmark`, every scene on the full ring and on the response surface,
and each option against the shipped gear; writes the tables and the figure into docs/performance.md."""
import argparse
import json
import os
import pathlib
import statistics
import subprocess
import sys

import numpy as np
import yaml

import harmonic_joint_twin as hjt
import lab
from lab import plt

SURFACE = "surface: "
STEP = 100.0   # [us] at 10 kHz
WANTED = {"full ring": 10.0, "response surface": 0.1}  # [us] a step
OPTIONS = {
    "straight flanks": ["mesh.profile=trapezoid"],
    "springs under the rim": ["contact.support=springs"],
    "single balls": ["contact.support=single_balls"],
    "one Coulomb element in the cup": ["cup.friction_angle=0"],
    "loss of the bending rim": ["ring.loss_factor=0.05"],
    "dry friction of the output": ["output.coulomb_torque=5", "output.tilting_moment=100",
                                   "output.tilting_friction=0.002"],
    "Stribeck curve and presliding at the shaft": ["motor.stribeck_torque=0.02", "motor.presliding_angle=0.01"],
    "current loop, ripple, cogging, hot magnets": ["motor.current_bandwidth=500", "motor.torque_ripple=0.01",
                                                   "motor.cogging_torque=0.01",
                                                   "motor.torque_temperature_coefficient=-0.001"],
    "brake with play": ["brake.play=0.1", "brake.delay=0.02"],
    "heat in two nodes": ["thermal.model=two_nodes"],
    "run-out of the flexspline": ["manufacture.flexspline_eccentricity=[0.000005, 0]"],
}
ALTERNATIONS = 5
TIME = np.arange(200) / 1000.0  # [s]
LOAD = 10.0                     # [N.m]
MOTIONS = {"motor torque from 0 to 0.35 N·m and back to 0; motion one way": 0.35 * np.sin(np.pi * TIME / TIME[-1]) ** 2,
           "motor torque ±0.45 N·m, 10 Hz; motion there and back": 0.45 * np.sin(2.0 * np.pi * 10.0 * TIME)}
RATES, FINEST = (5000, 10000, 20000, 40000), 160000  # [Hz]
STANDING = "standstill"


def settings(path):
    """An overlay as `--set` takes it, numbers without an exponent."""
    for section, keys in yaml.safe_load(path.read_text()).items():
        for key, value in keys.items():
            if isinstance(value, list):
                text = f"[{', '.join(f'{number:.9f}' for number in value)}]"
            else:
                text = value if isinstance(value, str) else f"{value:.9f}"
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


def moving_times(options, arguments):
    """Median time of a step [us] in each scene that moves."""
    short = argparse.Namespace(**{**vars(options), "duration": options.duration / 10})
    return [row["median_us"] for row in measure(short, "--watch", "teeth", *arguments)
            if not row["scene"].startswith(STANDING)]


def option_rows(options):
    """Time of a step over that of the shipped gear: median over the scenes and over alternating runs."""
    cases = {name: [argument for setting in chosen for argument in ("--set", setting)]
             for name, chosen in OPTIONS.items()}
    cases["all of `config/golden.yaml`"] = [argument for setting in settings(options.config / "golden.yaml")
                                            for argument in ("--set", setting)]
    for name, arguments in cases.items():
        print(f"performance: {name}", file=sys.stderr)
        ratios = []
        for _ in range(ALTERNATIONS):
            shipped = moving_times(options, [])
            ratios += [with_it / without for with_it, without in zip(moving_times(options, arguments), shipped)]
        chosen = ", ".join(f"`{setting}`" for setting in OPTIONS.get(name, [])) or "overlay"
        yield f"| {name} | {chosen} | {statistics.median(ratios):.2f} |"


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


def motor_angle(scene, rate, torque):
    """At each millisecond [rad], the torque held in between."""
    steps = rate // 1000
    twin = hjt.Twin(hjt.Parameters({"solver.rate": float(rate), "solver.scene": scene,
                                    "indicators.sample_rate": 1000.0}))
    return twin.run(motor_torque=np.repeat(torque, steps), load_torque=LOAD, every=steps)["motor_angle"]


def rate_rows():
    """Largest error of the motor's angle [urad] by rate, on the full ring and on the response surface."""
    for name, torque in MOTIONS.items():
        cells = {rate: [] for rate in RATES}
        for scene in ("full_ring", "auto"):
            finest = motor_angle(scene, FINEST, torque)
            for rate in RATES:
                error = np.abs(motor_angle(scene, rate, torque) - finest).max()
                cells[rate].append(f"{1e6 * error:.0f}")
        yield f"| {name} | " + " | ".join(" / ".join(cell) for cell in cells.values()) + " |"


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
    axis.set(xscale="log", ylim=(-0.7, len(single) + 0.5),
             xlabel="processor time of one step at 10 kHz [µs]: median (dot) to p99.9 (bar)")
    axis.grid(alpha=0.3, axis="x")
    figure.savefig(path, dpi=110)
    plt.close(figure)


def main():
    parser = argparse.ArgumentParser(prog="performance", description=__doc__)
    parser.add_argument("--tool", type=pathlib.Path, required=True, help=argparse.SUPPRESS)
    parser.add_argument("--config", type=pathlib.Path, required=True, help=argparse.SUPPRESS)
    parser.add_argument("--docs", type=pathlib.Path, required=True, help="folder that holds performance.md")
    parser.add_argument("--duration", type=float, default=1.0, help="simulated time of a scene [1 s]")
    options = parser.parse_args()
    load = os.getloadavg()[0]
    measured = list(rows(options))
    draw(measured, options.docs / "images" / "cycle.png")
    lab.write(options.docs / "performance.md", "cycle", [
        *table(measured), "", "![Time of one step in every scene, and the target](images/cycle.png)", "",
        f"`lab/run performance` simulates {options.duration:g} s of each scene on the full ring, and "
        f"{20 * options.duration:g} s on the surface. "
        f"The load average before the run was {load:.1f}."])
    lab.write(options.docs / "performance.md", "options", [
        "| option | set | time of a step over the shipped gear's |", "|---|---|---|", *option_rows(options), "",
        f"`lab/run performance` measures steps on the full ring with all tooth forces, in scenes with motion. The "
        f"values are medians of {ALTERNATIONS} alternating runs."])
    lab.write(options.docs / "performance.md", "rates", [
        "| `solver.rate` | " + " | ".join(f"{rate / 1000:g} kHz" for rate in RATES) + " |",
        "|---" * (1 + len(RATES)) + "|", *rate_rows()])
    print(f"performance: wrote {options.docs / 'performance.md'}", file=sys.stderr)


if __name__ == "__main__":
    main()
