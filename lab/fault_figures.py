# SPDX-License-Identifier: BSD-3-Clause
"""One figure for each kind of fault: healthy against faulty where it shows, sensors without error."""
import csv
import math
import subprocess
import sys

import h5py
import numpy

from lab import plt
from health_runs import RATIO, TOOTH, place_of

ARCSEC = math.pi / 180.0 / 3600.0
RATE = 1000.0
TURNS = 8                # of the motor in a spectrum
SWING_TIME = 12.0        # [s]

# What is shown, time of the run and of the begin of its record [s], speed, load. The step of the load at the start
# rings for seconds, at 66 Hz: beyond the orders shown at 10 degrees a second.
DUTIES = {
    "swing": ("30°/s, ±130 N·m once a turn of the joint", 14.1, 2.0, f"{{constant: {math.radians(30.0):.6f}}}",
              f"{{sinus: {{mean: 0.0, amplitude: 130.0, frequency: {1.0 / SWING_TIME:.9f}, phase: 0.0}}}}"),
    "steady": ("10°/s, 60 N·m", 10.0, 7.0, f"{{constant: {math.radians(10.0):.6f}}}", "{constant: 60.0}"),
    "speeds": ("no load", 22.0, 0.4,
               f"{{trapezoid: {{peak: {math.radians(150.0):.6f}, slope: {math.radians(15.0):.6f}, "
               f"hold: 1.0, pause: 1.0}}}}",
               "{constant: 0.0}"),
}


def plan(duty, classes):
    _, duration, start, speed, load = DUTIES[duty]
    return "\n".join([
        f"name: {duty}", "seed: 1", f"duration: {duration}", "set:", "  solver.scene: auto", "repeats: 1", "duty:",
        f"  - name: {duty}", f"    speed: {speed}", "    bandwidth: 8.0", f"    load: {load}", "classes:",
        "  healthy: []",
        *classes, "record:", "  format: hdf5", f"  start: {start}", "  deflate: 0", "  groups:",
        f"    signals: {{rate: {RATE}, type: float64, columns: [motor_angle, output_angle, motor_velocity, "
        f"motor_torque, "
        "load_torque]}"]) + "\n"


def record(tool, work, duty, kinds):
    """Signals of the healthy run and of each faulty one, by kind."""
    classes = [f"  {kind['kind']}:\n    - {{kind: {kind['kind']}, severity: 1.0, "
               f"place: {place_of(kind, TOOTH)}, onset: 0.0}}"
               for kind in kinds]
    path, out = work / f"figure_{duty}.yaml", work / f"figure_{duty}"
    path.write_text(plan(duty, classes))
    done = subprocess.run([tool, "sweep", path, "--out", out], check=False)
    if done.returncode not in (0, 1):
        sys.exit(f"fault_figures: the sweep of {path} ended with {done.returncode}")
    runs = {}
    with open(out / "index.csv", newline="", encoding="utf-8") as index:
        for row in csv.DictReader(index):
            if row["status"] == "ok":
                with h5py.File(out / row["file"], "r") as file:
                    runs[row["fault_kind"] or "healthy"] = {name: data[:] for name, data in file["signals"].items()}
    return runs


def torsion(run):
    return (run["motor_angle"] / RATIO - run["output_angle"]) / ARCSEC


def friction_torque(run):
    """At the motor [mN.m], with what speeds it up."""
    return 1e3 * (run["motor_torque"] - run["load_torque"] / RATIO)


def draw_loop(axis, run, **style):
    axis.plot(torsion(run), run["load_torque"], **style)


def draw_friction(axis, run, **style):
    axis.plot(run["motor_velocity"], friction_torque(run), **style)


def spectrum(run):
    """Amplitudes [arcsec] of the kinematic error over orders, cycles a turn of the motor."""
    even = numpy.arange(run["motor_angle"][0], run["motor_angle"][0] + TURNS * 2.0 * math.pi, 2.0 * math.pi / 256)
    error = numpy.interp(even, run["motor_angle"], torsion(run))
    window = numpy.hanning(len(even))
    amplitudes = 2.0 * numpy.abs(numpy.fft.rfft((error - error.mean()) * window)) / window.sum()
    return numpy.arange(len(amplitudes)) / TURNS, amplitudes


def draw_spectrum(axis, run, **style):
    orders, amplitudes = spectrum(run)
    shown = orders <= 16.0
    axis.plot(orders[shown], amplitudes[shown], **style)


