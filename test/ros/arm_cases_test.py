#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Two arms and a gripper on one topic, their names with prefixes. The angles of the left one are folded into one turn,
and one of its joints has no effort; the right one picks up a payload that nobody configured."""
import math
import os
import shutil
import sys
import tempfile
import time
import unittest

import rospy
import rostest
from sensor_msgs.msg import JointState

from harmonic_joint_twin.msg import Comparison, Verdict
from ros_support import OK, PACKAGE, Diagnostics, Listener, package_path, wait_until
from ur5_test import JOINTS, PERIOD, WAIT_OF_ARM, angles, run_robot

SECONDS = 80.0  # longer than the motion after which a payload is looked for and tried
PICKED = 35.0   # after a first look without a payload [s]
FASTER = 2.0    # played than stamped
SILENT = "wrist_2"
MASS = 3.0      # of the payload [kg]
SHIFT = 2.8     # of the left arm's base, which turns beyond half a turn [rad]


def folded(angle):
    return (angle + math.pi) % (2.0 * math.pi) - math.pi


def turned(seconds):
    base, *others = angles(seconds)
    return [base + SHIFT, *others]


class ArmCases(unittest.TestCase):
    def setUp(self):
        self.directory = tempfile.mkdtemp(prefix="arm_cases_test_")
        self.addCleanup(shutil.rmtree, self.directory)
        sides = [(side, joint) for side in ("left", "right") for joint in JOINTS]
        self.diagnostics = {key: Diagnostics("/{}/{}/joint_twin".format(*key)) for key in sides}
        self.verdicts = {key: Listener("/{}/{}/joint_twin/verdict".format(*key), Verdict) for key in sides}
        self.comparisons = [Listener(f"/{side}/wrist_3/joint_twin/comparison", Comparison)
                            for side in ("left", "right")]
        self.publisher = rospy.Publisher("/joint_states", JointState, queue_size=1000)
        wait_until(lambda: self.publisher.get_num_connections() == 2, "both nodes")
        for listener in self.comparisons:
            listener.wait_for_connection()

    def play(self):
        loaded = os.path.join(self.directory, "loaded.yaml")
        with open(loaded, "w", encoding="ascii") as file:
            file.write(f"like: {package_path('config', 'arms', 'ur5.yaml')}\n"
                       f"payload: {{mass: {MASS}, centre: [0.0, 0.03, 0.08]}}\n")
        left = run_robot(self.directory, turned, SECONDS, 0.0)
        rows = round(PICKED / PERIOD)
        right = (run_robot(self.directory, angles, SECONDS, 0.0)[:rows] +
                 run_robot(self.directory, angles, SECONDS, 0.0, loaded)[rows:])
        silent = list(JOINTS).index(SILENT)
        begin = self.begin = rospy.Time.now()
        for row, ((left_angles, left_currents), (right_angles, right_currents)) in enumerate(zip(left, right)):
            time.sleep(max(0.0, (begin - rospy.Time.now()).to_sec() + PERIOD * row / FASTER))
            left_currents[silent] = float("nan")
            message = JointState(
                name=[side + name for side in ("left_", "right_") for name in JOINTS.values()] + ["finger_joint"],
                position=[folded(angle) for angle in left_angles] + list(right_angles) + [0.1],
                effort=left_currents + right_currents + [0.0])
            message.header.stamp = begin + rospy.Duration.from_sec(PERIOD * row)
            self.publisher.publish(message)
        for listener in self.comparisons:
            listener.wait_for(len(left) - 200 - WAIT_OF_ARM, patience=60.0)

    def levels(self, side):
        """Of all verdicts, by joint."""
        return {joint: {message.level for message in self.verdicts[side, joint].messages()} for joint in JOINTS}

    def test_each_arm_is_judged_by_itself(self):
        self.play()
        for joint in JOINTS:
            expected = Verdict.NOT_JUDGED if joint == SILENT else Verdict.OK
            wait_until(lambda joint=joint, expected=expected:
                       self.verdicts["left", joint].messages()[-1].level == expected, f"the verdict on left {joint}")
        self.assertEqual(self.verdicts["left", SILENT].messages()[-1].reason, Verdict.EFFORT_CONSTANT)
        self.assertGreater(self.diagnostics["left", "base"].number("Input", "Jumps of angles by a turn, taken out"), 0)
        payload = self.diagnostics["right", "base"].values("Input")["Payload that is not configured"]
        self.assertIn("look like a payload of", payload)
        mass, half_width = (float(text) for text in payload.split("payload of ")[1].split(" kg")[0].split(" +- "))
        self.assertLess(abs(mass - MASS), half_width + 0.05, payload)
        since = sum(int(part) * unit for part, unit in
                    zip(payload.split("; since ")[1].split(" UTC")[0].split(":"), (3600, 60, 1)))
        picked = self.begin.to_sec() + PICKED
        self.assertLess(abs((since - picked + 43200.0) % 86400.0 - 43200.0), 3.0, payload)
        other = self.diagnostics["left", "base"].values("Input")
        self.assertEqual(other["Payload that is not configured"], "none found")
        for side in ("left", "right"):
            self.assertFalse({Verdict.WARN, Verdict.ERROR} & set.union(*self.levels(side).values()), self.levels(side))
        for key, other in self.diagnostics.items():
            self.assertEqual({status.level for status in other.statuses("Drive") if status.values and
                              "Nothing" not in status.message and "stopped" not in status.message}, {OK}, key)


if __name__ == "__main__":
    rospy.init_node("arm_cases_test")
    rostest.rosrun(PACKAGE, "arm_cases", ArmCases, sys.argv)
