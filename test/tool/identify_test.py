# SPDX-License-Identifier: BSD-3-Clause
"""`joint_twin follow` and `joint_twin identify`: a robot's telemetry with the faults of real recordings."""
import io
import os
import random

import rosbag
import yaml
from sensor_msgs.msg import JointState

import robot
import tool

OPTIONS = ["--joint", "elbow", "--config", "joints/elbow.yaml"]


def write_telemetry(path, duration, faults=True):
    """With what real recordings have: messages dropped, cut short, without a number, repeated."""
    generator = random.Random(6)
    with rosbag.Bag(path, "w") as bag:
        for row, (stamp, state, load) in enumerate(robot.rows(duration)):
            if faults and generator.random() < 0.01:
                continue  # dropped
            bag.write(robot.LOAD_TOPIC, load, stamp)
            if faults and row % 1000 == 500:
                data = io.BytesIO()
                state.serialize(data)
                half = data.getvalue()[:len(data.getvalue()) // 2]
                bag.write(robot.STATES_TOPIC, (state._type, half, state._md5sum, JointState), stamp, raw=True)
            elif faults and row % 1000 == 700:
                state.effort[1] = float("nan")
                bag.write(robot.STATES_TOPIC, state, stamp)
            else:
                bag.write(robot.STATES_TOPIC, state, stamp)
                if faults and row % 50 == 0:
                    bag.write(robot.STATES_TOPIC, state, stamp)  # its stamp repeated


class Identify(tool.ToolTest):
    def test_a_bag_with_faults_gives_gain_and_friction_and_an_overlay_that_loads(self):
        write_telemetry(self.path("a.bag"), 60.0)
        found = self.succeed_json("identify", "a.bag", *OPTIONS, "--out", "found.yaml", "--folds", "4")
        values = {value["key"]: value for value in found["values"]}
        gain = values["telemetry.torque_per_current"]
        self.assertEqual(gain["refusal"], "")
        self.assertLess(abs(gain["value"] - robot.GAIN), gain["half_width"] + 0.01 * robot.GAIN)
        self.assertIn("temperature", values["bearing.viscosity_slope"]["refusal"])
        judged = found["judged"]
        self.assertLess(judged["identified"]["all"], 0.5 * judged["configured"]["all"])
        self.assertEqual(found["train"][1], found["judge"][0])
        left_out = found["left_out"]["identified"]
        self.assertLess(left_out["all"], 0.5 * judged["configured"]["all"])
        self.assertLess(abs(left_out["rows"] - 0.5 * judged["identified"]["rows"]), 50)
        with open(self.path("found.yaml")) as file:
            overlay = yaml.safe_load(file)  # as rosparam reads it
        for key in ("ripple_circular_spline_2", "ripple_flexspline_4"):
            self.assertEqual([type(value) for value in overlay["telemetry"][key]], [float, float])
        self.assertTrue(all(isinstance(value, float) for value in overlay["bearing"].values()))
        loaded = self.succeed_json("parameters", "--config", "joints/elbow.yaml", "--config", self.path("found.yaml"))
        self.assertIn(str(gain["value"])[:8], str(loaded))
        given = ["--set", "telemetry.load=target_moment"]
        before = self.succeed_json("follow", "a.bag", *OPTIONS, *given)
        after = self.succeed_json("follow", "a.bag", *OPTIONS, *given, "--config", self.path("found.yaml"), "--out",
                                  "a.csv")
        self.assertLess(after["current_residual_rms"], 0.5 * before["current_residual_rms"])
        self.assertIn(after["unreadable"], range(10, 15))  # of 14 some may have been dropped
        with open(self.path("a.csv")) as file:
            self.assertIn("current_predicted", file.readline())

        # The torque-driven twin has the identified friction too.
        speed = 0.6  # [rad/s]

        def friction(*options):
            rows = self.succeed_json("losses", "--speeds", str(robot.RATIO * speed), "--loads", "10", "--positions",
                                     "4",
                                     "--config", "joints/elbow.yaml", *options)["rows"]
            return robot.RATIO * (rows[0]["gear_loss"] + rows[0]["motor"])
        expected = robot.COULOMB + robot.VISCOUS * speed
        self.assertLess(abs(friction("--config", self.path("found.yaml")) - expected), 0.12 * expected)
        self.assertGreater(abs(friction() - expected), 0.12 * expected)

    def test_what_is_missing_is_named(self):
        write_telemetry(self.path("a.bag"), 2.0, faults=False)
        self.fail_with(1, ["shoulder_pan_joint", "joints found: elbow_joint, wrist_1_joint"], "follow", "a.bag",
                       "--joint",
                       "base")
        self.fail_with(1, ["no messages on /arm/joint_states", "/joint_states (sensor_msgs/JointState)"],
                       "follow", "a.bag", *OPTIONS, "--topic", "/arm/joint_states")
        self.write("broken.bag", "not a bag")
        self.fail_with(1, ["broken.bag cannot be read as a bag"], "follow", "broken.bag", *OPTIONS)
        self.fail_with(1, ["nowhere.bag"], "identify", "nowhere.bag", *OPTIONS)

    def test_a_recording_without_load_is_said_and_nothing_identified_is_no_success(self):
        robot.write_bag(self.path("no_load.bag"), 30.0, with_load=False)
        done = self.run_tool("identify", "no_load.bag", *OPTIONS)
        self.assertIn("holds no load", done.stderr)
        self.assertLessEqual(max(map(len, done.stdout.splitlines())), 100, done.stdout)
        generator = random.Random(7)
        rows = ["timestamp,actual_q_2,actual_current_2"]
        for row in range(3000):
            angle, _, _ = robot.telemetry(row / robot.RATE, generator)
            rows.append(f"{row / robot.RATE:.3f},{angle:.9f},{generator.gauss(0.0, 5.0):.6f}")
        self.write("noise.csv", "\n".join(rows) + "\n")
        done = self.run_tool("identify", "noise.csv", *OPTIONS, "--out", "noise.yaml")
        self.assertEqual(done.returncode, 1, done.stdout)
        self.assertIn("nothing could be identified", done.stderr)
        self.assertFalse(os.path.exists(self.path("noise.yaml")))

    def test_a_joint_at_rest_tells_nothing(self):
        rows = ["timestamp,actual_q_0,actual_current_0,target_moment_0"]
        rows += [f"{0.008 * row:.3f},0.5,0.1,1.0" for row in range(400)]
        self.write("a.csv", "\n".join(rows) + "\n")
        self.fail_with(1, ["the joint hardly moves"], "identify", "a.csv", "--joint", "base")
        self.fail_with(1, ["ends before it begins"], "identify", "a.csv", "--joint", "base", "--train", 5, 1)
        for joint in ("7", "Elbow", "left_elbow_joint"):
            for command in (("identify",), ("compare", "--json"), ("follow",)):
                self.fail_with(1, ["a.csv", "wrist_3", f"'{joint}'"], *command, "a.csv", "--joint", joint)

    def test_a_long_bag_costs_no_more_memory_and_a_small_part_of_its_time(self):
        peaks = []
        for duration in (30.0, 240.0):
            write_telemetry(self.path("long.bag"), duration, faults=False)
            code, took, peak = self.measure("follow", "long.bag", *OPTIONS)
            self.assertEqual(code, 0)
            self.assertLess(took, 5.0 + duration / 20.0)
            peaks.append(peak)
        # The bag's own index grows, by some hundred bytes a message; two topics.
        self.assertLess(peaks[1] - peaks[0], 200 * 2 * 125 * 210 + 2 * 1024 ** 2, peaks)


if __name__ == "__main__":
    tool.main()
