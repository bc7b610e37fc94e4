# SPDX-License-Identifier: BSD-3-Clause
"""`--arm`: all joints of a recorded arm at once, their load from the angles of all.

The synthetic arm's currents are those that the twin predicts; recordings of a UR5 are used where they are at hand, in
HJT_TELEMETRY_DIR, else in shared/telemetry beside the checkout.
"""
import glob
import json
import os
import unittest

import genpy
import numpy as np
import rosbag
from sensor_msgs.msg import Temperature

import tool
from recorded import NAMES, sound, states, swinging, write_bag, write_csv

PERIOD = 0.008
DIRECTORY = os.environ.get("HJT_TELEMETRY_DIR", os.path.join(tool.CHECKOUT, "..", "shared", "telemetry"))
RECORDINGS = sorted(glob.glob(os.path.join(DIRECTORY, "ur5_cb", "*.csv")))


class ArmTest(tool.ToolTest):
    """A test with a made-up arm."""

    def columns(self, path):
        return tool.read_columns(self.path(path))

    def robot(self, raised=(), share=0.3, path="robot.csv", degrees=25.0, is_recorded=False, start=0.0):
        """A robot that is the twin at a temperature, friction of these joints raised by a share."""
        columns = sound(self, raised=raised, share=share, changes=(f"input.temperature={degrees}",))
        columns["timestamp"] = start + columns["timestamp"]
        if is_recorded:
            columns.update((f"joint_temperatures_{joint}", np.full_like(columns["timestamp"], degrees))
                           for joint in range(6))
        write_csv(self.path(path), columns)
        return path