def draw_turn(axis, run, **style):
    turns = (run["motor_angle"] - run["motor_angle"][0]) / (2.0 * math.pi)
    shown = turns <= 2.0
    axis.plot(turns[shown], torsion(run)[shown] - torsion(run)[shown].mean(), **style)


def loop_figures(run):
    """Of the first whole swing: slope within T1, width between the branches about no load."""
    shown = slice(0, int(SWING_TIME * RATE) + 1)
    twist, torque = ARCSEC * torsion(run)[shown], run["load_torque"][shown]
    straight, rising = numpy.abs(torque) < 14.0, numpy.gradient(torque) > 0.0
    slope = numpy.polyfit(torque[straight], twist[straight], 1)[0]
    offset = [numpy.mean((twist - slope * torque)[(numpy.abs(torque) < 2.7) & branch]) for branch in (rising, ~rising)]
    return (f"K1 {1e-3 / slope:.1f} kN.m/rad, width of the loop {(offset[1] - offset[0]) / ARCSEC:.1f} arcsec, "
            f"loop {1e3 * abs(numpy.trapz(torque, twist)):.1f} mJ, twist {numpy.ptp(twist) / ARCSEC:.0f} arcsec, "
            f"friction {friction_torque(run)[shown].mean():.0f} mN.m")


def friction_figures(run):
    speeds, friction = run["motor_velocity"], friction_torque(run)
    near = {degrees: numpy.abs(speeds - RATIO * math.radians(degrees)) < 1.0 for degrees in (15, 45, 90, 150)}
    return ", ".join(f"{friction[rows].mean():.0f} mN.m at {degrees} deg/s" for degrees, rows in near.items())


def line_figures(run):
    orders, amplitudes = spectrum(run)
    peaks = [i for i in range(1, len(orders) - 1) if orders[i] <= 16.0 and
             amplitudes[i] == amplitudes[i - 1:i + 2].max()]
    highest = sorted(sorted(peaks, key=lambda i: -amplitudes[i])[:6])
    return (", ".join(f"{amplitudes[i]:.3f} arcsec at {orders[i]:g}" for i in highest)
            + f"; peak to peak {numpy.ptp(torsion(run)):.1f} arcsec, friction {friction_torque(run).mean():.0f} mN.m")


FIGURES = {"swing": loop_figures, "speeds": friction_figures, "steady": line_figures}
VIEWS = {draw_loop: ("swing", "torsion [″]", "torque [N·m]"),
         draw_friction: ("speeds", "motor speed [rad/s]", "motor torque less load [mN·m]"),
         draw_spectrum: ("steady", "cycles a turn of the motor", "kinematic error [″]"),
         draw_turn: ("steady", "turns of the motor", "kinematic error [″]")}
SHOWN = {"interface_wear": draw_loop, "rear_section_crack": draw_loop, "lubricant_degradation": draw_friction,
         "tooth_wear": draw_loop, "flange_crack": draw_loop, "wave_generator_wear": draw_loop, "buckling": draw_loop,
         "ratcheting": draw_turn}  # the others: draw_spectrum


def draw_all(tool, work, kinds, images):
    images.mkdir(parents=True, exist_ok=True)
    by_duty = {}
    for kind in kinds:
        view = SHOWN.get(kind["kind"], draw_spectrum)
        by_duty.setdefault(VIEWS[view][0], []).append((kind, view))
    for duty, shown in by_duty.items():
        runs = record(tool, work, duty, [kind for kind, _ in shown])
        for name, run in runs.items():
            print(f"fault_figures: {duty}: {name}: {FIGURES[duty](run)}", file=sys.stderr)
        for kind, view in shown:
            name = kind["kind"]
            figure, axis = plt.subplots(figsize=(5.0, 2.9), constrained_layout=True)
            if name in runs:
                view(axis, runs[name], color="C3", linewidth=1.1, label=f"{name}, severity 1")
            view(axis, runs["healthy"], color="C0", linewidth=1.1, label="healthy")
            axis.set_xlabel(VIEWS[view][1])
            axis.set_ylabel(VIEWS[view][2])
            axis.set_title(DUTIES[duty][0], loc="right", fontsize=8)
            axis.grid(alpha=0.3)
            axis.legend(frameon=False, fontsize=8)
            figure.savefig(images / f"{name}.png", dpi=80)
            plt.close(figure)
