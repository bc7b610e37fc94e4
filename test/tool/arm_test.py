# SPDX-License-Identifier: BSD-3-Clause
"""`--arm`: all joints of a recorded arm at once, their load from the angles of all.

The synthetic arm's currents are those that the twin predicts; recordings of a UR5 are used where they are at hand, in
HJT_TELEMETRY_DIR, else in shared/telemetry beside the checkout.
"""
import csv
import functools
import glob
import json
import math
import os
import subprocess
import tempfile
import unittest

import genpy
import numpy as np
import rosbag
from sensor_msgs.msg import JointState, Temperature

import tool

SHORT_NAMES = ["base", "shoulder", "elbow", "wrist_1", "wrist_2", "wrist_3"]
GAINS = [10.7, 10.7, 10.7, 10.21, 11.9, 11.92]  # of config/arms/ur5.yaml [N.m/A]
PERIOD = 0.008
DIRECTORY = os.environ.get("HJT_TELEMETRY_DIR", os.path.join(tool.CHECKOUT, "..", "shared", "telemetry"))
RECORDINGS = sorted(glob.glob(os.path.join(DIRECTORY, "ur5_cb", "*.csv")))
# Rms difference from the controller's torque that is allowed [N.m]: slow motions 1.0, of fast ones 5 % of the range.
SLOW, FAST_SHARE = 1.0, 0.05


def angles(time):
    """Of the six joints [rad]: a second in the stretched, level pose, then each swings."""
    swing = 0.0 if time < 1.0 else 0.5 * (1.0 - math.cos(1.3 * (time - 1.0)))
    return [0.6 * swing, -0.9 * swing, 1.1 * swing, -0.5 * swing, 0.4 * swing, 0.7 * swing]


def arm_csv(currents=None, seconds=20.0, without=(), temperature=None, start=0.0):
    """A controller's recording as text. `currents`: six for each row, else none flows. `temperature`: of joint and row,
    as text; none: not recorded. `start`: the first stamp [s]."""
    rows = round(seconds / PERIOD)
    columns = ["timestamp"] + [f"{quantity}_{joint}" for quantity in ("actual_q", "actual_current")
                               for joint in range(6)]
    kept = [i for i, name in enumerate(columns) if name not in without]
    lines = [",".join([columns[i] for i in kept]
                      + [f"joint_temperatures_{joint}" for joint in range(6) if temperature])]
    for row in range(rows):
        values = [start + row * PERIOD] + angles(row * PERIOD) + (currents[row] if currents else [0.0] * 6)
        lines.append(",".join([f"{values[i]:.17g}" for i in kept]
                              + [temperature(joint, row) for joint in range(6) if temperature]))
    return "\n".join(lines) + "\n"


def arm_bag(path, joints, seconds=20.0, effort=0.0):
    """As a driver publishes it: the elbow first, another joint between, no velocity; the same effort of all."""
    order = [joint for joint in [2, 1, 0, 5, 4, 3] if joint in joints]
    with rosbag.Bag(path, "w") as bag:
        for row in range(round(seconds / PERIOD)):
            at = genpy.Time(tool.START) + genpy.Duration.from_sec(row * PERIOD)
            position = angles(row * PERIOD)
            state = JointState(name=["finger_joint"] + [tool.JOINT_NAMES[joint] for joint in order],
                               position=[0.3] + [position[joint] for joint in order],
                               effort=[9.0] + [effort] * len(order))
            state.header.stamp = at
            bag.write("/joint_states", state, at + genpy.Duration(0, 2_000_000))


@functools.lru_cache(maxsize=None)
def predicted(executable, degrees):
    """Columns that the twins predict for that motion at a temperature, by joint."""
    with tempfile.TemporaryDirectory() as folder:
        with open(os.path.join(folder, "still.csv"), "w", encoding="ascii") as file:
            file.write(arm_csv())
        subprocess.run([executable, "follow", "still.csv", "--arm", "ur5", "--out", "robot", "--set",
                        f"input.temperature={degrees}"], check=True, cwd=folder, stdout=subprocess.DEVNULL)
        return [tool.read_columns(os.path.join(folder, "robot", f"{name}.csv")) for name in SHORT_NAMES]