class Arm(ArmTest):
    def test_load_is_that_of_all_joints_however_they_are_recorded(self):
        columns = swinging(20.0)
        write_csv(self.path("arm.csv"), columns)
        write_bag(self.path("arm.bag"), states(columns))
        self.succeed("follow", "arm.csv", "--arm", "ur5", "--out", "from_csv")
        own_file = os.path.join(tool.CHECKOUT, "config/arms/ur5.yaml")
        self.succeed("follow", "arm.bag", "--arm", own_file, "--out", "from_bag")
        self.assertEqual(sorted(os.listdir(self.path("from_csv"))), sorted(f"{name}.csv" for name in NAMES))
        for name in NAMES:
            columns = self.columns(f"from_csv/{name}.csv")
            self.assertEqual(len(columns["time"]), 2500)
            np.testing.assert_allclose(self.columns(f"from_bag/{name}.csv")["load_torque"], columns["load_torque"],
                                       atol=1e-4)
        self.assertGreater(abs(self.columns("from_csv/shoulder.csv")["load_torque"][50]), 50.0)

    def test_topics_of_the_node_are_added_to_a_bag(self):
        columns = swinging(5.0)
        columns.update((f"actual_current_{joint}", np.full(625, 1.5)) for joint in range(6))
        write_bag(self.path("arm.bag"), states(columns))
        self.succeed("follow", "arm.bag", "--arm", "ur5", "--bag", "all.bag", "--out", "rows")
        with rosbag.Bag(self.path("arm.bag")) as bag:
            original = list(bag.read_messages(raw=True))
        with rosbag.Bag(self.path("all.bag")) as bag:
            kept = list(bag.read_messages("/joint_states", raw=True))
            self.assertEqual([(m.message[1], m.timestamp) for m in kept],
                             [(m.message[1], m.timestamp) for m in original])
            for name in NAMES:
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
                                           [(31.6 if name in NAMES[:3] else 57.0) * abs(torques[m.header.stamp])
                                            for m in forces], rtol=0.015, atol=5.0)
                verdicts = [m.message for m in bag.read_messages(f"/{name}/joint_twin/verdict")]
                self.assertEqual({m.joint for m in verdicts}, {tool.JOINT_NAMES[NAMES.index(name)]})
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
        write_csv(self.path("robot.csv"), sound(self, 20.0, changes=changes))
        self.fail_with(1, ["judge: only for a single joint"], "identify", "robot.csv", "--arm", "ur5", "--judge", "0,9")
        self.succeed("identify", "robot.csv", "--arm", "ur5", "--out", "found")

    def test_no_overlay_is_out_of_range(self):
        # A motor lighter than the wave generator alone is taken to be.
        self.identify("motor.rotor_inertia=1.0e-9", "motor.wave_generator_inertia=1.0e-6",
                      "telemetry.torque_per_current=9.6")
        self.succeed("follow", "robot.csv", "--arm", "ur5", "--identified", "found")

    def test_identified_parameters_are_taken_over(self):
        self.identify("telemetry.torque_per_current=9.6")
        self.assertEqual(sorted(os.listdir(self.path("found"))), sorted(f"{name}.yaml" for name in NAMES))
        before = self.succeed_json("follow", "robot.csv", "--arm", "ur5")["joints"]
        after = self.succeed_json("follow", "robot.csv", "--arm", "ur5", "--identified", "found")["joints"]
        for joint in (1, 2):
            self.assertEqual(after[joint]["joint"], NAMES[joint])
            self.assertGreater(before[joint]["current_residual_rms"], 0.1)
            self.assertLess(after[joint]["current_residual_rms"], 0.15 * before[joint]["current_residual_rms"])

    def test_a_joint_that_is_not_there_is_named(self):
        columns = swinging(3.0)
        write_bag(self.path("short.bag"), states(columns, left_out=4))
        self.fail_with(1, ["never contains angle and effort of wrist_2_joint", "elbow_joint"], "follow", "short.bag",
                       "--arm", "ur5")
        write_csv(self.path("short.csv"), {name: values for name, values in columns.items()
                                           if name not in ("actual_q_3", "actual_current_0")})
        self.fail_with(1, ["short.csv:1", "columns 'actual_q_3', 'actual_current_0' are missing"], "follow",
                       "short.csv", "--arm", "ur5")
        write_csv(self.path("arm.csv"), columns)
        self.fail_with(1, ["holds no load"], "follow", "arm.csv", "--arm", "ur5", "--load", "target_moment")
        self.fail_with(1, ["arm crane", "arms"], "follow", "arm.csv", "--arm", "crane")
        self.fail_with(2, ["--joint"], "follow", "arm.csv", "--arm", "ur5", "--joint", "elbow")

    def compare(self, recording, *more, environment=None):
        return self.succeed_json("compare", recording, "--arm", "ur5", *more, environment=environment)

    def test_friction_of_one_joint_beside_a_report_is_that_joints(self):
        sound = self.compare(self.robot(), "--report", "sound")
        self.assertEqual(sound["level"], "OK", sound)
        self.assertEqual([joint["joint"] for joint in sound["joints"]], NAMES)
        for name in NAMES:
            self.assertTrue(os.path.exists(self.path(f"sound/{name}/report.html")), name)
        with open(self.path("sound/report.html")) as file:
            page = file.read()
        for name in NAMES:
            self.assertIn(f'href="{name}/report.html"', page)

        one = self.compare(self.robot(["shoulder"]), "--reference", "sound")
        self.assertEqual({joint["joint"]: joint["level"] for joint in one["joints"]},
                         {name: "WARN" if name == "shoulder" else "OK" for name in NAMES}, one)
        self.assertEqual(one["level"], "WARN")
        self.assertIn("shoulder: ", one["text"])

    def test_an_arm_whose_loads_no_joint_bears_is_not_judged_and_has_a_page(self):
        like = os.path.join(tool.CHECKOUT, "config/arms/ur5.yaml")
        self.write("heavy.yaml", f"like: {like}\npayload: {{mass: 10000.0, centre: [10.0, 10.0, 10.0]}}\n")
        write_csv(self.path("arm.csv"), swinging(5.0))
        heavy = self.succeed_json("compare", "arm.csv", "--arm", "heavy.yaml", "--report", "heavy")
        self.assertEqual({joint["level"] for joint in heavy["joints"]}, {"NOT JUDGED"})
        self.assertTrue(os.path.exists(self.path("heavy/report.html")))

    def levels(self, arm):
        return {joint["joint"]: joint["level"] for joint in arm["joints"]}

    def test_a_reference_made_warm_does_not_make_a_cold_arm_faulty(self):
        warm = self.compare(self.robot(degrees=40.0, is_recorded=True), "--report", "warm",
                            environment=tool.NO_PAGE)
        self.assertEqual({(joint["temperature"], joint["temperature_source"]) for joint in warm["joints"]},
                         {(40.0, "received")})
        cold = self.compare(self.robot(degrees=15.0, is_recorded=True), "--report", "cold",
                            "--reference", "warm", environment=tool.NO_PAGE)
        self.assertEqual(self.levels(cold), dict.fromkeys(NAMES, "OK"), cold)
        self.assertEqual(cold["friction_ratio"], 1.0)
        self.assertIsNone(cold["temperature_estimate"])
        self.assertAlmostEqual(cold["temperature"], 15.0)
        for joint in cold["joints"]:
            self.assertAlmostEqual(joint["friction_ratio"], 1.0, delta=0.05, msg=joint)
        with open(self.path("cold/elbow/comparison.json")) as file:
            text = file.read()
        self.assertIn("The joint has 15 degC (received), the reference 40 degC", text)
        self.assertNotIn("no temperature was recorded", text)

    def test_temperatures_follow_the_recording_and_bad_ones_are_never_used(self):
        columns = swinging(20.0)
        measured = {f"joint_temperatures_{joint}": 30.0 + joint + 0.001 * np.arange(2500) for joint in range(6)}
        measured["joint_temperatures_2"][5:8] = [np.nan, 1e9, -40.0]
        write_csv(self.path("arm.csv"), {**columns, **measured})
        found = self.succeed_json("follow", "arm.csv", "--arm", "ur5", "--out", "all")
        self.assertEqual(found["temperatures_refused"], 3)
        elbow = self.columns("all/elbow.csv")
        self.assertTrue(elbow["temperature_received"].all())
        expected = 32.0 + 0.001 * np.arange(2500)
        expected[5:8] = expected[4]  # the latest that can be true
        np.testing.assert_allclose(elbow["temperature"], expected, atol=1e-9)
        self.assertEqual(self.succeed_json("follow", "arm.csv", "--joint", "elbow", "--set", "telemetry.load=model",
                                           "--out", "elbow.csv")["temperatures_refused"], 3)
        np.testing.assert_array_equal(self.columns("elbow.csv")["temperature"], elbow["temperature"])

        at = genpy.Time(tool.START) + genpy.Duration.from_sec(100 * PERIOD)
        with rosbag.Bag(write_bag(self.path("arm.bag"), states(columns)), "a") as bag:
            for frame, value in [("elbow_joint", 32.0), ("elbow_joint", float("nan")), ("cabinet", 50.0)]:
                measured = Temperature(temperature=value)
                measured.header.stamp, measured.header.frame_id = at, frame
                bag.write("/whatever/temperatures", measured, at)
        found = self.succeed_json("follow", "arm.bag", "--arm", "ur5", "--out", "bag")
        self.assertEqual(found["temperatures_refused"], 1)
        elbow = self.columns("bag/elbow.csv")
        np.testing.assert_array_equal(elbow["temperature"], np.where(np.arange(2500) < 100, 25.0, 32.0))
        np.testing.assert_array_equal(elbow["temperature_received"], np.arange(2500) >= 100)
        self.assertFalse(self.columns("bag/base.csv")["temperature_received"].any())

    def test_a_reference_is_of_this_arm(self):
        for name in ("other", "report"):
            os.mkdir(self.path(name))
        compare = ("compare", "arm.csv", "--arm", "ur5", "--report", "report", "--reference", "other")
        write_csv(self.path("arm.csv"), swinging(3.0))
        self.fail_with(1, ["other lacks arm.json, a file of a report"], *compare)
        with open(self.path("other/arm.json"), "w", encoding="ascii") as file:
            json.dump({"arm": "ur5e"}, file)
        self.fail_with(1, ["other", "is a report on the arm ur5e, not on ur5"], *compare)
        self.fail_with(1, ["same directory"], *compare[:-1], "report")

    @unittest.skipUnless(RECORDINGS, f"no recordings of a UR5 in {DIRECTORY}; name it in HJT_TELEMETRY_DIR")
    def test_no_sound_joint_of_a_ur5_is_called_faulty(self):
        for path in RECORDINGS[::3]:
            arm = self.compare(path)
            print(f"{os.path.basename(path):22} {arm['level']:4} {arm['text']}")
            self.assertEqual(arm["level"], "OK", (path, arm))


if __name__ == "__main__":
    tool.main()
