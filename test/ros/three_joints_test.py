#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Several twins on one master: namespaces keep them apart, and topics can be given other names."""
import sys
import unittest

import rospy
import rostest
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64

from harmonic_joint_twin.msg import Encoders
from ros_support import PACKAGE, Diagnostics, Listener, wait_until

JOINTS = {"base": "shoulder_pan_joint", "shoulder": "shoulder_lift_joint", "elbow": "elbow_joint"}


class ThreeJoints(unittest.TestCase):
    def turn(self, topic, encoders):
        """Drives until the encoders' motor has turned."""
        publisher = rospy.Publisher(topic, Float64, queue_size=10)
        wait_until(lambda: publisher.get_num_connections() > 0, f"a subscriber of {topic}")

        def has_turned():
            publisher.publish(0.4)
            return encoders.messages() and encoders.messages()[-1].motor_angle_true > 1.0

        wait_until(has_turned, "the motor to turn")
        publisher.unregister()

    def test_each_twin_obeys_its_own_command_only(self):
        encoders = {joint: Listener(f"/robot/{joint}/joint_twin/encoders", Encoders) for joint in JOINTS}
        for joint, listener in encoders.items():
            self.assertEqual(listener.wait_for(10)[-1].header.frame_id, JOINTS[joint])
        self.turn("/robot/shoulder/joint_twin/motor_torque_command", encoders["shoulder"])
        for joint in ("base", "elbow"):
            self.assertLess(abs(encoders[joint].messages()[-1].motor_angle_true), 0.01, joint)

    def test_each_twin_reports_under_its_own_name(self):
        for joint in JOINTS:
            diagnostics = Diagnostics(f"/robot/{joint}/joint_twin")
            wait_until(lambda: diagnostics.values("Drive"), f"diagnostics of {joint}")

    def test_topics_can_be_remapped(self):
        states = Listener("/states_of_all", JointState)
        self.assertEqual(states.wait_for(10)[-1].header.frame_id, "elbow_joint")
        self.turn("/controller/torque", Listener("/remapped/joint_twin/encoders", Encoders))


if __name__ == "__main__":
    rospy.init_node("three_joints_test")
    rostest.rosrun(PACKAGE, "three_joints", ThreeJoints, sys.argv)
