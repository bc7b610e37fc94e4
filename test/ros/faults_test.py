#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Faults of a running node, and what it makes of them: ~inject_fault, ~faults, ~indicators, ~assessment and the task
Health of /diagnostics. The test holds the clock, so every message has its instant."""
import math
import sys
import time
import unittest

import rospy
import rostest
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState

from harmonic_joint_twin.msg import Assessment, Fault, Faults, Health, Indicators
from ros_support import (ERROR, OK, PACKAGE, STALE, WARN, Diagnostics, Listener, Node, configuration_files,
                         load_parameters, wait_until)

NODE = "/twin_under_test"
JOINT = "elbow_joint"
START = 100.0     # first time of the clock [s]
STEP = 0.1        # of the clock; then it waits for the twin [s]
INPUT_DELAY = 0.02  # input.delay [s]
TIMEOUT = 1.0     # input.command_timeout [s]
MESSAGE_TIME = 0.2  # for a message to arrive before the clock goes on [s]


class FaultsOfANode(unittest.TestCase):
    def start(self, *overlays, **changes):
        """A node of its own for each test."""
        rates = {"input/command_timeout": TIMEOUT, "publish/health_rate": 100, "publish/indicators_rate": 100}
        load_parameters(NODE, configuration_files(overlays=overlays), dict(rates, **changes))
        self.node = Node(NODE.lstrip("/"))
        self.addCleanup(self.node.kill)
        self.now = START
        self.torque = None  # [N.m]
        self.clock = rospy.Publisher("/clock", Clock, queue_size=100)
        self.command = self.publisher("command", JointState)
        self.inject = self.publisher("inject_fault", Fault)
        self.health = self.listener("health", Health)
        self.faults = self.listener("faults", Faults)
        self.diagnostics = Diagnostics(NODE)
        for publisher in (self.clock, self.command, self.inject):
            wait_until(lambda p=publisher: p.get_num_connections() > 0, f"a subscriber of {publisher.name}")
        self.health.wait_for_connection()
        for _ in range(3):  # the twin starts at the time it sees first
            self.clock.publish(rospy.Time.from_sec(START))
            time.sleep(MESSAGE_TIME)
        self.run_clock(0.2)

    def publisher(self, topic, message_type):
        publisher = rospy.Publisher(f"{NODE}/{topic}", message_type, queue_size=100)
        self.addCleanup(publisher.unregister)
        return publisher

    def listener(self, topic, message_type):
        listener = Listener(f"{NODE}/{topic}", message_type)
        self.addCleanup(listener.close)
        return listener

    def run_clock(self, seconds):
        """Step by step, with a command at each if there is a torque."""
        for _ in range(round(seconds / STEP)):
            if self.torque is not None:
                message = JointState(name=[f"{JOINT}_motor"], effort=[self.torque])
                message.header.stamp = rospy.Time.from_sec(self.now)
                self.command.publish(message)
            self.now += STEP
            self.clock.publish(rospy.Time.from_sec(self.now))
            wait_until(lambda: self.health.messages() and
                       self.health.messages()[-1].header.stamp.to_sec() > self.now - INPUT_DELAY - 0.011, "the twin")

    def run_until(self, condition, what, longest=20.0):
        end = self.now + longest
        while not condition():
            self.assertLess(self.now, end, what)
            self.run_clock(STEP)

    def send(self, kind, severity, place=-1, stamp=0.0, ramp=0.0):
        message = Fault(kind=kind, severity=severity, place=place, ramp=ramp)
        message.header.stamp = rospy.Time.from_sec(stamp)
        self.inject.publish(message)
        time.sleep(MESSAGE_TIME)

    def active(self):
        return [(fault.kind, fault.severity, fault.place) for fault in self.faults.messages()[-1].faults]

    def stiffness(self):
        """Of the gear at this instant [N.m/rad]."""
        return self.health.messages()[-1].torsional_stiffness_model

    def test_faults_set_in_at_their_stamp_and_go_without_a_trace(self):
        self.start()
        self.assertEqual(self.active(), [])
        sound = self.stiffness()
        stamp = self.now + 0.05
        self.send("tooth_wear", 0.5, -1, stamp)
        self.send("flange_crack", 1.0, -1, stamp)
        self.run_clock(STEP)
        # The health of a step may arrive before its faults.
        wait_until(lambda: self.active() == [("tooth_wear", 0.5, -1), ("flange_crack", 1.0, -1)], "both faults")
        for fault in self.faults.messages()[-1].faults:
            self.assertAlmostEqual(fault.since.to_sec(), stamp, places=6)
        self.assertAlmostEqual(self.faults.messages()[-1].header.stamp.to_sec(), stamp, places=6)
        faulty = self.stiffness()
        self.assertLess(faulty, 0.8 * sound)
        self.send("tooth_wear", 0.2)
        self.run_clock(STEP)
        self.assertEqual(self.active(), [("tooth_wear", 0.2, -1), ("flange_crack", 1.0, -1)])
        self.send("flange_crack", 0.0)
        self.send("tooth_wear", 0.0)
        self.run_clock(STEP)
        self.assertEqual(self.active(), [])
        self.assertAlmostEqual(self.stiffness() / sound, 1.0, delta=0.02)  # friction leaves the joint where it stood

    def test_who_comes_late_still_hears_what_is_active(self):
        self.start()
        self.send("pitting", 0.3, 7)
        self.run_clock(STEP)
        late = self.listener("faults", Faults)
        fault = late.wait_for(1)[0].faults[0]
        self.assertEqual((fault.kind, fault.severity, fault.place), ("pitting", 0.3, 7))
        self.assertIn("pitting 0.3 at 7", self.diagnostics.fresh("Drive")["Faults of the gear"])

    def test_bad_faults_are_refused_said_and_counted_and_nothing_else_is_lost(self):
        self.start()
        self.torque = 0.1
        self.send("pitting", 0.3, 7)
        self.run_clock(2.0 * STEP)
        self.assertEqual(self.diagnostics.fresh("Input")["Faults, refused"], "0")
        bad = [("rust", 0.5, -1), ("pitting", 1.5, 7), ("pitting", math.nan, 7), ("pitting", 0.5, 200),
               ("tooth_root_crack", 0.5, -1)]
        for number, fault in enumerate(bad, 1):
            self.send(*fault)
            wait_until(lambda said=f", {number} so far": said in self.node.output(), f"the warning of {fault}")
            self.run_clock(1.0)  # one warning a second
        self.send("pitting", 0.5, 7, ramp=-1.0)
        self.diagnostics.wait_for("Input", "Faults, refused", len(bad) + 1)
        self.assertEqual(self.diagnostics.level("Input"), WARN)
        self.run_clock(2.0 * STEP)
        self.assertEqual(self.active(), [("pitting", 0.3, 7)])
        self.assertEqual(self.health.messages()[-1].motor_torque, self.torque)
        for text in ("kind = 'rust' is unknown, allowed: interface_wear",
                     "severity = 1.5 [-] of pitting is out of range, allowed: 0 ... 1 [-]",
                     "place = 200 [-] of pitting is out of range, allowed: tooth 0 ... 199",
                     "ramp = -1.0 [s] is out of range, allowed: 0 ... "):
            self.assertTrue(text in self.node.output(), text)
        self.send("pitting", 0.6, 7)
        self.run_clock(STEP)
        self.assertEqual(self.active(), [("pitting", 0.6, 7)])

    def last(self):
        return self.assessment.messages()[-1]

    def wait_for_level(self, level):
        self.run_until(lambda: self.last().level == level, f"level {level}; {self.last()}")
        wait_until(lambda: self.diagnostics.level("Health") == level, f"level {level} in /diagnostics")

    def test_a_fault_raises_the_level_and_its_end_lowers_it(self):
        # Short windows, and few for the reference. Without noise lines of 1e-6 N.m would be evidence. After the start
        # /diagnostics says nothing but changes of level.
        self.start("real_sensors.yaml", **{"indicators/window_turns": 5.0, "indicators/baseline_windows": 60,
                                           "indicators/evidence_windows": 2, "indicators/false_alarm_rate": 0.02,
                                           "diagnostic_period": 3600.0})
        self.torque = 0.8  # takes the motor to its speed limit and holds it there, with the fault too
        self.indicators = self.listener("indicators", Indicators)
        self.assessment = self.listener("assessment", Assessment)
        self.run_until(lambda: self.assessment.messages() and self.last().state == Assessment.ASSESSED, "a reference")
        indicators = self.indicators.messages()[-1]
        self.assertGreater(indicators.windows, 60)
        self.assertAlmostEqual(indicators.turns, 5.0, delta=0.1)
        self.assertTrue(indicators.temperature_valid)
        self.assertAlmostEqual(indicators.temperature, 25.0, delta=1e-9)
        values = {name: value for name, value,
                  valid in zip(indicators.names, indicators.values, indicators.valid) if valid}
        self.assertTrue(0.0 < values["running_torque"] < self.torque, values)
        self.assertIn("kinematic_error", values)
        self.assertEqual((self.last().level, self.last().cause), (Assessment.OK, "none"))
        self.assertEqual(self.diagnostics.level("Health"), OK)
        self.send("lubricant_degradation", 0.3)
        self.wait_for_level(WARN)
        self.assertEqual(self.last().cause, "lubricant_degradation")
        self.assertIn("running_torque", self.last().evidence)
        self.assertIn(self.last().cause, self.diagnostics.statuses("Health")[-1].message)
        self.send("lubricant_degradation", 1.0)
        self.wait_for_level(ERROR)
        self.send("lubricant_degradation", 0.0)
        self.wait_for_level(OK)
        self.torque = None
        self.run_clock(TIMEOUT + 2.0 * STEP)
        wait_until(lambda: self.diagnostics.level("Health") == STALE, "STALE without an input")
        self.assertIn("The input has stopped", self.diagnostics.statuses("Health")[-1].message)


if __name__ == "__main__":
    # By the system's clock: this test is the one that makes the other.
    rospy.init_node("faults_test", disable_rostime=True)
    rospy.set_param("/use_sim_time", True)
    rostest.rosrun(PACKAGE, "faults", FaultsOfANode, sys.argv)
