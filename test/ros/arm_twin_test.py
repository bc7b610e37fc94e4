#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""The live twin of a whole arm in place of a robot, and arm.launch beside it as beside a robot."""
import itertools
import math
import sys
import time
import unittest

import rospy
import rostest
from geometry_msgs.msg import Inertia, PoseStamped, WrenchStamped
from rosgraph_msgs.msg import Log
from sensor_msgs.msg import JointState, Temperature
from std_srvs.srv import Trigger
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from harmonic_joint_twin.msg import Health, Timing
from ros_support import OK, PACKAGE, PATIENCE, SLOWNESS, STALE, Diagnostics, Listener, numbers_in, wait_until

NODE = "/arm_twin"
JOINTS = {"base": "shoulder_pan_joint", "shoulder": "shoulder_lift_joint", "elbow": "elbow_joint",
          "wrist_1": "wrist_1_joint", "wrist_2": "wrist_2_joint", "wrist_3": "wrist_3_joint"}
NAMES = sorted(JOINTS.values())  # as UR's driver orders them
START = dict(zip(JOINTS.values(), (0.0, -math.pi / 2, 0.0, -math.pi / 2, 0.0, 0.0)))
PERIOD = 0.008  # of the states [s]


class ArmTwin(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.states = Listener("/joint_states", JointState)
        cls.command = rospy.Publisher(f"{NODE}/command", JointTrajectory, queue_size=10)
        cls.wrench = rospy.Publisher(f"{NODE}/wrench", WrenchStamped, queue_size=10)
        cls.payload = rospy.Publisher(f"{NODE}/payload", Inertia, queue_size=10)
        cls.temperature = rospy.Publisher("/joint_temperatures", Temperature, queue_size=10)
        cls.log = Listener("/rosout", Log)
        cls.diagnostics = {namespace + joint: Diagnostics(f"/{namespace}{joint}/joint_twin")
                           for namespace in ("", "worn/") for joint in JOINTS}
        cls.states.wait_for(10, 4.0 * PATIENCE)  # the first time it builds its tables
        for publisher, readers in ((cls.command, 1), (cls.wrench, 1), (cls.payload, 1), (cls.temperature, 4)):
            wait_until(lambda each=publisher, n=readers: each.get_num_connections() == n, publisher.name)

    def last(self):
        message = self.states.messages()[-1]
        return dict(zip(message.name, message.position))

    def send(self, *points, names=NAMES, stamp=rospy.Time()):
        """Angles by joint, times [s]."""
        message = JointTrajectory(joint_names=names)
        message.header.stamp = stamp
        for angles, at in points:
            message.points.append(JointTrajectoryPoint(positions=[angles[name] for name in names],
                                                       time_from_start=rospy.Duration.from_sec(at)))
        self.command.publish(message)

    def go(self, angles, duration):
        self.send((angles, duration))
        wait_until(lambda: max(abs(self.last()[name] - angles[name]) for name in NAMES) < 2e-3, f"the arm at {angles}")

    def said(self, text):
        wait_until(lambda: any(text in message.msg for message in self.log.messages()), text)

    def test_1_arm_beside_it_finds_it_sound_and_the_worn_joint_of_another(self):
        def friction(namespace, joint):
            """Level of that finding."""
            return self.diagnostics[namespace + joint].values("Drive").get("Friction", "").split(".")[0]

        for namespace, sick in (("", None), ("worn/", "elbow")):
            expected = {joint: "WARN" if joint == sick else "OK" for joint in JOINTS}
            try:
                wait_until(lambda n=namespace, e=expected: {joint: friction(n, joint) for joint in JOINTS} == e,
                           f"the verdicts on {namespace or 'the sound arm'}", 4.0 * PATIENCE)
            except AssertionError:
                self.assertEqual({joint: self.diagnostics[namespace + joint].values("Drive") for joint in JOINTS}, {})
        for joint in JOINTS:
            levels = {status.level for status in self.diagnostics[joint].statuses("Drive")}
            self.assertEqual(levels - {STALE}, {OK}, joint)  # stale before the first row

    def test_2_it_publishes_as_the_driver_does(self):
        messages = self.states.messages()[-500:]
        self.assertEqual({tuple(message.name) for message in messages}, {tuple(NAMES)})
        self.assertTrue(all(math.isfinite(value) for message in messages for value in numbers_in(message)))
        stamps = [message.header.stamp.to_nsec() for message in messages]
        self.assertEqual({b - a for a, b in zip(stamps, stamps[1:])}, {round(1e9 * PERIOD)})
        elbow = NAMES.index("elbow_joint")
        slopes = [(b.position[elbow] - a.position[elbow]) / (2 * PERIOD) - m.velocity[elbow]
                  for a, m, b in zip(messages, messages[1:], messages[2:])]
        self.assertLess(max(map(abs, slopes)), 0.1)

    def test_3_it_follows_a_trajectory_and_its_tool_with_it(self):
        tool, wanted = (Listener(f"{NODE}/{name}", PoseStamped) for name in ("tool_pose", "wanted_tool_pose"))
        there = {name: angle + 0.2 for name, angle in START.items()}
        self.go(there, 2.0)
        time.sleep(0.5)
        places = [listener.messages()[-1].pose.position for listener in (tool, wanted)]
        self.assertEqual(tool.messages()[-1].header.frame_id, "base")
        apart = math.dist(*((place.x, place.y, place.z) for place in places))
        self.assertLess(apart, 2e-3)
        self.assertGreater(apart, 0.0)

    def test_4_what_it_cannot_follow_is_refused_and_said(self):
        self.send((dict(START, knee_joint=0.0), 2.0), names=NAMES[:2] + ["knee_joint"])
        self.said("Refused a trajectory on ~command: the arm has no joint knee_joint; the message names elbow_joint, ")
        time.sleep(1.1)  # one warning a second
        self.send((START, 2.0), stamp=rospy.Time.now() + rospy.Duration(90000))
        self.said("Refused a trajectory on ~command: its stamp is more than a day ahead of the clock")
        time.sleep(1.1)
        self.send((dict(START, elbow_joint=float("nan")), 5.0))
        self.said("points[0]: not all values are finite")
        time.sleep(1.1)
        wrench = WrenchStamped()
        wrench.header.frame_id = "tool"
        self.wrench.publish(wrench)
        self.said("Refused a wrench on ~wrench: frame_id = 'tool', allowed: 'base' or none")

    def test_5_a_weight_at_the_tool_takes_current(self):
        level = dict(START, shoulder_lift_joint=-0.4)
        self.go(level, 3.0)

        def current():
            time.sleep(1.0)
            lift = NAMES.index("shoulder_lift_joint")
            rows = self.states.messages()[-60:]
            return sum(row.effort[lift] for row in rows) / len(rows)

        before = current()
        wrench = WrenchStamped()
        wrench.wrench.force.z = -30.0
        self.wrench.publish(wrench)
        heavier = current() - before
        self.wrench.publish(WrenchStamped())
        # 30 N at 0.3 to 0.9 m over 10.7 N.m/A, less what friction bears.
        self.assertGreater(abs(heavier), 0.3)
        for mass in (-1.0, 3.0):
            self.payload.publish(Inertia(m=mass))
        self.said("Refused a payload on ~payload: mass = -1.0 [kg] is out of range, allowed: 0 ... 10000")
        # As heavy, but fed forward: what friction bears of a push differs by as much as the friction.
        self.assertGreater(math.copysign(1.0, heavier) * (current() - before), 0.3)
        self.payload.publish(Inertia())

    def test_5_a_temperature_is_that_of_the_named_drive(self):
        health = Listener("/elbow/arm_twin/health", Health)
        # The topic is shared with the other arm, whose joints have other names.
        for joint, degrees in (("left_elbow_joint", 20.0), ("elbow_joint", 200.0), ("elbow_joint", 32.0)):
            message = Temperature(temperature=degrees)
            message.header.frame_id = joint
            self.temperature.publish(message)
        self.said("Ignored a message on ~joint_temperatures: frame_id = 'left_elbow_joint' is not a joint of this arm")
        self.said("Refused a temperature on ~joint_temperatures: temperature = 200.0 [degC] is out of range")
        wait_until(lambda: health.messages() and health.messages()[-1].grease_temperature == 32.0, "the temperature")

    def test_7_it_keeps_up_and_restarts_on_request(self):
        timing = Listener(f"{NODE}/timing", Timing).wait_for(2)[-1]
        print(f"load of the loop {timing.load:.3f}")
        self.assertGreater(timing.real_time_factor, 0.99 / SLOWNESS)
        self.assertTrue(rospy.ServiceProxy(f"{NODE}/reset", Trigger)().success)
        self.states.clear()
        wait_until(lambda: max(abs(self.last()[name] - START[name]) for name in NAMES) < 2e-3
                   if self.states.messages() else False, "the arm at its start")

    def test_8_what_is_too_much_for_real_time_is_said_and_a_reset_is_answered(self):
        diagnostics = Diagnostics(NODE)
        wait_until(lambda: diagnostics.statuses("Timing"), "diagnostics")
        reset = rospy.ServiceProxy(f"{NODE}/reset", Trigger)
        for side in itertools.cycle((1000.0, -1000.0)):
            wrench = WrenchStamped()
            wrench.wrench.force.x, wrench.wrench.torque.x = side, -side
            wrench.wrench.force.y, wrench.wrench.torque.y = -side, side
            self.wrench.publish(wrench)
            time.sleep(0.05)
            if "behind the clock" in diagnostics.statuses("Timing")[-1].message:
                break
        self.said("s behind the clock")
        self.assertLess(Listener(f"{NODE}/timing", Timing).wait_for(1)[-1].real_time_factor, 0.99)
        self.assertGreater(sum(diagnostics.number("Arm", f"{joint}: steps beyond the joint's torque limit")
                               for joint in JOINTS), 0)
        for mass in (0.0, 1e4):
            load = Inertia(m=mass)
            load.com.x = 10.0
            self.payload.publish(load)
            time.sleep(3.0)
            answer = reset()
            self.assertTrue(answer.success, answer.message)
        self.wrench.publish(WrenchStamped())
        self.payload.publish(Inertia())
        time.sleep(0.5)
        self.assertTrue(reset().success)
        self.said("The twin is in time again")


if __name__ == "__main__":
    rospy.init_node("arm_twin_test")
    rostest.rosrun(PACKAGE, "arm_twin_test", ArmTwin, sys.argv)