class ArmTest(tool.ToolTest):
    """A test with a made-up arm."""

    def columns(self, path):
        return tool.read_columns(self.path(path))

    def robot_with_friction(self, raised, share=0.3, path="robot.csv", degrees=25.0, is_recorded=False, start=0.0):
        """A robot that is the twin at a temperature, friction of these joints raised by a share, with some noise."""
        noise = np.random.default_rng(7)
        currents = []
        for name, gain, columns in zip(SHORT_NAMES, GAINS, predicted(self.executable, degrees)):
            more = share / gain * columns["friction_torque"] if name in raised else 0.0
            currents.append(columns["current_predicted"] + more + noise.normal(0.0, 0.05, len(columns["time"])))
        temperature = (lambda joint, row: f"{degrees}") if is_recorded else None
        self.write(path, arm_csv(np.transpose(currents).tolist(), temperature=temperature, start=start))
        return path


class Arm(ArmTest):

    def test_load_is_that_of_all_joints_however_they_are_recorded(self):
        self.write("arm.csv", arm_csv())
        arm_bag(self.path("arm.bag"), range(6))
        self.succeed("follow", "arm.csv", "--arm", "ur5", "--out", "from_csv")
        own_file = os.path.join(tool.CHECKOUT, "config/arms/ur5.yaml")
        self.succeed("follow", "arm.bag", "--arm", own_file, "--out", "from_bag")
        self.assertEqual(sorted(os.listdir(self.path("from_csv"))), sorted(f"{name}.csv" for name in SHORT_NAMES))
        for name in SHORT_NAMES:
            columns = self.columns(f"from_csv/{name}.csv")
            self.assertEqual(len(columns["time"]), 2500)
            np.testing.assert_allclose(self.columns(f"from_bag/{name}.csv")["load_torque"], columns["load_torque"],
                                       atol=1e-4)
        wrists = 2.0 * 1.219 + 0.1879
        elbow = 9.82 * (2.275 * 0.27232 + wrists * 0.39225)
        shoulder = elbow + 9.82 * (8.393 * 0.2125 + (2.275 + wrists) * 0.425)
        weights = [self.columns(f"from_csv/{name}.csv")["load_torque"][50] for name in ("base", "shoulder", "elbow")]
        np.testing.assert_allclose(np.abs(weights), [0.0, shoulder, elbow], atol=0.05)

    def test_topics_of_the_node_are_added_to_a_bag(self):
        arm_bag(self.path("arm.bag"), range(6), seconds=5.0, effort=1.5)
        self.succeed("follow", "arm.bag", "--arm", "ur5", "--bag", "all.bag", "--out", "rows")
        with rosbag.Bag(self.path("arm.bag")) as bag:
            original = list(bag.read_messages(raw=True))
        with rosbag.Bag(self.path("all.bag")) as bag:
            kept = list(bag.read_messages("/joint_states", raw=True))
            self.assertEqual([(m.message[1], m.timestamp) for m in kept],
                             [(m.message[1], m.timestamp) for m in original])
            for name in SHORT_NAMES:
                comparisons = [m.message for m in bag.read_messages(f"/{name}/joint_twin/comparison")]
                self.assertEqual([m.header.stamp for m in comparisons],
                                 [genpy.Time(tool.START) + genpy.Duration.from_sec(row * PERIOD) for row in range(625)])
                np.testing.assert_array_equal([m.current_predicted for m in comparisons],
                                              self.columns(f"rows/{name}.csv")["current_predicted"])
                forces = [m.message for m in bag.read_messages(f"/{name}/joint_twin/contact_forces")]
                self.assertEqual((len(forces), {len(m.mesh_force) for m in forces}), (50, {200}))
                # Flank forces carry the joint's torque, on radii of 32 and 18 mm, the arcs a few degrees off the
                # tangent, where they touch by the load.
                torques = {m.header.stamp: m.joint_torque for m in comparisons}
                self.assertGreater(abs(torques[forces[0].header.stamp]), 1.0)
                np.testing.assert_allclose([abs(sum(m.mesh_force)) for m in forces],
                                           [(31.6 if name in SHORT_NAMES[:3] else 57.0) * abs(torques[m.header.stamp])
                                            for m in forces], rtol=0.015, atol=5.0)
                verdicts = [m.message for m in bag.read_messages(f"/{name}/joint_twin/verdict")]
                self.assertEqual({m.joint for m in verdicts}, {tool.JOINT_NAMES[SHORT_NAMES.index(name)]})
                self.assertEqual([m.level for m in verdicts], [m.NOT_JUDGED for m in verdicts])
                self.assertEqual([m.reason for m in verdicts[1:]], [verdicts[0].EFFORT_CONSTANT] * 5)
                for topic in ("encoders", "health", "stress"):
                    self.assertEqual(bag.get_message_count(f"/{name}/joint_twin/{topic}"), 50)
        self.succeed("follow", "arm.bag", "--joint", "elbow", "--bag", "elbow.bag")
        with rosbag.Bag(self.path("elbow.bag")) as bag:
            self.assertEqual(bag.get_message_count("/joint_twin/comparison"), 625)
        self.fail_with(1, ["all.bag holds /base/joint_twin/", "--joint-namespace"], "follow", "all.bag", "--arm", "ur5",
                       "--bag", "again.bag")
        self.fail_with(1, ["--bag", "--time-scale"], "follow", "arm.bag", "--arm", "ur5", "--bag", "again.bag",
                       "--time-scale", 2)
        self.assertFalse(os.path.exists(self.path("again.bag")))

    def identify(self, *changes):
        """Identifies a robot that is the twin with these changes: robot.csv, found/."""
        self.write("still.csv", arm_csv())
        self.succeed("follow", "still.csv", "--arm", "ur5", "--out", "robot", *changes)
        predicted = np.array([self.columns(f"robot/{name}.csv")["current_predicted"] for name in SHORT_NAMES]).T
        self.write("robot.csv", arm_csv(predicted.tolist()))
        self.fail_with(1, ["judge: of one joint alone"], "identify", "robot.csv", "--arm", "ur5", "--judge", "0,9")
        self.succeed("identify", "robot.csv", "--arm", "ur5", "--out", "found")

    def test_no_overlay_is_out_of_range(self):
        # A motor lighter than the wave generator alone is taken to be.
        self.identify("--set", "motor.rotor_inertia=1.0e-9", "--set", "motor.wave_generator_inertia=1.0e-6",
                      "--set", "telemetry.torque_per_current=9.6")
        self.succeed("follow", "robot.csv", "--arm", "ur5", "--identified", "found")

    def test_identified_parameters_are_taken_over(self):
        self.identify("--set", "telemetry.torque_per_current=9.6")
        self.assertEqual(sorted(os.listdir(self.path("found"))), sorted(f"{name}.yaml" for name in SHORT_NAMES))
        before = self.succeed_json("follow", "robot.csv", "--arm", "ur5")["joints"]
        after = self.succeed_json("follow", "robot.csv", "--arm", "ur5", "--identified", "found")["joints"]
        for joint in (1, 2):
            self.assertEqual(after[joint]["joint"], SHORT_NAMES[joint])
            self.assertGreater(before[joint]["current_residual_rms"], 0.1)
            self.assertLess(after[joint]["current_residual_rms"], 0.15 * before[joint]["current_residual_rms"])

    def test_a_joint_that_is_not_there_is_named(self):
        arm_bag(self.path("short.bag"), [0, 1, 2, 3, 5])
        self.fail_with(1, ["never contains angle and effort of wrist_2_joint", "elbow_joint"], "follow", "short.bag",
                       "--arm", "ur5")
        self.write("short.csv", arm_csv(without=("actual_q_3", "actual_current_0")))
        self.fail_with(1, ["short.csv:1", "columns 'actual_q_3', 'actual_current_0' are missing"], "follow",
                       "short.csv", "--arm", "ur5")
        self.write("arm.csv", arm_csv())
        self.fail_with(1, ["holds no load"], "follow", "arm.csv", "--arm", "ur5", "--load", "target_moment")
        self.fail_with(1, ["arm crane", "arms"], "follow", "arm.csv", "--arm", "crane")
        self.fail_with(2, ["--joint"], "follow", "arm.csv", "--arm", "ur5", "--joint", "elbow")

    def compare(self, recording, *more, environment=None):
        return self.succeed_json("compare", recording, "--arm", "ur5", *more, environment=environment)

    def test_friction_of_one_joint_is_that_joint_and_of_all_is_not(self):
        sound = self.compare(self.robot_with_friction([]), "--report", "sound")
        self.assertEqual(sound["level"], "OK", sound)
        self.assertEqual([joint["joint"] for joint in sound["joints"]], SHORT_NAMES)
        for name in SHORT_NAMES:
            self.assertTrue(os.path.exists(self.path(f"sound/{name}/report.html")), name)
        with open(self.path("sound/report.html")) as file:
            page = file.read()
        for name in SHORT_NAMES:
            self.assertIn(f'href="{name}/report.html"', page)

        one = self.compare(self.robot_with_friction(["shoulder"]), "--reference", "sound")
        self.assertEqual({joint["joint"]: joint["level"] for joint in one["joints"]},
                         {name: "WARN" if name == "shoulder" else "OK" for name in SHORT_NAMES}, one)
        self.assertEqual(one["level"], "WARN")
        self.assertIn("shoulder: ", one["text"])

        every = self.compare(self.robot_with_friction(SHORT_NAMES), "--reference", "sound")
        self.assertEqual(every["level"], "OK", every)
        self.assertIn("temperature or gain", every["text"])
        self.assertAlmostEqual(every["friction_ratio"], 1.3, delta=0.05)

    def test_an_arm_whose_loads_no_joint_bears_is_not_judged_and_has_a_page(self):
        like = os.path.join(tool.CHECKOUT, "config/arms/ur5.yaml")
        self.write("heavy.yaml", f"like: {like}\npayload: {{mass: 10000.0, centre: [10.0, 10.0, 10.0]}}\n")
        self.write("arm.csv", arm_csv(seconds=5.0))
        heavy = self.succeed_json("compare", "arm.csv", "--arm", "heavy.yaml", "--report", "heavy")
        self.assertEqual({joint["level"] for joint in heavy["joints"]}, {"NOT JUDGED"})
        self.assertTrue(os.path.exists(self.path("heavy/report.html")))

    def test_rows_in_which_a_joint_is_pushed_are_left_out(self):
        path = self.robot_with_friction([])
        with open(self.path(path)) as file:
            rows = list(csv.reader(file))
        column = rows[0].index("actual_current_1")
        for row in rows[1:]:
            if 10.0 <= float(row[0]) < 10.6:
                row[column] = f"{float(row[column]) + 3.0}"  # some 32 N.m
        self.write("pushed.csv", "\n".join(",".join(row) for row in rows) + "\n")
        pushed = self.compare("pushed.csv")
        self.assertEqual(self.levels(pushed), dict.fromkeys(SHORT_NAMES, "OK"), pushed)
        self.assertRegex(pushed["text"],
                         r"shoulder: Something touched the arm, or its payload changed: at 10\..* Judged by the rest\.")
        self.assertNotIn("elbow: Something touched", pushed["text"])

    def levels(self, arm):
        return {joint["joint"]: joint["level"] for joint in arm["joints"]}

    def test_a_reference_made_warm_does_not_make_a_cold_arm_faulty(self):
        warm = self.compare(self.robot_with_friction([], degrees=40.0, is_recorded=True), "--report", "warm",
                            environment=tool.NO_PAGE)
        self.assertEqual({(joint["temperature"], joint["temperature_source"]) for joint in warm["joints"]},
                         {(40.0, "received")})
        cold = self.compare(self.robot_with_friction([], degrees=15.0, is_recorded=True), "--report", "cold",
                            "--reference", "warm", environment=tool.NO_PAGE)
        self.assertEqual(self.levels(cold), dict.fromkeys(SHORT_NAMES, "OK"), cold)
        self.assertEqual(cold["friction_ratio"], 1.0)
        self.assertIsNone(cold["temperature_estimate"])
        self.assertAlmostEqual(cold["temperature"], 15.0)
        for joint in cold["joints"]:
            self.assertAlmostEqual(joint["friction_ratio"], 1.0, delta=0.05, msg=joint)
        with open(self.path("cold/elbow/comparison.json")) as file:
            text = file.read()
        self.assertIn("At 15 degC (received), the reference at 40 degC", text)
        self.assertNotIn("Temperature: none is recorded", text)

        sick = self.compare(self.robot_with_friction(["elbow"], degrees=15.0, is_recorded=True), "--reference", "warm")
        self.assertEqual(self.levels(sick), {name: "WARN" if name == "elbow" else "OK" for name in SHORT_NAMES}, sick)

    def test_without_temperatures_that_of_the_common_friction_is_estimated(self):
        self.compare(self.robot_with_friction([], degrees=25.0), "--report", "usual", environment=tool.NO_PAGE)
        cold = self.compare(self.robot_with_friction([], degrees=8.0), "--reference", "usual")
        self.assertEqual(self.levels(cold), dict.fromkeys(SHORT_NAMES, "OK"), cold)
        self.assertGreater(cold["friction_ratio"], 1.15)
        self.assertAlmostEqual(cold["temperature_estimate"], 8.0, delta=2.0)
        self.assertIn("degC in place of 25 degC", cold["text"])
        self.assertEqual({joint["temperature_source"] for joint in cold["joints"]}, {"configured"})

        sick = self.compare(self.robot_with_friction(["base"], degrees=35.0), "--reference", "usual")
        self.assertEqual(self.levels(sick), {name: "WARN" if name == "base" else "OK" for name in SHORT_NAMES}, sick)

    def test_temperatures_follow_the_recording_and_bad_ones_are_never_used(self):
        def temperature(joint, row):
            bad = {5: "nan", 6: "1e9", 7: "", 8: "-40"}
            return bad[row] if joint == 2 and row in bad else f"{30.0 + joint + 0.001 * row:.3f}"

        self.write("arm.csv", arm_csv(temperature=temperature))
        found = self.succeed_json("follow", "arm.csv", "--arm", "ur5", "--out", "all")
        self.assertEqual(found["temperatures_refused"], 4)
        elbow = self.columns("all/elbow.csv")
        self.assertTrue(elbow["temperature_received"].all())
        expected = 32.0 + 0.001 * np.arange(2500)
        expected[5:9] = expected[4]  # the latest that can be true
        np.testing.assert_allclose(elbow["temperature"], expected, atol=1e-9)
        self.assertEqual(self.succeed_json("follow", "arm.csv", "--joint", "elbow", "--set", "telemetry.load=model",
                                           "--out", "elbow.csv")["temperatures_refused"], 4)
        np.testing.assert_array_equal(self.columns("elbow.csv")["temperature"], elbow["temperature"])

        with rosbag.Bag(self.path("arm.bag"), "w") as bag:
            for row in range(2500):
                at = genpy.Time(tool.START) + genpy.Duration.from_sec(row * PERIOD)
                state = JointState(name=tool.JOINT_NAMES, position=angles(row * PERIOD), effort=[0.0] * 6)
                state.header.stamp = at
                for frame, value in [("elbow_joint", 32.0), ("elbow_joint", float("nan")), ("cabinet", 50.0)]:
                    if row == 100:
                        measured = Temperature(temperature=value)
                        measured.header.stamp, measured.header.frame_id = at, frame
                        bag.write("/whatever/temperatures", measured, at)
                bag.write("/joint_states", state, at)
        found = self.succeed_json("follow", "arm.bag", "--arm", "ur5", "--out", "bag")
        self.assertEqual(found["temperatures_refused"], 1)
        elbow = self.columns("bag/elbow.csv")
        np.testing.assert_array_equal(elbow["temperature"], np.where(np.arange(2500) < 100, 25.0, 32.0))
        np.testing.assert_array_equal(elbow["temperature_received"], np.arange(2500) >= 100)
        self.assertFalse(self.columns("bag/base.csv")["temperature_received"].any())

    def test_a_reference_is_of_this_arm(self):
        os.mkdir(self.path("other"))
        compare = ("compare", "arm.csv", "--arm", "ur5", "--report", "report", "--reference", "other")
        self.write("arm.csv", arm_csv())
        self.fail_with(1, ["other", "no report", "arm.json"], *compare)
        with open(self.path("other/arm.json"), "w", encoding="ascii") as file:
            json.dump({"arm": "ur5e"}, file)
        self.fail_with(1, ["other", "of a ur5e, not of a ur5"], *compare)

    def test_a_report_is_not_its_own_reference(self):
        self.write("arm.csv", arm_csv())
        os.mkdir(self.path("report"))
        self.fail_with(1, ["same directory"], "compare", "arm.csv", "--arm", "ur5", "--report", "report", "--reference",
                       "report")

    @unittest.skipUnless(RECORDINGS, f"no recordings of a UR5 in {DIRECTORY}; name it in HJT_TELEMETRY_DIR")
    def test_no_sound_joint_of_a_ur5_is_called_faulty(self):
        for path in RECORDINGS[::3]:
            arm = self.compare(path)
            print(f"{os.path.basename(path):22} {arm['level']:4} {arm['text']}")
            self.assertEqual(arm["level"], "OK", (path, arm))

    @unittest.skipUnless(RECORDINGS, f"no recordings of a UR5 in {DIRECTORY}; name it in HJT_TELEMETRY_DIR")
    def test_uneven_rows_are_no_fault_without_velocities_either(self):
        with open(next(path for path in RECORDINGS if path.endswith("no2.csv"))) as file:
            rows = [line.split(",") for line in file.read().splitlines()]
        kept = [i for i, name in enumerate(rows[0]) if not name.startswith("actual_qd_")]
        self.write("no2.csv", "".join(",".join(row[i] for i in kept) + "\n" for row in rows))
        arm = self.compare("no2.csv")
        self.assertEqual(arm["level"], "OK", arm)
        for joint in arm["joints"][:3]:
            self.assertLess(joint["current_residual_rms"], 0.2 * joint["current_rms"] + 0.2, joint)

    @unittest.skipUnless(RECORDINGS, f"no recordings of a UR5 in {DIRECTORY}; name it in HJT_TELEMETRY_DIR")
    def test_load_agrees_with_the_controller_of_a_ur5(self):
        for path in RECORDINGS:
            with open(path) as file:
                header, *lines = file.read().splitlines()
            names = header.split(",")
            joints = self.succeed_json("follow", path, "--arm", "ur5")["joints"]
            for number, joint in enumerate(joints):
                column = names.index(f"target_moment_{number}")
                reported = [float(line.split(",")[column]) for line in lines]
                difference = joint["load_difference_rms"]
                span = max(reported) - min(reported)
                print(f"{os.path.basename(path):22} {joint['joint']:9} {difference:.3f} N.m of {span:.1f}")
                self.assertLess(difference, max(SLOW, FAST_SHARE * span), (path, joint["joint"]))


if __name__ == "__main__":
    tool.main()
