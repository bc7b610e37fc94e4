# SPDX-License-Identifier: BSD-3-Clause
"""`joint_twin signatures`: what faults change in the health indicators, from a plan's runs."""
import os
import signal
import subprocess
import time

import yaml

import tool

# To and fro, a window of 3 s.
PLAN = """
name: small
duration: 4.1
overlays: [joints/shoulder.yaml, real_sensors.yaml]
set:
  solver.scene: auto
  input.temperature: {grid: [20.0, 40.0]}
  indicators.window_turns: 100000.0
  indicators.window_time: 3.0
  publish.indicators_rate: 1.0
  sensors.motor_noise: 0.0
  sensors.output_noise: 0.0
  sensors.torque_noise: 0.0
duty:
  - name: rocking
    speed: {sinus: {mean: 0.0, amplitude: 1.0, frequency: 1.0, phase: 0.0}}
    bandwidth: 8.0
    load: {constant: 0.0}
classes:
  sound: []
  grease:
    - {kind: lubricant_degradation, severity: {grid: [0.4, 1.0]}, place: -1, onset: 0.0}
  crack:
    - {kind: flange_crack, severity: {grid: [1.0]}, place: -1, onset: 0.0}
record: {format: bag}
"""
SEVERITIES = [0.1, 0.16, 0.25, 0.4, 0.63, 1.0]
KINEMATIC_ROWS = 54


