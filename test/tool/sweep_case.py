# SPDX-License-Identifier: BSD-3-Clause
"""What the tests of `joint_twin sweep` share."""
import csv
import os
import subprocess
import time

import tool

PLAN = """
name: test
seed: 7
duration: 0.06
overlays: [real_sensors.yaml]
set:
  input.temperature: {grid: [10.0, 40.0]}
  output.load_inertia: {log_uniform: [0.5, 2.0]}
repeats: 3
duty:
  - name: turning
    speed: {sinus: {mean: 0.5, amplitude: {uniform: [0.5, 1.5]}, frequency: 8.0, phase: 0.0}}
    bandwidth: 8.0
    load: {constant: 5.0}
record:
  format: hdf5
  start: 0.01
  deflate: 0
  groups:
    signals: {rate: 500.0, type: float32, columns: [motor_angle_encoder, motor_torque_reading]}
    teeth: {rate: 100.0, type: float64, columns: [mesh_force, joint_torque]}
"""
RUNS = 6
DRIVES = "drives: {number: 4, set: {bearing.viscosity: {log_uniform: [1.0e-4, 2.0e-4]}}}\n"
OF_DRIVES = PLAN.replace("repeats: 3", DRIVES + "repeats: 3")


def tree(directory):
    """Bytes of every file below."""
    return {os.path.relpath(os.path.join(path, name), directory): tool.read_bytes(os.path.join(path, name))
            for path, _, names in os.walk(directory) for name in names}


class SweepTest(tool.ToolTest):

    def setUp(self):
        super().setUp()
        self.write("plan.yaml", PLAN)

    def sweep(self, out, *arguments, plan="plan.yaml"):
        return self.succeed("sweep", plan, "--out", out, *arguments)

    def index(self, out):
        with open(self.path(out + "/index.csv")) as file:
            return list(csv.DictReader(file))

    def start(self, plan, out, *arguments):
        return subprocess.Popen([self.executable, "sweep", plan, "--out", out, *arguments], cwd=self.directory,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE)

    def wait_for_runs(self, out, count):
        deadline = time.monotonic() + 60.0 * tool.SLOWER
        while time.monotonic() < deadline:
            runs = self.path(out + "/runs")
            if os.path.isdir(runs) and sum(name.endswith(".h5") for name in os.listdir(runs)) >= count:
                return
            time.sleep(0.005)
        self.fail("no runs")
