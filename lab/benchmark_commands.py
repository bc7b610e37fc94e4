#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Processor time of whole commands of the tool, start and output included, as a Markdown table; with --old another
build's beside it, the runs of both alternating. Tables of the gear are built before, outside the time, except where the
case says so."""
import argparse
import csv
import math
import os
import pathlib
import resource
import statistics
import subprocess
import tempfile

import genpy
import rosbag
import yaml
from sensor_msgs.msg import JointState

from lab import CHECKOUT

START = 1000  # of recordings [s]
TURNING = {"solver.scene": "auto"}


def torques(seconds):
    """Of motor and load, which turn the shipped joint to and fro [N.m]."""
    return 0.55 * math.sin(2.0 * math.pi * 0.5 * seconds) + 0.2, 20.0


def write_profile(path, duration):
    with path.open("w", newline="") as file:
        rows = csv.writer(file)
        rows.writerow(["time", "motor_torque", "load_torque"])
        for row in range(int(duration * 125.0)):
            rows.writerow([row / 125.0, *torques(row / 125.0)])


def write_commands(path, duration):
    """A bag of stamped torques at 125 Hz."""
    with rosbag.Bag(str(path), "w") as bag:
        for row in range(int(duration * 125.0)):
            stamp = genpy.Time(START) + genpy.Duration.from_sec(row / 125.0)
            motor, load = torques(row / 125.0)
            for topic, effort in (("command", motor), ("load", load)):
                message = JointState(name=["joint"], effort=[effort])
                message.header.stamp = stamp
                bag.write("/joint_twin/" + topic, message, stamp)


def write_recording(path, duration):
    """A UR controller's recording of a swinging elbow, 125 Hz."""
    with path.open("w", newline="") as file:
        rows = csv.writer(file)
        rows.writerow(["timestamp"] + [f"{name}_2" for name in
                                       ("actual_q", "actual_qd", "actual_current", "target_moment")])
        for row in range(int(duration * 125.0)):
            t = row / 125.0
            angle = 0.7 * math.sin(0.9 * t) + 0.2 * math.sin(2.3 * t)
            speed = 0.63 * math.cos(0.9 * t) + 0.46 * math.cos(2.3 * t)
            moment = 20.0 * math.sin(angle + 0.4)
            current = (moment + math.copysign(12.0, speed) + 4.0 * speed) / 9.5
            rows.writerow([t, angle, speed, current, moment])


def write_plan(path, runs, duration):
    path.write_text(f"""name: benchmark
seed: 3
duration: {duration}
overlays: [joints/base.yaml, real_sensors.yaml]
set:
  solver.scene: auto
  indicators.window_turns: 25.0
repeats: {runs}
duty:
  - name: turning
    speed: {{constant: 1.0}}
    bandwidth: 8.0
    load: {{constant: 30.0}}
classes:
  healthy: []
record:
  format: hdf5
  start: 1.0
  deflate: 4
  indicators: true
  groups:
    signals:
      rate: 500.0
      type: float32
      columns: [motor_angle_encoder, motor_velocity_encoder, output_angle_encoder, motor_torque_reading]
    truth:
      rate: 100.0
      type: float64
      columns: [motor_angle, output_angle, joint_torque, friction_torque, torsional_stiffness]
""")


def write_fault_plan(path):
    """A check-up of 30 s of a sound drive and of every kind of fault."""
    plan = yaml.safe_load((CHECKOUT / "plans" / "fault_grid.yaml").read_text())
    plan["duration"] = 30.0
    plan["set"]["input.temperature"] = 25.0
    plan["duty"][0].update(speed={"constant": 1.0}, load={"constant": 30.0})
    for faults in plan["classes"].values():
        for fault in faults:
            fault["severity"] = 0.3
    path.write_text(yaml.safe_dump(plan))


class Case:
    """`arguments(folder, duration)`; what it has to write is the last of them. Duration 0: the start alone. `cold`: the
    tables are built in the time."""

    def __init__(self, name, arguments, wanted, duration, cold=False):
        self.name, self.arguments, self.wanted, self.duration = name, arguments, wanted, duration
        self.cold = cold


def simulate(kind, *options):
    def arguments(folder, duration):
        return ["simulate", "--profile", folder / "profile.csv", "--duration", duration, "--set", "solver.scene=auto",
                *options, "--force", "--out", folder / f"out.{kind}"]
    return arguments


def replay(folder, duration):
    return ["replay", folder / ("short.bag" if duration < 2.0 else "commands.bag"), "--force", "--out",
            folder / "replayed.bag"]


def follow(folder, duration):
    return ["follow", folder / ("short.csv" if duration < 2.0 else "recording.csv"), "--joint", "elbow", "--force",
            "--out", folder / "followed.csv"]


def sweep(jobs):
    def arguments(folder, duration):
        return ["sweep", folder / ("short.yaml" if duration < 2.0 else "plan.yaml"), "--jobs", jobs, "--out",
                tempfile.mkdtemp(dir=folder)]
    return arguments


def growing(kind, most, place):
    """A fault that grows all the time in two dozen steps."""
    steps = 24
    return simulate("csv", *(word for i in range(1, steps + 1) for word in
                             ("--fault", f"{kind}:{most * i / steps:.4f}:{place}:{1.1 * i:.1f}")))


