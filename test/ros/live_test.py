#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""The node as twin.launch starts it, on the system's clock: topics, inputs good and bad, services, diagnostics."""
import math
import sys
import time
import unittest

import rospy
import rostest
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64
from std_srvs.srv import SetBool, Trigger

from harmonic_joint_twin.msg import Encoders, Health, Timing
from ros_support import (OK, PACKAGE, PATIENCE, WARN, Diagnostics, Listener, layout_curves, listen_to_all, number_at,
                         numbers_in, wait_until)

NODE = "/joint_twin"
JOINT = "elbow_joint"
TEETH = 200
TORQUE_LIMIT = 2.87       # motor.torque_limit [N.m]
INPUT_DELAY = 0.02          # input.delay [s]
PERIODS = {"joint_states": 1_000_000, "encoders": 1_000_000, "contact_forces": 10_000_000, "health": 100_000_000,
           "stress": 100_000_000}  # of the published topics [ns]


class Live(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.diagnostics = Diagnostics(NODE)
        cls.torque = rospy.Publisher(f"{NODE}/motor_torque_command", Float64, queue_size=100)
        cls.load = rospy.Publisher(f"{NODE}/load_torque", Float64, queue_size=100)
        cls.command = rospy.Publisher(f"{NODE}/command", JointState, queue_size=100)
        wait_until(lambda: all(p.get_num_connections() > 0 for p in (cls.torque, cls.load, cls.command)), "the node")
        cls.reset = rospy.ServiceProxy(f"{NODE}/reset", Trigger)
        cls.brake = rospy.ServiceProxy(f"{NODE}/brake", SetBool)
        wait_until(lambda: cls.diagnostics.values("Timing"), "diagnostics")

    def setUp(self):
        self.assertTrue(self.reset().success)

    def drive(self, torque, seconds):
        """Commands a torque at 100 Hz for a time."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            self.torque.publish(torque)
            time.sleep(0.01)

    def test_topics_come_at_every_period_with_all_their_entries_and_finite_numbers(self):
        # From the reset on: nothing is known of most indicators yet.
        listeners = listen_to_all(NODE)
        self.assertLessEqual({*PERIODS, "indicators", "assessment", "timing", "faults"}, set(listeners))
        self.drive(0.4, 2.0)
        for name in ("indicators", "assessment", "timing"):
            listeners[name].wait_for(2)
        for name, period in PERIODS.items():
            messages = listeners[name].wait_for(5)
            stamps = [message.header.stamp.to_nsec() for message in messages]
            with self.subTest(topic=name):
                self.assertTrue(all(stamp % period == 0 for stamp in stamps))
                self.assertEqual({b - a for a, b in zip(stamps, stamps[1:])}, {period}, "messages lost or doubled")
                self.assertEqual({message.header.frame_id for message in messages}, {JOINT})
                self.assertLess(max(stamps) * 1e-9, time.time() - INPUT_DELAY)
        for name, listener in listeners.items():
            self.assertTrue(all(math.isfinite(x) for each in listener.messages() for x in numbers_in(each)), name)
        joint_states = listeners["joint_states"].messages()[-1]
        self.assertEqual(joint_states.name, [f"{JOINT}_motor", JOINT])
        for array in (joint_states.position, joint_states.velocity, joint_states.effort):
            self.assertEqual(len(array), 2)
        contact_forces = listeners["contact_forces"].messages()[-1]
        for array in ("wave_generator_force", "rim_tension", "bending_force", "mesh_force", "tooth_x", "tooth_y"):
            self.assertEqual(len(getattr(contact_forces, array)), TEETH, array)
        self.assertGreater(sum(contact_forces.wave_generator_force), 0.0)
        self.assertGreaterEqual(set(PERIODS) | {"comparison"}, set(layout_curves()))  # ur5_test has a comparison
        for topic, paths in layout_curves().items():
            for path in paths if topic in listeners else []:
                self.assertTrue(math.isfinite(number_at(listeners[topic].messages()[-1], path)), (topic, path))
        encoders = listeners["encoders"].messages()[-1]
        self.assertNotEqual(encoders.motor_count, 0)
        self.assertAlmostEqual(encoders.motor_angle, encoders.motor_angle_true, delta=2.0 * math.pi / 4320)
        for listener in listeners.values():
            listener.close()

    def test_the_timing_of_the_loop_comes_once_a_second(self):
        listener = Listener(f"{NODE}/timing", Timing)
        first, second = listener.wait_for(2)[:2]
        listener.close()
        self.assertEqual(first.header.frame_id, JOINT)
        self.assertGreater(second.duration, first.duration)
        self.assertGreater(sum(second.lateness_count), sum(first.lateness_count))
        self.assertEqual(len(second.bin_end), len(second.wake_up_count))
        self.assertEqual(len(second.bin_end), len(second.lateness_count))
        for name in ("wake_up", "lateness"):
            ascending = [getattr(second, f"{name}_{what}") for what in ("median", "p99", "p999", "max")]
            self.assertEqual(ascending, sorted(ascending), name)
            self.assertGreater(ascending[0], 0.0, name)
        self.assertGreater(second.real_time_factor, 0.0)
        self.assertTrue(0.0 < second.load <= 1.0, second.load)
        self.assertAlmostEqual(second.deadline, 0.005)

    def test_nothing_is_computed_for_topics_nobody_hears(self):
        wait_until(lambda: self.silence(), "all topics to fall silent")
        listener = Listener(f"{NODE}/health", Health)
        listener.wait_for(3)
        listener.close()
        before = self.diagnostics.fresh("Timing")
        self.assertGreaterEqual(int(before["health computed"]), 3)
        wait_until(lambda: self.silence(), "all topics to fall silent again")
        after = self.diagnostics.fresh("Timing")
        self.assertGreater(float(after["Simulated instant [s]"]), float(before["Simulated instant [s]"]))
        for name in ("joint_states", "encoders", "contact_forces"):
            self.assertEqual(after[f"{name} computed"], before[f"{name} computed"], name)

    def silence(self):
        first, second = (self.diagnostics.fresh("Timing") for _ in range(2))
        return all(first[f"{name} computed"] == second[f"{name} computed"] for name in PERIODS)

    def test_torques_that_are_no_numbers_are_refused_and_counted(self):
        listener = Listener(f"{NODE}/joint_states", JointState)
        listener.wait_for(1)
        before = int(self.diagnostics.fresh("Input")["Not finite, refused"])
        for value in (math.nan, math.inf):
            self.torque.publish(value)
            self.load.publish(-value)
            self.command.publish(JointState(name=[JOINT], effort=[value]))
        self.diagnostics.wait_for("Input", "Not finite, refused", before + 6)
        self.assertEqual(self.diagnostics.level("Input"), WARN)
        self.drive(0.4, 0.3)
        wait_until(lambda: listener.messages()[-1].effort[0] == 0.0 and
                   any(message.effort[0] == 0.4 for message in listener.messages()), "a good torque to act and end")
        self.assertTrue(all(math.isfinite(x) for message in listener.messages() for x in numbers_in(message)))
        listener.close()

    def test_torques_beyond_the_limit_are_clamped_and_counted(self):
        self.assertTrue(self.brake(True).success)
        listener = Listener(f"{NODE}/joint_states", JointState)
        listener.wait_for(1)
        self.drive(100.0, 0.3)
        wait_until(lambda: self.diagnostics.number("Input", "Steps with motor torque clamped") > 0, "clamped steps")
        wait_until(lambda: any(message.effort[0] > 0.0 for message in listener.messages()), "the torque")
        self.assertEqual(max(message.effort[0] for message in listener.messages()), TORQUE_LIMIT)
        self.assertIn(WARN, {status.level for status in self.diagnostics.statuses("Input")})
        listener.close()

    def test_messages_for_other_joints_or_without_effort_are_refused_and_counted(self):
        before = self.diagnostics.fresh("Input")
        self.command.publish(JointState(name=["no_such_joint"], effort=[0.4]))
        self.command.publish(JointState(name=[JOINT], position=[1.0]))
        self.diagnostics.wait_for("Input", "Unknown joint, refused", int(before["Unknown joint, refused"]) + 1)
        self.diagnostics.wait_for("Input", "Missing effort, refused", int(before["Missing effort, refused"]) + 1)

    def test_a_command_without_a_stamp_acts_when_received(self):
        listener = Listener(f"{NODE}/joint_states", JointState)
        listener.wait_for(1)
        sent = time.time()
        self.command.publish(JointState(name=[f"{JOINT}_motor"], effort=[0.3]))
        wait_until(lambda: any(message.effort[0] == 0.3 for message in listener.messages()), "the command to act")
        first = next(message for message in listener.messages() if message.effort[0] == 0.3)
        self.assertGreaterEqual(first.header.stamp.to_sec(), sent - 0.001)
        listener.close()

    def test_the_torque_ends_and_is_missed_when_commands_stop(self):
        self.drive(0.3, 0.5)
        wait_until(lambda: self.diagnostics.number("Input", "Command timeouts") >= 1, "the timeout")
        self.assertEqual(self.diagnostics.level("Input"), WARN)
        self.assertEqual(self.diagnostics.number("Drive", "Motor torque [N.m]"), 0.0)

    def test_reset_starts_again(self):
        self.drive(0.5, 0.5)
        wait_until(lambda: abs(self.diagnostics.number("Drive", "Motor angle [rad]")) > 1.0, "the motor to turn")
        time.sleep(0.5)  # no command is on its way any more
        self.assertTrue(self.reset().success)
        listener = Listener(f"{NODE}/encoders", Encoders)
        message = listener.wait_for(1)[0]
        self.assertLess(abs(message.motor_angle_true), 1e-3)
        self.assertLessEqual(abs(message.motor_count), 1)
        listener.close()

    def test_brake_holds_and_releases(self):
        listener = Listener(f"{NODE}/encoders", Encoders)
        self.assertTrue(self.brake(True).success)
        self.diagnostics.wait_for("Drive", "Brake engaged", True)
        self.drive(0.5, 0.5)
        self.assertLess(abs(listener.wait_for(1)[-1].motor_angle_true), 1e-2)
        self.assertTrue(self.brake(False).success)
        self.diagnostics.wait_for("Drive", "Brake engaged", False)
        self.drive(0.5, 0.5)
        wait_until(lambda: listener.messages()[-1].motor_angle_true > 1.0, "the motor to turn")
        listener.close()

    def test_diagnostics_name_the_hardware_and_return_to_ok(self):
        deadline = time.monotonic() + PATIENCE
        while self.diagnostics.level("Input") != OK:
            self.assertLess(time.monotonic(), deadline, self.diagnostics.statuses("Input")[-1])
            self.drive(0.2, 0.2)
        for task in ("Drive", "Input", "Timing"):
            self.assertEqual(self.diagnostics.statuses(task)[-1].hardware_id, "simulated")


if __name__ == "__main__":
    rospy.init_node("live_test")
    rostest.rosrun(PACKAGE, "live", Live, sys.argv)
