#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""The node on a simulated clock, which the test holds: it stands, runs, and jumps back as a looping bag makes it."""
import sys
import time
import unittest

import rospy
import rostest
from rosgraph_msgs.msg import Clock, Log
from sensor_msgs.msg import JointState

from ros_support import PACKAGE, WARN, Diagnostics, Listener, wait_until

NODE = "/joint_twin"
WAITING_NODE = "/waiting_twin"
MEASURED_NODE = "/measured_twin"
JOINT = "elbow_joint"
MILLISECOND = 1_000_000    # [ns]
SECOND = 1000 * MILLISECOND
INPUT_DELAY = 20 * MILLISECOND
PERIOD = MILLISECOND       # of joint_states


class SimTime(unittest.TestCase):
    """One story, in order: the clock belongs to both nodes."""

    @classmethod
    def setUpClass(cls):
        cls.clock = rospy.Publisher("/clock", Clock, queue_size=1000)
        cls.command = rospy.Publisher(f"{NODE}/command", JointState, queue_size=100)
        cls.waiting_command = rospy.Publisher(f"{WAITING_NODE}/command", JointState, queue_size=100)
        cls.states = Listener(f"{NODE}/joint_states", JointState)
        cls.waiting_states = Listener(f"{WAITING_NODE}/joint_states", JointState)
        cls.log = Listener("/rosout", Log)
        cls.diagnostics = Diagnostics(NODE)
        cls.waiting_diagnostics = Diagnostics(WAITING_NODE)
        cls.measured_diagnostics = Diagnostics(MEASURED_NODE)
        wait_until(lambda: {NODE, WAITING_NODE} <= {c.endpoint_id for c in cls.clock.impl.connections},
                   "the twins to hear the clock")
        wait_until(lambda: cls.command.get_num_connections() > 0, "the twin")
        wait_until(lambda: cls.waiting_command.get_num_connections() > 0, "the waiting twin")
        cls.states.wait_for_connection()
        cls.waiting_states.wait_for_connection()
        wait_until(lambda: cls.diagnostics.values("Timing") and cls.waiting_diagnostics.values("Timing"), "diagnostics")

    def run_clock(self, begin, end):
        """Lets the clock run, by steps of a millisecond, and waits for the running twin."""
        for now in range(begin, end + 1, MILLISECOND):
            self.clock.publish(rospy.Time(0, 0) + rospy.Duration(now // SECOND, now % SECOND))
            time.sleep(0.0005)
        self.await_instant(end - INPUT_DELAY)

    def await_instant(self, stamp):
        wait_until(lambda: self.states.messages() and self.states.messages()[-1].header.stamp.to_nsec() == stamp,
                   f"the instant {stamp}")

    def stamps(self, listener):
        return [message.header.stamp.to_nsec() for message in listener.messages()]

    def check_instants(self, stamps, begin, end):
        """Every instant up to `end`, from the first time of the clock that the twin saw: nearly `begin`."""
        self.assertGreater(stamps[0], begin)
        self.assertLess(stamps[0], begin + 150 * MILLISECOND)
        self.assertEqual(stamps, list(range(stamps[0], end + 1, PERIOD)))

    def send(self, publisher, stamp, torque):
        message = JointState(name=[JOINT], effort=[torque])
        message.header.stamp = rospy.Time(stamp // SECOND, stamp % SECOND)
        publisher.publish(message)

    def test_1_nothing_moves_before_the_clock(self):
        wait_until(lambda: self.diagnostics.level("Timing") == WARN, "the warning")
        self.assertIn("No time on /clock", self.diagnostics.statuses("Timing")[-1].message)
        wait_until(lambda: self.measured_diagnostics.level("Input") is not None, "the twin beside a robot")
        self.assertEqual(self.states.messages(), [])
        self.assertIn("No time on /clock", self.measured_diagnostics.statuses("Input")[-1].message)
        wait_until(lambda: sorted(log.name for log in self.log.messages() if "/use_sim_time is true" in log.msg)
                   == sorted([NODE, WAITING_NODE, MEASURED_NODE]), "a line of each node")

    def test_2_the_twin_visits_every_instant_of_the_clock_and_stands_with_it(self):
        self.run_clock(100 * SECOND, 100 * SECOND + 500 * MILLISECOND)
        stamps = self.stamps(self.states)
        self.check_instants(stamps, 100 * SECOND, 100 * SECOND + 480 * MILLISECOND)
        wait_until(lambda: "The clock has stopped" in self.diagnostics.statuses("Timing")[-1].message,
                   "a standing clock")
        self.assertEqual(self.stamps(self.states), stamps)

    def test_3_a_stamped_command_acts_from_its_instant_on_though_it_came_ahead_of_the_clock(self):
        command_stamp = 101 * SECOND
        self.send(self.command, command_stamp, 0.25)
        wait_until(lambda: self.diagnostics.number("Input", "Age of the last command [s]") < -0.4, "the command")
        self.states.clear()
        self.run_clock(100 * SECOND + 501 * MILLISECOND, 101 * SECOND + 60 * MILLISECOND)
        for message in self.states.messages():
            acts = message.header.stamp.to_nsec() > command_stamp  # in the step that ends at the message's stamp
            self.assertEqual(message.effort[0], 0.25 if acts else 0.0, message.header.stamp)
        self.assertEqual(self.diagnostics.number("Input", "Inputs too late for their stamps"), 0)

    def test_4_a_twin_that_waits_starts_at_the_stamp_of_the_first_input(self):
        self.assertEqual(self.waiting_states.messages(), [])
        self.assertIn("waiting for the first input", self.waiting_diagnostics.values("Drive")["State"])
        self.send(self.waiting_command, 101 * SECOND + 70 * MILLISECOND, 0.1)
        # A message and the clock come by different ways: the clock waits for the message here, as input.delay would.
        time.sleep(0.2)
        self.run_clock(101 * SECOND + 61 * MILLISECOND, 101 * SECOND + 150 * MILLISECOND)
        last = 101 * SECOND + 130 * MILLISECOND
        wait_until(lambda: self.stamps(self.waiting_states)[-1:] == [last], "the waiting twin")
        self.assertEqual(self.stamps(self.waiting_states), list(range(last - 59 * MILLISECOND, last + 1, PERIOD)))

    def test_5_a_clock_that_jumps_back_starts_both_anew_and_is_said_once(self):
        self.states.clear()
        self.waiting_states.clear()
        self.run_clock(50 * SECOND, 50 * SECOND + 300 * MILLISECOND)
        self.check_instants(self.stamps(self.states), 50 * SECOND, 50 * SECOND + 280 * MILLISECOND)
        self.assertEqual(self.states.messages()[0].effort[0], 0.0)
        self.diagnostics.wait_for("Timing", "Clock jumps", 1)
        self.waiting_diagnostics.wait_for("Timing", "Clock jumps", 1)
        self.assertEqual(self.waiting_states.messages(), [], "started again without an input")
        time.sleep(0.5)
        text = [log.name for log in self.log.messages() if "jumped back" in log.msg]
        self.assertEqual(sorted(text), [NODE, WAITING_NODE])

    def test_6_the_second_lap_gives_the_numbers_of_the_first(self):
        curves = []
        for begin in (51 * SECOND, 20 * SECOND):
            # The second time, the clock jumps back here.
            self.run_clock(begin - 100 * MILLISECOND, begin - 50 * MILLISECOND)
            self.waiting_states.clear()
            self.send(self.waiting_command, begin + 10 * MILLISECOND, 0.5)
            time.sleep(0.2)
            self.run_clock(begin, begin + 200 * MILLISECOND)
            last = begin + 180 * MILLISECOND
            wait_until(lambda: self.stamps(self.waiting_states)[-1:] == [last], "the waiting twin")
            curves.append([(message.header.stamp.to_nsec() - begin, message.position, message.effort)
                           for message in self.waiting_states.messages()])
        self.assertEqual(len(curves[0]), 170)
        self.assertEqual(curves[0], curves[1])

    def test_7_a_long_step_of_the_clock_is_no_missed_deadline(self):
        before = self.diagnostics.fresh("Timing")["Deadlines missed"]
        end = 21 * SECOND
        self.run_clock(end, end)
        self.assertEqual(self.diagnostics.fresh("Timing")["Deadlines missed"], before)


if __name__ == "__main__":
    # By the system's clock: this test is the one that makes the other.
    rospy.init_node("sim_time_test", disable_rostime=True)
    rostest.rosrun(PACKAGE, "sim_time", SimTime, sys.argv)
