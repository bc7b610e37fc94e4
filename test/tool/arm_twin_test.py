#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""`joint_twin arm`: an arm in closed loop follows its set points, and a fault in a joint shows in that joint's current.

Argument: the tool.
"""
import csv
import json
import math
import os

import tool

JOINTS = 6
EXAMPLES = os.path.join(os.path.dirname(os.path.abspath(__file__)), os.pardir, os.pardir, "examples")
START = [0.0, -1.2, 1.0, -1.3, -1.5, 0.3]


def write_motion(path, duration=1.6, elbow_speed=0.6):
    """Set points at 125 Hz: the elbow goes there and back, the others stand still."""
    with open(path, "w", encoding="utf-8", newline="") as file:
        rows = csv.writer(file)
        rows.writerow(["timestamp"] + [f"target_q_{i}" for i in range(JOINTS)])
        for k in range(int(duration * 125) + 1):
            angles = list(START)
            angles[2] += elbow_speed * duration / (2 * math.pi) * (1 - math.cos(2 * math.pi * k / 125 / duration))
            rows.writerow([k / 125] + angles)


class ArmTwin(tool.ToolTest):
    def run_arm(self, *options):
        return self.succeed_json("arm", "motion.csv", "--arm", "ur5", "--out", "run.csv", "--force", "--set",
                                 "solver.scene=full_ring", *options)

    def test_it_follows_its_set_points_and_a_fault_shows_in_its_joint(self):
        write_motion(self.path("motion.csv"))
        sound = self.run_arm()
        rows = self.rows("run.csv")
        self.assertEqual(len(rows), 201)
        moved = max(row["actual_q_2"] for row in rows) - START[2]
        self.assertAlmostEqual(moved, 0.6 * 1.6 / math.pi, delta=0.002)
        for joint in sound["joints"]:
            self.assertLess(joint["angle_error_max"], 5.0, joint)  # [mrad]
        self.assertLess(sound["tool_error_rms"], 1.0)  # [mm]
        worn = self.run_arm("--fault", "elbow:lubricant_degradation:1.0")
        change = {joint["joint"]: joint["current_rms"] - before["current_rms"]
                  for joint, before in zip(worn["joints"], sound["joints"])}
        elbow = change.pop("elbow")
        self.assertGreater(elbow, 0.02)  # [A]
        self.assertLess(max(map(abs, change.values())), 0.1 * elbow, change)

    def test_stamps_that_jitter_are_straightened_by_angles_and_speeds(self):
        duration, steps = 1.6, 100
        rate = 2 * math.pi / duration
        with open(self.path("motion.csv"), "w", encoding="utf-8", newline="") as file:
            rows = csv.writer(file)
            rows.writerow(["timestamp"] + [f"target_q_{i}" for i in range(JOINTS)]
                          + [f"target_qd_{i}" for i in range(JOINTS)])
            for k in range(steps + 1):
                time = duration * (k + 0.5 * (k % 2)) / steps  # stamped evenly, as if rows had waited for each other
                angles, speeds = list(START), [0.0] * JOINTS
                angles[2] += 0.15 * (1 - math.cos(rate * time))
                speeds[2] = 0.15 * rate * math.sin(rate * time)
                rows.writerow([duration * k / steps] + angles + speeds)
        done = self.run_tool("arm", "motion.csv", "--arm", "ur5", "--out", "run.csv", "--json", "--set",
                             "solver.scene=full_ring")
        self.assertIn("do not fit their angles and speeds. The program changed time steps by up to 8.0 ms",
                      done.stderr)
        elbow = json.loads(done.stdout)["joints"][2]
        self.assertLess(elbow["angle_error_max"], 3.0, elbow)  # [mrad]; with the stamps as they are some 10

    def test_an_arm_that_cannot_follow_stops_in_its_brakes(self):
        write_motion(self.path("motion.csv"), duration=0.8)
        with open(self.path("motion.csv"), encoding="utf-8") as file:
            lines = file.read().splitlines()
        jump = [line.split(",") for line in lines]
        for row in jump[40:]:
            row[3] = str(float(row[3]) + 0.5)  # the elbow, within a row
        self.write("motion.csv", "\n".join(map(",".join, jump)) + "\n")
        done = self.run_tool("arm", "motion.csv", "--arm", "ur5", "--out", "run.csv", "--json", "--set",
                             "solver.scene=full_ring")
        self.assertEqual(done.returncode, 5, done.stderr)
        self.assertIn("protective stop", done.stderr)
        stop = json.loads(done.stdout)["protective_stop"]
        self.assertEqual((stop["joint"], stop["reason"]), ("elbow", "off its set point"))
        self.assertAlmostEqual(stop["time"], 38 / 125, delta=2 / 125)
        rows = self.rows("run.csv")
        self.assertLess(max(abs(row["actual_qd_2"]) for row in rows[-20:]), 1e-3)  # of the motor, over the ratio
        # Its set point stays where it stopped, a little more than 0.1 rad ahead, before it came to rest.
        self.assertEqual((rows[-1]["target_qd_2"], rows[-1]["target_q_2"]), (0.0, rows[-20]["target_q_2"]))
        self.assertGreater(rows[-1]["target_q_2"] - rows[-1]["actual_q_2"], 0.05)

    def write_drives(self, folder):
        """As identified, with nothing that differs."""
        os.makedirs(self.path(folder), exist_ok=True)
        for name in ("base", "shoulder", "elbow", "wrist_1", "wrist_2", "wrist_3"):
            self.write(f"{folder}/{name}.yaml", "gear:\n  teeth_flexspline: 200\n")

    def test_gains_of_the_controller_are_taken(self):
        write_motion(self.path("motion.csv"), duration=0.8)
        self.write_drives("slow")
        self.write("slow/controller.yaml", "elbow: {position: 5.0, speed: 100.0, integral_time: 1.0, coulomb: 0.0, "
                   "viscous: 0.0}\n")
        errors = [self.run_arm(*options)["joints"][2]["angle_error_rms"]
                  for options in ([], ["--identified", "slow"])]
        self.assertGreater(errors[1], 3.0 * errors[0])
        self.write("slow/controller.yaml", "elbow: {position: -5.0, speed: 100.0, integral_time: 1.0}\n")
        self.fail_with(1, ["elbow.position = -5.0 [1/s] is out of range", "parameter elbow.coulomb is missing"], "arm",
                       "motion.csv", "--arm", "ur5", "--out", "no.csv", "--identified", "slow")

    def test_identify_finds_the_gains_of_its_own_controller(self):
        speed, position, integral_time = 150.0, 30.0, 0.07
        self.write_drives("own")
        self.write("own/controller.yaml", "".join(
            f"{name}: {{position: {position}, speed: {speed}, integral_time: {integral_time}, coulomb: 2.0, "
            "viscous: 5.0}\n" for name in ("base", "shoulder", "elbow")))
        program = os.path.join(EXAMPLES, "there_and_back.yaml")
        # A count of the encoder weighs more in a shorter window: what is recorded must be what the control had.
        own = ["--arm", "ur5", "--out", "run.csv", "--identified", "own", "--set", "sensors.velocity_window=4.0e-3"]
        self.succeed_json("arm", program, *own)
        found = self.succeed_json("identify", "run.csv", "--arm", "ur5", "--controller", "--out", "found")
        for joint in found["joints"][:3]:
            self.assertEqual(joint["refusal"], "")
            self.assertAlmostEqual(joint["speed"] / speed, 1.0, delta=0.15)
            self.assertAlmostEqual((joint["position"] + 1.0 / integral_time) / (position + 1.0 / integral_time), 1.0,
                                   delta=0.15)
            self.assertAlmostEqual(joint["coulomb"], 2.0, delta=0.3)
            self.assertAlmostEqual(joint["viscous"], 5.0, delta=1.0)
        self.assertIn("moves for less than 5 s", found["joints"][3]["refusal"])
        self.write_drives("found")
        self.succeed_json("arm", program, "--arm", "ur5", "--out", "again.csv", "--identified", "found")
        for option in (("--judge", 0, 1), ("--folds", 3), ("--load", "target_moment")):
            self.fail_with(1, ["--controller uses", option[0]], "identify", "run.csv", "--arm", "ur5", "--controller",
                           *option)
        self.fail_with(1, ["no column target_qd_0"], "identify", self.write("few.csv", "timestamp,target_q_0\n0,0\n"),
                       "--arm", "ur5", "--controller")

    def test_units_and_signs_are_held_against_the_motion(self):
        header = "timestamp," + ",".join(f"{name}_{i}" for name in ("target_q", "target_qd") for i in range(JOINTS))
        for scale, speed_scale, text in (
                (180 / math.pi, 180 / math.pi, "set point 1: shoulder_pan_joint: angle = 43.5"),
                (1.0, -1.0, "base: its speeds are -1 times the rate of its angles, allowed: 0.5 ... 2 (is their sign"),
                (1.0, 180 / math.pi, "base: its speeds are 57.3 times the rate of its angles"),
                (1.0, 0.0, "base: its speeds are 0 times the rate of its angles, allowed: 0.5 ... 2 (are they")):
            rows = [[0.08 * k] + [scale * (0.76 + 0.08 * k)] * JOINTS + [speed_scale] * JOINTS for k in range(4)]
            self.write("motion.csv", "\n".join([header] + [",".join(map(str, row)) for row in rows]) + "\n")
            self.fail_with(1, [f"motion.csv: {text}"], "arm", "motion.csv", "--arm", "ur5", "--out", "no.csv")

    def test_what_is_wrong_is_named(self):
        write_motion(self.path("motion.csv"), duration=0.1)
        for options, text in ((["--fault", "knee:tooth_wear:0.5"], "JOINT is one of base, shoulder, elbow"),
                              (["--fault", "tooth_wear:0.5"], "JOINT is one of base"),
                              (["--fault", "elbow:tooth_wear:5"], "severity")):
            self.fail_with(1, [text], "arm", "motion.csv", "--arm", "ur5", "--out", "no.csv", *options)
        ur5 = os.path.join(tool.CHECKOUT, "config/arms/ur5.yaml")
        self.write("heavy.yaml", f"like: {ur5}\npayload: {{mass: 1000.0, centre: [0.0, 0.0, 0.0]}}\n")
        self.fail_with(1, ["set point 1: shoulder_lift_joint cannot bear the weight of links and payload (1000.0 kg)",
                           "its limit is 150 N.m"], "arm", "motion.csv", "--arm", "heavy.yaml", "--out", "no.csv")
        self.write("fast.yaml", f"start: {START}\nmoves:\n  - {{to: {[2.0] + START[1:]}, speed: 9.0, "
                   "acceleration: 50.0}\n")
        self.fail_with(1, ["shoulder_pan_joint would have a speed of"], "arm", "fast.yaml", "--arm", "ur5", "--out",
                       "no.csv")
        self.write("short.yaml", f"start: {START}\nmoves:\n  - {{to: [1.0], speed: 0.0}}\n")
        self.fail_with(1, ["moves.0.to", "moves.0.speed = 0.0 [rad/s] is out of range", "moves.0.acceleration"], "arm",
                       "short.yaml", "--arm", "ur5", "--out", "no.csv")
        for moves, value in (("moves: []", " = []"), ("moves: 3", " = 3"), ("moves: {to: [0]}", ""), ("", "")):
            self.write("none.yaml", f"start: {START}\n{moves}\n")
            self.fail_with(1, [f"moves{value}", "must be a list of one move or more"], "arm", "none.yaml", "--arm",
                           "ur5", "--out", "no.csv")
        self.write("a.bag", "#ROSBAG V2.0\n")
        self.fail_with(1, ["have no targets; give a table of set points"], "arm", "a.bag",
                       "--arm", "ur5", "--out", "no.csv")
        self.fail_with(1, ["have no targets; give a table with target and actual values"], "identify",
                       "a.bag", "--arm", "ur5", "--controller")
        self.write("few.csv", "timestamp,target_q_0\n0,0\n")
        self.fail_with(1, ["no column target_q_1 or shoulder_position, target_q_2 or elbow_position"], "arm", "few.csv",
                       "--arm", "ur5", "--out", "no.csv")


if __name__ == "__main__":
    tool.main()
