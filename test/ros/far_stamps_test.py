#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Stamps far from the clock and a clock that jumps far, in both modes of the node: it stays, refuses and counts
them."""
import itertools
import math
import signal
import sys
import time
import unittest

import rospy
import rostest
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64

from harmonic_joint_twin.msg import Comparison, Fault
from ros_support import PACKAGE, WARN, Diagnostics, Listener, Node, configuration_files, load_parameters, wait_until

NODE = "/twin_under_test"
JOINT = "elbow_joint"
START = 1_700_000_000      # first time of the clock [s]
PERIOD = 0.008             # of the telemetry [s]
LAST = 2**32 - 1           # largest second of a ROS stamp


def raw_time(seconds, nanoseconds):
    """As it may come over the wire: nanoseconds beyond a second."""
    stamp = rospy.Time()
    stamp.secs, stamp.nsecs = seconds, nanoseconds
    return stamp


FAR = [rospy.Time(1, 0), rospy.Time(2**31 - 1, 0), rospy.Time(2**31, 0), rospy.Time(LAST, 999_999_999),
       raw_time(LAST, LAST)]


class FarStamps(unittest.TestCase):
    def start(self, mode):
        changes = {"input/mode": mode, "telemetry/load": "load_torque"} if mode != "commands" else {}
        load_parameters(NODE, configuration_files(), changes)
        self.node = Node(NODE.lstrip("/"))
        self.addCleanup(self.node.kill)
        self.now = float(START)
        self.diagnostics = Diagnostics(NODE)
        self.clock = self.publisher("/clock", Clock)
        self.load = self.publisher(f"{NODE}/load", JointState)
        self.tick(START)
        # A task that has values: the first status only says that the node is starting.
        wait_until(lambda: self.tick(START) or self.diagnostics.values("Input"), "diagnostics", 60.0)

    def start_beside_robot(self):
        """The node in mode motion: publisher of the robot's rows, listener of what the node makes of them."""
        self.start("motion")
        measured = self.publisher(f"{NODE}/joint_states_measured", JointState)
        comparisons = Listener(f"{NODE}/comparison", Comparison)
        self.addCleanup(comparisons.close)
        comparisons.wait_for_connection()
        self.row = 0
        self.behind = 0.0  # the robot's clock [s]
        return measured, comparisons

    def publisher(self, topic, message_type):
        publisher = rospy.Publisher(topic, message_type, queue_size=1000)
        self.addCleanup(publisher.unregister)
        wait_until(lambda: publisher.get_num_connections() > 0, f"a subscriber of {topic}")
        return publisher

    def tick(self, seconds):
        self.clock.publish(rospy.Time(seconds))
        time.sleep(0.02)

    def jump(self, has_seen):
        """The clock goes to each of the far times, a few ticks there, and comes back; each time it waits until the node
        has seen that."""
        for far in FAR:
            for _ in range(3):
                self.clock.publish(far)
                time.sleep(0.02)
            wait_until(lambda: self.check_alive(f"/clock at {far.secs} s") or has_seen(far.to_sec()),
                       f"the clock at {far.to_sec()} s")
            self.tick(START)
            wait_until(lambda: self.check_alive(f"/clock back from {far.secs} s") or has_seen(START), "the clock back")

    def check_alive(self, after):
        self.assertIsNone(self.node.process.poll(), f"ended after {after}:\n{self.node.output()[-400:]}")

    def send(self, publisher, stamp, **fields):
        message = JointState(name=[JOINT], **fields)
        message.header.stamp = stamp
        publisher.publish(message)

    def stop(self):
        code, _ = self.node.stop(signal.SIGTERM)
        self.assertEqual(code, 0, self.node.output()[-400:])

    def test_a_twin(self):
        self.start("commands")
        command = self.publisher(f"{NODE}/command", JointState)
        fault = self.publisher(f"{NODE}/inject_fault", Fault)
        for stamp in FAR:
            for publisher in (command, self.load):
                self.send(publisher, stamp, effort=[0.1])
            message = Fault(kind="tooth_wear", severity=0.5, place=-1)
            message.header.stamp = stamp
            fault.publish(message)
            time.sleep(0.1)
            self.check_alive(f"stamps at {stamp.secs} s")
        self.diagnostics.wait_for("Input", "Stamp far from the clock, refused", 3 * len(FAR))
        self.assertEqual(self.diagnostics.level("Input"), WARN)
        self.send(command, rospy.Time(START), effort=[0.2])
        time.sleep(0.2)
        self.tick(START + 1)
        self.diagnostics.wait_for("Input", "Accepted", 1)
        self.stop()

    def test_the_twin_of_an_arm_whose_clock_jumps_far(self):
        load_parameters(NODE, [], {"arm": "ur5", "input/mode": "commands"})
        self.node = Node(NODE.lstrip("/"))
        self.addCleanup(self.node.kill)
        self.diagnostics = Diagnostics(NODE)
        self.clock = self.publisher("/clock", Clock)
        states = Listener("/joint_states", JointState)
        self.addCleanup(states.close)
        states.wait_for_connection()
        for now in (START, START + 3600, 2**31, START):
            ticks = itertools.count(now, 0.05)
            wait_until(lambda begin=now, clock=ticks: self.tick(next(clock)) or self.check_alive(f"/clock at {begin} s")
                       or states.messages() and 0.0 < states.messages()[-1].header.stamp.to_sec() - begin < 500.0,
                       f"states from {now} s on")
        wait_until(lambda: self.diagnostics.number("Timing", "Clock jumps") == 3, "three jumps")
        between = [m for m in states.messages() if START + 1000 < m.header.stamp.to_sec() < START + 3599]
        self.assertEqual(between, [], "simulated what was jumped over")
        self.stop()

    def test_a_twin_beside_a_robot(self):
        measured, comparisons = self.start_beside_robot()
        self.give_rows(measured, 50)
        wait_until(comparisons.messages, "comparisons")
        for stamp in FAR:
            self.send(self.load, stamp, effort=[1.0])
            self.send(measured, stamp, position=[0.1], effort=[0.1])
            time.sleep(0.1)
            self.check_alive(f"stamps at {stamp.secs} s")
            self.give_rows(measured, 10)
        self.diagnostics.wait_for("Input", "Stamp far from the clock, refused", len(FAR))
        self.diagnostics.wait_for("Input", "Loads refused", len(FAR))
        # Nothing of the recording is lost by it: no gap, no restart.
        self.assertEqual(self.diagnostics.number("Input", "Restarts"), 0)
        self.assertEqual(self.diagnostics.number("Input", "Gaps that cut the stream"), 0)
        self.assertTrue(all(START <= m.header.stamp.to_sec() < START + 10 for m in comparisons.messages()))
        self.stop()

    def test_a_twin_beside_a_robot_whose_clock_jumps_far(self):
        measured, comparisons = self.start_beside_robot()
        self.give_rows(measured, 50)
        self.jump(lambda _: time.sleep(0.5) or True)
        comparisons.clear()
        self.give_rows(measured, 50)
        wait_until(comparisons.messages, "comparisons after the jumps")
        self.stop()

    def test_a_twin_beside_a_robot_whose_first_stamp_is_wrong(self):
        measured, comparisons = self.start_beside_robot()
        self.send(measured, FAR[-1], position=[0.1], effort=[0.1])
        self.give_rows(measured, 100)
        wait_until(lambda: len(comparisons.messages()) > 50, "comparisons")
        self.assertTrue(all(START <= m.header.stamp.to_sec() < START + 10 for m in comparisons.messages()))
        self.stop()

    def test_a_robot_whose_clock_is_set_again_and_again(self):
        measured, _ = self.start_beside_robot()
        self.give_rows(measured, 250)  # for longer than stamps may go back
        for times, days in enumerate((3, 6), 1):
            self.behind = 86400.0 * days
            for said in True, False:
                wait_until(lambda said=said: self.give_rows(measured, 10) or said == (
                    "Stamps jumped back" in self.diagnostics.statuses("Input")[-1].message), f"{times}: {said}")
            self.diagnostics.wait_for("Input", "Restarts", times)
        self.stop()

    def test_a_load_without_a_stamp_is_valid_for_the_rows_after_it(self):
        """Whatever the robot's clock shows: here it is an hour slow."""
        measured, comparisons = self.start_beside_robot()
        load_torque = self.publisher(f"{NODE}/load_torque", Float64)
        self.behind = 3600.0
        self.give_rows(measured, 50)
        wait_until(comparisons.messages, "comparisons")
        for torque, give in ((7.0, load_torque.publish),
                             (15.0, lambda torque: self.send(self.load, rospy.Time(0), effort=[torque]))):
            give(torque)
            time.sleep(0.2)
            comparisons.clear()
            self.give_rows(measured, 50)
            wait_until(lambda: len(comparisons.messages()) > 30, "comparisons")
            # The load's inertia takes part: the swing's acceleration of up to 0.1 rad/s^2.
            self.assertAlmostEqual(comparisons.messages()[-1].load_torque, torque, delta=2.0)
        self.assertEqual(self.diagnostics.number("Input", "Loads refused"), 0)
        self.stop()

    def give_rows(self, publisher, count):
        """Rows of a slow swing with the clock beside them."""
        for _ in range(count):
            self.row += 1
            self.now = START + PERIOD * self.row
            self.clock.publish(rospy.Time.from_sec(self.now))
            stamp = rospy.Time.from_sec(self.now - self.behind)
            self.send(publisher, stamp, position=[0.1 * math.sin(self.now - START)], effort=[0.1])
            time.sleep(0.002)


if __name__ == "__main__":
    # By the system's clock: this test makes the other.
    rospy.init_node("far_stamps_test", disable_rostime=True)
    rospy.set_param("/use_sim_time", True)
    rostest.rosrun(PACKAGE, "far_stamps", FarStamps, sys.argv)
