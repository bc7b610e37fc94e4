# SPDX-License-Identifier: BSD-3-Clause
"""Runs of the drive that the bound of detection is made of."""
import collections
import csv
import math
import subprocess
import sys

import h5py
import numpy

RATIO = 101.0
RATE = 2000.0                                # of the readings [Hz]
TRUE = ["motor_angle", "output_angle", "motor_torque", "joint_torque"]
ACCELERATION = 300.0                         # [deg/s^2]
DURATION = 29.2                              # [s]; the work ends at 20 s and stands
# Moves of a pick-and-place at work: to an angle about the upright arm [deg] at a speed [deg/s].
WORK = [(-50.0, 90.0), (35.0, 90.0), (-20.0, 60.0), (50.0, 120.0)] * 4 + [(0.0, 90.0)]
JOINT = "joints/shoulder.yaml"
Run = collections.namedtuple("Run", "time motor torsion motor_torque joint_torque output")


def speed_rows(moves):
    """Corners of the trapezoids: time [s], speed [rad/s]."""
    time, position, rows = 0.5, 0.0, [(0.0, 0.0), (0.5, 0.0)]
    for target, speed in moves:
        distance = abs(target - position)
        sign = math.copysign(1.0, target - position)
        peak = min(speed, math.sqrt(distance * ACCELERATION))
        rise, hold = peak / ACCELERATION, distance / peak - peak / ACCELERATION
        rows += [(time + rise, math.radians(sign * peak)), (time + rise + hold, math.radians(sign * peak)),
                 (time + 2.0 * rise + hold, 0.0)]
        time += 2.0 * rise + hold + 0.01
        rows.append((time, 0.0))
        position = target
    return [row for row, after in zip(rows, [*rows[1:], (math.inf, 0.0)]) if after[0] > row[0] + 1e-6]


class Bench:
    """Runs of the twin below a folder; those that are there already are kept."""

    def __init__(self, tool, work, jobs):
        self.tool, self.work, self.jobs = tool, work, jobs
        work.mkdir(parents=True, exist_ok=True)
        subprocess.run([tool, "checkup", "--arm", "ur5", "--joint", "shoulder", "--force", "--out",
                        work / "check_up.csv"], check=True, stdout=subprocess.DEVNULL)
        (work / "work.csv").write_text("time,shoulder_velocity\n" + "".join(
            f"{time:.6f},{speed:.9f}\n" for time, speed in speed_rows(WORK)))

    def sweep(self, name, settings, classes, motions, overlays, repeats=1, loads="0.0", columns=TRUE, seed=1):
        """(row of the index, run) of all that went well."""
        out = self.work / name
        if not (out / "index.csv").exists():
            lines = [f"name: {name}", f"seed: {seed}", f"duration: {DURATION}", f"overlays: [{', '.join(overlays)}]",
                     "set:", *settings, f"repeats: {repeats}", "duty:"]
            for motion in motions:
                lines += [f"  - name: {motion}",
                          f"    speed: {{csv: {{file: {motion}.csv, column: shoulder_velocity}}}}",
                          "    bandwidth: 8.0", f"    load: {{constant: {loads}}}"]
            lines += ["classes:", *classes, "record:", "  format: hdf5", "  start: 0.5", "  deflate: 0", "  groups:",
                      f"    signals: {{rate: {RATE}, type: float64, columns: [{', '.join(columns)}]}}"]
            plan = self.work / f"{name}.yaml"
            plan.write_text("\n".join(lines) + "\n")
            print(f"detection_bound: {name}", file=sys.stderr)
            done = subprocess.run([self.tool, "sweep", plan, "--out", out, "--jobs", str(self.jobs)], check=False)
            if done.returncode not in (0, 1):
                sys.exit(f"detection_bound: the sweep of {plan} ended with {done.returncode}")
        with open(out / "index.csv", newline="", encoding="utf-8") as index:
            return [(row, read(out / row["file"], columns)) for row in csv.DictReader(index) if row["status"] == "ok"]


def fault_class(kind, severities, place):
    return [f"  {kind}:", f"    - {{kind: {kind}, severity: {severities}, place: {place}, onset: 0.0}}"]


def read(path, columns):
    with h5py.File(path, "r") as file:
        group = file["signals"]
        motor, output, motor_torque, *joint_torque = (group[column][:] for column in columns)
        time = group.attrs["first_time"] + numpy.arange(len(motor)) / group.attrs["sample_rate"]
    return Run(time, motor, motor / RATIO - output, motor_torque, joint_torque[0] if joint_torque else None, output)