class Signatures(tool.ToolTest):
    def setUp(self):
        super().setUp()
        self.write("plan.yaml", PLAN)

    def changed(self, old, new):
        self.assertIn(old, PLAN)
        return self.write("other.yaml", PLAN.replace(old, new))

    def signatures(self, name):
        """(file, rows of a cause and motion: severity, change by indicator)."""
        with open(self.path(name), encoding="utf-8") as file:
            content = yaml.safe_load(file)
        rows = {}
        for cause, motion, _, _, severity, *changes in map(str.split, content["signatures"].splitlines()):
            rows.setdefault((cause, motion), []).append(
                (float(severity), dict(zip(content["indicators"], map(float, changes)))))
        return content, rows

    def test_differences_between_faulty_and_sound_runs(self):
        report = self.succeed_json("signatures", "plan.yaml", "--out", "mine.yaml", "--runs", "runs")
        self.assertEqual((report["done"], report["failed"]), (8, 0))
        content, rows = self.signatures("mine.yaml")
        self.assertEqual(content["gear"], "mine")
        self.assertEqual(sum(map(len, rows.values())), 12 + KINEMATIC_ROWS)
        shipped, _ = self.signatures(os.path.join(tool.CHECKOUT, "config/signatures/size_25.yaml"))
        self.assertEqual((content["errors"], content["carried"]), (shipped["errors"], shipped["carried"]))

        grease = rows["lubricant_degradation", "rocking"]
        self.assertEqual([severity for severity, _ in grease], SEVERITIES)
        # As the tool finds it in the same bags, averaged over the temperatures.
        windows = [self.succeed_json("indicators", "--windows", f"runs/small/runs/run_{run:09d}.bag")["windows"][-1]
                   for run in range(8)]
        torques = [window["indicators"]["running_torque"] for window in windows]
        by_severity = {0.0: 0.0}
        for column, severity in enumerate((0.4, 1.0)):
            by_severity[severity] = sum((torques[2 + column + 2 * warm] / torques[warm] - 1.0) / 2 for warm in (0, 1))
        for severity, change in grease:
            low, high = (0.0, 0.4) if severity <= 0.4 else (0.4, 1.0)
            share = (severity - low) / (high - low)
            wanted = by_severity[low] + share * (by_severity[high] - by_severity[low])
            self.assertAlmostEqual(change["running_torque"] / wanted, 1.0, delta=0.006)  # three digits
        self.assertGreater(by_severity[1.0], 0.3)

        # Without runs in between a straight line through nothing.
        crack = [change["lost_motion"] or change["kinematic_error"] for _, change in rows["flange_crack", "rocking"]]
        for severity, change in zip(SEVERITIES, crack):
            self.assertAlmostEqual(change / crack[-1], severity, delta=0.006)
        self.assertAlmostEqual(content["sound"]["running_torque"], sum(torques[:2]) / 2, delta=1e-3)

        # The file is one for the parameter, and the runs are there already.
        self.succeed("indicators", "--windows", "runs/small/runs/run_000000000.bag", "--set",
                     f"indicators.signatures={self.path('mine.yaml')}")
        again = self.succeed_json("signatures", "plan.yaml", "--out", "again.yaml", "--runs", "runs")
        self.assertEqual((again["done"], again["present"]), (0, 8))
        self.assertEqual(self.signatures("again.yaml")[1], rows)

        # Behind those of a file: of runs twice, of kinematics once.
        self.succeed("signatures", "plan.yaml", "--out", "both.yaml", "--runs", "runs", "--add", "mine.yaml")
        both, added = self.signatures("both.yaml")
        self.assertEqual(added, {key: own * (1 if key[1] == "kinematics" else 2) for key, own in rows.items()})
        self.assertEqual(both["errors"], content["errors"])
        self.fail_with(1, ["none.yaml", "cannot be read"], "signatures", "plan.yaml", "--out", "x.yaml", "--add",
                       "none.yaml")

    def test_torque_of_kinematic_lines_goes_with_the_gear(self):
        plan = self.changed("{grid: [20.0, 40.0]}", "20.0")
        self.succeed("signatures", plan, "--out", "small.yaml", "--config", "size_14.yaml")
        _, rows = self.signatures("small.yaml")
        largest = max(change["torque_inner"] for _, change in rows["bearing_inner_race", "kinematics"])
        self.assertAlmostEqual(largest, 1e-2 * 7.8 / 67.0, delta=1e-5)

    def test_what_is_no_plan_of_signatures(self):
        refused = [("  sound: []\n", "", "no sound run under the same conditions"),
                   ("onset: 0.0}\n  crack:", "onset: 1.0}\n  crack:", "must exist from the start"),
                   ("{format: bag}", "{format: hdf5, groups: {a: {rate: 100.0, columns: [load_torque]}}}",
                    "record: {format: bag}"),
                   ("  sound: []\n", "  sound: []\n  two:\n    - {kind: buckling, severity: 0.1}\n"
                                     "    - {kind: pitting, severity: 0.1, place: 3}\n", "2 faults"),
                   ("window_time: 3.0", "window_time: 30.0", "without a whole window")]
        for old, new, words in refused:
            with self.subTest(words):
                plan = self.changed(old, new)
                self.fail_with(1, ["plan small", words], "signatures", plan, "--out", "x.yaml")
                self.assertFalse(os.path.exists(self.path("x.yaml")))
        self.write("x.yaml", "mine\n")
        self.fail_with(1, ["x.yaml", "--force"], "signatures", "plan.yaml", "--out", "x.yaml")

    def test_an_interrupt_keeps_the_runs(self):
        process = subprocess.Popen([self.executable, "signatures", "plan.yaml", "--out", "x.yaml", "--runs", "runs",
                                    "--jobs", "1"], cwd=self.directory, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.addCleanup(process.kill)
        deadline = time.monotonic() + 120.0 * tool.SLOWER
        while not os.path.exists(self.path("runs/small/runs/run_000000000.bag")):
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.01)
        process.send_signal(signal.SIGINT)
        output, errors = process.communicate(timeout=60 * tool.SLOWER)
        self.assertEqual((process.returncode, output), (128 + signal.SIGINT, b""))
        self.assertIn(b"interrupted; the same command resumes", errors)
        self.assertFalse(os.path.exists(self.path("x.yaml")))


if __name__ == "__main__":
    tool.main()
