# SPDX-License-Identifier: BSD-3-Clause
"""One law for the time of an input: the same rows give the same bits as a profile of the tool, as arrays, as stamped
commands and as a bag. (The co-simulation unit is compared with a profile in test/tool/fmu_test.py, the live node with a
bag in test/ros/replay_test.py.) Argument: the tool."""
import os
import subprocess
import sys
import tempfile
import unittest

import genpy
import numpy as np
import rosbag
from sensor_msgs.msg import JointState

import harmonic_joint_twin as hjt

TOOL = sys.argv.pop(1)
START = 1000000000  # [s] ROS time of the first row
JOINT = "elbow_joint"
PERIOD = 8        # of the rows [ms]
ROWS = 40
NAMES = {"motor_angle_true": "motor_angle", "output_angle_true": "output_angle"}  # of ~encoders, of the outputs


def rows():
    """Motor torque and load of each row [N.m]: both change in every one, and the motor turns round."""
    row = np.arange(ROWS)
    return 0.6 * np.sin(2.0 * np.pi * row / 25.0), 20.0 + 15.0 * np.cos(2.0 * np.pi * row / 17.0)


class InputTimes(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def run_tool(self, *arguments):
        subprocess.run([TOOL, *arguments], stdout=subprocess.DEVNULL, check=True)

    def profile(self, scene):
        """Columns of the tool's run of the rows, one a millisecond."""
        torque, load = rows()
        with open(self.path("profile.csv"), "w", encoding="ascii") as file:
            file.write("time,motor_torque,load_torque\n")
            for row in range(ROWS):
                file.write(f"{1e-3 * PERIOD * row!r},{float(torque[row])!r},{float(load[row])!r}\n")
        self.run_tool("simulate", "--profile", self.path("profile.csv"), "--set", f"solver.scene={scene}", "--out",
                      self.path("run.csv"), "--force")
        return np.genfromtxt(self.path("run.csv"), delimiter=",", names=True)

    @staticmethod
    def twin(scene):
        twin = hjt.Twin(hjt.Parameters({"solver.scene": scene}))
        twin.reset(START * 10**9)
        return twin

    def assert_same(self, found, expected):
        self.assertGreater(np.ptp(expected["motor_angle"]), 1.0)
        self.assertLess(np.min(np.diff(expected["motor_angle"])), 0.0)
        for name in NAMES.values():
            np.testing.assert_array_equal(found[name], expected[name][:len(found[name])], name)

    def test_arrays_are_the_rows_of_a_profile(self):
        for scene in "auto", "full_ring":
            expected = self.profile(scene)
            twin = self.twin(scene)
            held = PERIOD * 10**6 // twin.step_length  # steps
            torque, load = (np.repeat(each, held)[:held * (ROWS - 1)] for each in rows())
            self.assert_same(twin.run(motor_torque=torque, load_torque=load, every=held // PERIOD), expected)

    def test_stamped_commands_are_the_rows_of_a_profile(self):
        """Commands that come a row ahead, in the order load, torque."""
        expected = self.profile("auto")
        twin = self.twin("auto")
        found = []
        torque, load = rows()
        for row in range(ROWS - 1):
            stamp = START * 10**9 + PERIOD * 10**6 * row
            twin.command_load_torque(float(load[row]), stamp=stamp)
            twin.command_motor_torque(float(torque[row]), stamp=stamp)
            found.append(twin.run(PERIOD * 10**6 // twin.step_length, every=10**6 // twin.step_length))
        self.assert_same(np.concatenate(found), expected)

    def test_a_bag_is_the_rows_of_a_profile(self):
        expected = self.profile("auto")
        torque, load = rows()
        with rosbag.Bag(self.path("in.bag"), "w") as bag:
            for row in range(ROWS):
                stamp = genpy.Time(START) + genpy.Duration(0, PERIOD * 10**6 * row)
                for topic, value in ("load", load[row]), ("command", torque[row]):
                    message = JointState(name=[JOINT], effort=[value])
                    message.header.stamp = stamp
                    bag.write(f"/joint_twin/{topic}", message, stamp)
        self.run_tool("replay", self.path("in.bag"), "--out", self.path("out.bag"), "--set", f"joint.name={JOINT}",
                      "--set", "solver.scene=auto")
        with rosbag.Bag(self.path("out.bag")) as bag:
            encoders = [message for _, message, _ in bag.read_messages(["/joint_twin/encoders"])]
        self.assertGreater(len(encoders), PERIOD * (ROWS - 1) - 2)
        self.assertEqual(encoders[0].header.stamp, genpy.Time(START, 10**6))
        self.assert_same({name: np.array([getattr(message, field) for message in encoders])
                          for field, name in NAMES.items()}, expected)


if __name__ == "__main__":
    unittest.main()
