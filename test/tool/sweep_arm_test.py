# SPDX-License-Identifier: BSD-3-Clause
"""`joint_twin sweep` of whole arms, and the files of `joint_twin arm` that hold the same."""
import glob
import json
import os
import signal
import subprocess
import time

import h5py
import numpy
import rosbag

import tool
from sweep_test import SweepTest, tree

PLAN = """
arm: ur5
duration: 0.3
set: {solver.scene: full_ring}
duty:
  - {name: nod, motion: nod.csv, payload: {grid: [0.0, 4.0]}}
classes:
  healthy: []
  worn: [{joint: elbow, kind: lubricant_degradation, severity: 1.0}]
  cracked: [{joint: wrist_2, kind: flange_crack, severity: 0.5, place: -1, onset: 0.1, ramp: 0.1}]
record:
  start: 0.1
  groups:
    states: {rate: 500.0, columns: [target_q, actual_q, actual_current, actual_TCP_pose]}
"""
ONE_RUN = PLAN.split("duty:")[0] + "duty: [{motion: nod.csv}]\nrecord:" + PLAN.split("record:")[1]
NOD = 0.1  # of each joint [rad]
START = numpy.array([0.0, -0.6, 1.0, -1.3, -1.5, 0.3])


class SweepArm(SweepTest):
    def setUp(self):
        super().setUp()
        times = 0.008 * numpy.arange(51)
        angles = START + 0.5 * NOD * (1.0 - numpy.cos(2.0 * numpy.pi * times / 0.4))[:, None]
        head = "time," + ",".join(f"target_q_{i}" for i in range(6))
        rows = [",".join(f"{value:.17g}" for value in (at, *row)) for at, row in zip(times, angles)]
        self.write("nod.csv", "\n".join([head, *rows, ""]))
        self.write("plan.yaml", PLAN)

    def test_files_hold_the_arm_and_labels_by_joint(self):
        self.sweep("a", "--jobs", 2)
        rows = self.index("a")
        self.assertEqual([row["class"] for row in rows], ["healthy"] * 2 + ["worn"] * 2 + ["cracked"] * 2)
        self.assertEqual({row["status"] for row in rows}, {"ok"})
        self.assertEqual([(row["fault_joint"], row["fault_kind"]) for row in rows[2:5:2]],
                         [("elbow", "lubricant_degradation"), ("wrist_2", "flange_crack")])
        self.assertEqual({row["protective_stop"] for row in rows}, {""})
        self.assertEqual([float(row["duty.0.payload"]) for row in rows], [0.0, 4.0] * 3)
        currents, drags = [], []
        for row in rows:
            with h5py.File(self.path("a/" + row["file"]), "r") as file:
                states = file["states"]
                for name, width in (("actual_q", 6), ("severity", 6), ("actual_TCP_pose", 3)):
                    self.assertEqual(states[name].shape, (100, width))
                self.assertEqual(states["time"].shape, (100,))
                self.assertEqual(states["actual_current"].attrs["unit"], "A")
                self.assertLess(numpy.abs(states["actual_q"][:] - states["target_q"][:]).max(), 0.1 * NOD)
                self.assertGreater(numpy.ptp(states["actual_q"], axis=0).min(), 0.04)
                currents.append(numpy.abs(states["actual_current"][:]).mean(axis=0))
                along = numpy.sign(numpy.gradient(states["target_q"][:], axis=0))
                drags.append((along * states["actual_current"][:]).mean(axis=0))  # friction's share
                self.assertEqual(len(file["parameters"]), 6)
                self.assertIn("elbow_joint", file["parameters/elbow"][()].decode())
                self.assertEqual(json.loads(file["record"][()])["class"], row["class"])
                if row["class"] == "cracked":
                    self.assertEqual([fault["joint"].decode() for fault in file["faults"]], ["wrist_2"])
                    severity, at = states["severity"][:], states["time"][:]
                    expected = 0.5 * numpy.clip((at - 0.1) / 0.1, 0.0, 1.0)
                    numpy.testing.assert_allclose(severity[:, 4], expected, atol=1e-6)
                    self.assertEqual(numpy.delete(severity, 4, axis=1).max(), 0.0)
        more = drags[2] - drags[0]
        self.assertGreater(more[2], 2.0 * numpy.abs(numpy.delete(more, 2)).max(), more)
        self.assertGreater(currents[1][1] - currents[0][1], 0.5)  # 4 kg on the shoulder

    def test_any_number_of_jobs_gives_the_same_bytes_and_it_resumes(self):
        self.write("plan.yaml", ONE_RUN.replace("duty:", "overlays: [real_sensors.yaml]\nrepeats: 2\nduty:"))
        self.sweep("a", "--jobs", 2)
        self.sweep("b", "--jobs", 1)
        self.assertEqual(tree(self.path("a")), tree(self.path("b")))
        found = json.loads(self.sweep("a", "--json").stdout)
        self.assertEqual((found["done"], found["present"]), (0, 2))
        with open(self.path("nod.csv"), "a", encoding="utf-8") as file:
            file.write("0.5," + ",".join(["0"] * 6) + "\n")
        self.fail_with(1, ["other tables of the plan"], "sweep", "plan.yaml", "--out", "a")

    def test_a_drive_of_the_plan_is_an_arm(self):
        drives = "drives: {number: 2, test: 0.5, set: {input.temperature: {uniform: [15.0, 35.0]}}}\nduty:"
        self.write("plan.yaml", ONE_RUN.replace("duty:", drives))
        self.sweep("a")
        rows = self.index("a")
        self.assertEqual([(row["drive"], row["split"]) for row in rows], [("0", "train"), ("1", "test")])
        self.assertNotEqual(*(row["drives.set.input.temperature"] for row in rows))
        for row in rows:
            with h5py.File(self.path("a/" + row["file"]), "r") as file:
                for text in file["parameters"].values():
                    self.assertIn(f"input.temperature: {row['drives.set.input.temperature']}", text[()].decode())

    def test_the_tool_writes_the_same_run(self):
        self.write("plan.yaml", ONE_RUN.replace("duration: 0.3\n", "").replace("start: 0.1", "start: 0.0"))
        self.sweep("a")
        more = ("--arm", "ur5", "--set", "solver.scene=full_ring", "--rate", 500)
        for out in ("run.csv", "run.h5", "run.bag"):
            self.succeed("arm", "nod.csv", *more, "--out", out)
        table = numpy.genfromtxt(self.path("run.csv"), delimiter=",", names=True)
        with h5py.File(self.path("run.h5"), "r") as one, h5py.File(self.path("a/runs/run_000000000.h5"), "r") as run:
            for name in ("time", "target_q", "actual_q", "actual_current", "actual_TCP_pose"):
                numpy.testing.assert_array_equal(one["states"][name][:], run["states"][name][:], name)
            angles, current = one["states/actual_q"][:], one["states/actual_current"][:]
        for joint in range(6):
            numpy.testing.assert_array_equal(table[f"actual_q_{joint}"][1:], angles[:, joint])
        with rosbag.Bag(self.path("run.bag")) as bag:
            states = [message for _, message, _ in bag.read_messages(["/joint_states"])]
        self.assertEqual(states[0].name, sorted(states[0].name))
        elbow = states[0].name.index("elbow_joint")
        numpy.testing.assert_array_equal([state.position[elbow] for state in states][-len(angles):], angles[:, 2])
        numpy.testing.assert_array_equal([state.effort[elbow] for state in states][-len(angles):], current[:, 2])

    def test_rows_count_from_the_motion_at_a_rate_that_divides_the_solvers(self):
        more = ("--arm", "ur5", "--set", "solver.scene=full_ring")
        self.succeed("arm", "nod.csv", *more, "--rate", 125, "--out", "run.csv")
        self.succeed("arm", "nod.csv", *more, "--rate", 125, "--out", "run.bag")
        table = numpy.genfromtxt(self.path("run.csv"), delimiter=",", names=True)
        with rosbag.Bag(self.path("run.bag")) as bag:
            states = [message for _, message, _ in bag.read_messages(["/joint_states"])]
        elbow = states[0].name.index("elbow_joint")
        numpy.testing.assert_array_equal([state.position[elbow] for state in states], table["actual_q_2"])
        done = self.succeed("arm", "nod.csv", *more, "--rate", 300, "--out", "run.h5")
        self.assertIn("Hz in place of 300.0 Hz, which does not divide solver.rate", done.stderr)
        with h5py.File(self.path("run.h5"), "r") as run:
            self.assertAlmostEqual(run["states"].attrs["sample_rate"], 300.0, delta=5.0)
            self.assertGreater(len(run["states/actual_q"]), 110)
            steps = numpy.diff(run["states/time"][:])
            numpy.testing.assert_allclose(steps, 1.0 / run["states"].attrs["sample_rate"], rtol=1e-6)

    def test_an_onset_counts_from_the_motion(self):
        more = ("--arm", "ur5", "--set", "solver.scene=full_ring", "--rate", 500)
        self.succeed("arm", "nod.csv", *more, "--out", "sound.h5")
        self.succeed("arm", "nod.csv", *more, "--out", "late.h5", "--fault", "elbow:lubricant_degradation:1.0:-1:0.2")
        with h5py.File(self.path("sound.h5"), "r") as sound, h5py.File(self.path("late.h5"), "r") as late:
            at, severity = late["states/time"][:], late["states/severity"][:, 2]
            numpy.testing.assert_array_equal(severity, numpy.where(at > 0.1999, 1.0, 0.0))
            same = [run["states/actual_current"][:, 2][at < 0.1999] for run in (sound, late)]
            numpy.testing.assert_array_equal(*same)
            change = late["states/actual_current"][:] - sound["states/actual_current"][:]
            self.assertGreater(numpy.abs(change).max(), 0.02)  # [A]
            record = json.loads(late["record"][()])
        self.assertEqual((record["status"], record["protective_stop"]), ("ok", ""))
        self.assertGreater(record["steps"], 0)

    def test_a_run_that_is_cut_leaves_no_file(self):
        head = "time," + ",".join(f"target_q_{i}" for i in range(6))
        angles = ",".join(map(str, START))
        self.write("still.csv", f"{head}\n0.0,{angles}\n1000.0,{angles}\n")
        process = subprocess.Popen([self.executable, "arm", "still.csv", "--arm", "ur5", "--set",
                                    "solver.scene=full_ring", "--out", "run.h5"], cwd=self.directory,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.addCleanup(process.kill)
        deadline = time.monotonic() + 60.0 * tool.SLOWER
        while not glob.glob(self.path("run.h5.*.part")):
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.01)
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=60.0 * tool.SLOWER)
        self.assertEqual(process.returncode, 128 + signal.SIGINT)
        self.assertEqual([name for name in os.listdir(self.directory) if name.startswith("run.h5")], [])

    def test_what_is_wrong_is_refused_with_its_place(self):
        for change, said in {
                ("joint: elbow", "joint: knee"): "is not a joint of the arm; its joints are base, shoulder, elbow",
                ("joint: elbow, ", ""): "needs the key 'joint'",
                ("arm: ur5", "arm: ur6"): "arm ur6 is neither a file nor an arm",
                ("motion: nod.csv", "motion: none.csv"): "none.csv",
                ("payload: {grid: [0.0, 4.0]}", "payload: -1.0"): "payload = -1.0 [kg] is out of range",
                ("[target_q,", "[motor_angle,"): "is not a column; allowed: target_q, target_qd",
                ("start: 0.1", "start: 0.1\n  indicators: true"): "are those of one drive",
                ("duration: 0.3\n", "duration: 0.3\nlives: {drives: 2}\n"): "is not allowed in a plan of arms",
        }.items():
            self.write("plan.yaml", PLAN.replace(*change))
            self.fail_with(1, [said], "sweep", "plan.yaml", "--out", "a", "--dry-run")


if __name__ == "__main__":
    tool.main()