def fault_sweep(folder, _):
    return ["sweep", folder / "faults.yaml", "--jobs", 2, "--out", tempfile.mkdtemp(dir=folder)]


def full_ring(*options):
    return simulate("csv", "--set", "solver.scene=full_ring", *options)


CASES = (
    Case("joint_twin --version", lambda folder, duration: ["--version"], "30 ms", 0.0),
    Case("joint_twin --help", lambda folder, duration: ["--help"], "30 ms", 0.0),
    Case("joint_twin stiffness --torques 14", lambda folder, duration: ["stiffness", "--torques", "14"], "30 ms", 0.0),
    Case("simulate to CSV", simulate("csv"), "400", 120.0),
    Case("simulate to a bag", simulate("bag"), "150", 120.0),
    Case("replay", replay, "100", 120.0),
    Case("follow", follow, "1000", 120.0),
    Case("sweep, HDF5 and indicators", sweep(1), "1000", 120.0),
    Case("simulate to CSV, tooth_wear", simulate("csv", "--fault", "tooth_wear:0.5"), "200", 120.0),
    Case("simulate to CSV, tooth_root_crack", simulate("csv", "--fault", "tooth_root_crack:0.5:40"), "200", 120.0),
    Case("simulate to CSV, flexspline_crack", simulate("csv", "--fault", "flexspline_crack:0.5:40"), "200", 60.0),
    Case("simulate to CSV, bearing_outer_race", simulate("csv", "--fault", "bearing_outer_race:0.5"), "200", 60.0),
    Case("simulate to CSV, bearing_ball", simulate("csv", "--fault", "bearing_ball:0.5"), "200", 60.0),
    Case("simulate to CSV, bearing_cage", simulate("csv", "--fault", "bearing_cage:0.5"), "200", 60.0),
    Case("simulate to CSV, tooth_wear from 1 s on", simulate("csv", "--fault", "tooth_wear:0.5:-1:1.0"), "200", 60.0),
    Case("simulate to CSV, tooth_root_crack that grows", growing("tooth_root_crack", 0.6, 40), "50", 30.0),
    Case("simulate to CSV, flexspline_crack that grows", growing("flexspline_crack", 0.3, 40), "50", 30.0),
    Case("simulate to CSV, rear_section_crack that grows", growing("rear_section_crack", 0.6, -1), "50", 30.0),
    Case("simulate to CSV, full ring", full_ring(), "10", 2.0),
    Case("simulate to CSV, as built, full ring",
         full_ring("--config", CHECKOUT / "config" / "as_built.yaml"), "10", 2.0),
    Case("sweep, every kind of fault, tables built", fault_sweep, "100", 510.0, cold=True),
)


def processor_time(command, cache=None):
    """[s]; with the tables of the gear in another folder than usual."""
    environment = {**os.environ, "XDG_CACHE_HOME": str(cache)} if cache else None
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(list(map(str, command)), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, check=True,
                   env=environment)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def measure(case, tools, folder, repeats):
    """Median processor time of each tool [s]."""
    times = [[] for _ in tools]
    if case.duration > 0.0 and not case.cold:
        for tool in tools:
            processor_time([tool, *case.arguments(folder, 1.0)])
    for _ in range(repeats if case.duration > 0.0 else 10 * repeats):
        for tool, found in zip(tools, times):
            cache = tempfile.mkdtemp(dir=folder) if case.cold else None
            found.append(processor_time([tool, *case.arguments(folder, case.duration)], cache))
    return [statistics.median(found) for found in times]


def figure(case, seconds):
    return f"{float(f'{case.duration / seconds:.3g}'):g}" if case.duration > 0.0 else f"{1e3 * seconds:.0f} ms"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("tool", type=os.path.abspath)
    parser.add_argument("--old", type=os.path.abspath, help="another build's tool")
    parser.add_argument("--repeats", type=int, default=3, help="of each command, of which the median counts [3]")
    parser.add_argument("--only", default="", help="cases whose name has this text")
    options = parser.parse_args()
    tools = [options.old, options.tool] if options.old else [options.tool]
    print("| command | " + ("before | " if options.old else "") + "now | wanted |")
    print("|---|" + "---|" * (len(tools) + 1))
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        write_profile(folder / "profile.csv", 120.0)
        for stem, duration in (("short", 1.0), ("commands", 120.0)):
            write_commands(folder / f"{stem}.bag", duration)
        for stem, duration in (("short", 1.0), ("recording", 120.0)):
            write_recording(folder / f"{stem}.csv", duration)
        for stem, duration in (("short", 2.0), ("plan", 60.0)):
            write_plan(folder / f"{stem}.yaml", 2, duration)
        write_fault_plan(folder / "faults.yaml")
        for case in CASES:
            if options.only in case.name:
                found = [figure(case, seconds) for seconds in measure(case, tools, folder, options.repeats)]
                print(f"| {case.name} | " + " | ".join(found) + f" | {case.wanted} |", flush=True)


if __name__ == "__main__":
    os.environ.setdefault("LC_ALL", "C")
    main()
