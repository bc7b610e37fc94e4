#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""The record of use and ~remaining_life: what is counted, published and kept from one start of the node to the next."""
import os
import signal
import sys
import tempfile
import threading
import time
import unittest

import rospy
import rostest
from std_msgs.msg import Float64

from harmonic_joint_twin.msg import RemainingLife
from ros_support import PACKAGE, Listener, Node, configuration_files, load_parameters, wait_until

NODE = "/twin_under_test"
JOINT = "elbow_joint"
PERIOD = 0.5  # life.forecast_period [s]


class Life(unittest.TestCase):
    def setUp(self):
        directory = tempfile.TemporaryDirectory()
        self.addCleanup(directory.cleanup)
        self.record = os.path.join(directory.name, "elbow.csv")
        self.torque = rospy.Publisher(f"{NODE}/motor_torque_command", Float64, queue_size=10)
        self.addCleanup(self.torque.unregister)
        self.driving = True
        thread = threading.Thread(target=self.drive)
        thread.start()
        self.addCleanup(thread.join)
        self.addCleanup(lambda: setattr(self, "driving", False))

    def drive(self):
        while self.driving:
            self.torque.publish(0.5)
            time.sleep(0.02)

    def start(self, **values):
        load_parameters(NODE, configuration_files(),
                        {"life/use_record": self.record, "life/forecast_period": PERIOD, **values})
        node = Node(NODE.lstrip("/"))
        self.addCleanup(node.kill)
        return node

    def forecast(self):
        """The latest; a late subscriber gets one at once."""
        listener = Listener(f"{NODE}/remaining_life", RemainingLife)
        message = listener.wait_for(1)[-1]
        listener.close()
        return message

    def rows(self):
        with open(self.record) as file:
            return file.read().splitlines()

    def test_use_is_counted_over_restarts_and_tells_what_is_left(self):
        node = self.start()
        first = self.forecast()
        self.assertEqual(first.header.frame_id, JOINT)
        self.assertGreater(first.turns, 0.0)
        self.assertGreater(first.hours, 0.0)
        self.assertTrue(0.0 < first.remaining_hours_10 < first.remaining_hours_50 < first.remaining_hours_90)
        self.assertIn(first.nearest_limit, ("flank wear", "interface wear", "root crack", "bearing"))
        for name in ("flank_wear", "interface_wear", "bearing", "grease"):
            self.assertTrue(0.0 < getattr(first, f"{name}_used") < 1e-3, name)
        wait_until(lambda: self.forecast().hours > first.hours, "another forecast")
        self.assertEqual(node.stop(signal.SIGINT)[0], 0)
        kept = self.rows()
        self.assertEqual(kept[0], "duration,motor_speed,load_torque,temperature")
        seconds = sum(float(row.split(",")[0]) for row in kept[1:])
        self.assertGreaterEqual(seconds, 3600.0 * first.hours)
        # A new start goes on from there; so does one after a loss of power.
        node = self.start()
        second = self.forecast()
        self.assertGreater(second.hours, seconds / 3600.0)
        node.kill()
        self.start()
        self.assertGreaterEqual(self.forecast().hours, second.hours)

    def check_density(self, forecast):
        edges, shares = forecast.remaining_hours, forecast.probability
        self.assertEqual(edges[0], 0.0)
        self.assertTrue(all(a < b for a, b in zip(edges, edges[1:])))
        self.assertAlmostEqual(sum(shares), 1.0, delta=1e-9)
        self.assertAlmostEqual(sum(forecast.end_probability), 1.0, delta=1e-9)
        for quantile, share in ((forecast.remaining_hours_10, 0.1), (forecast.remaining_hours_50, 0.5),
                                (forecast.remaining_hours_90, 0.9)):
            sooner = sum(p for edge, p in zip(edges[1:], shares) if edge <= quantile)
            begun = sum(p for edge, p in zip(edges, shares) if edge <= quantile)
            self.assertTrue(sooner - 1e-9 <= share <= begun + 1e-9, (quantile, sooner, begun))

    def test_density_is_published_and_counts_assessments(self):
        # Half its life was gone before the reference was learned: silence since then says nothing of it.
        with open(self.record, "w") as file:
            file.write("duration,motor_speed,load_torque,temperature\n7.2e+7,200.0,30.0,40.0\n")
        self.start(**{"indicators/window_turns": 5.0, "indicators/baseline_windows": 8})
        unread = self.forecast()
        self.assertGreater(unread.hours, 20000.0)
        self.check_density(unread)
        wait_until(lambda: self.forecast().assessed.to_nsec() > 0, "an assessment that counts")
        read = self.forecast()
        self.check_density(read)
        self.assertLess(read.assessed, read.header.stamp)
        median = unread.remaining_hours_50
        self.assertAlmostEqual(read.remaining_hours_50, median, delta=0.02 * median)

    def test_a_file_that_is_no_record_stays_and_ends_the_node(self):
        folder = os.path.dirname(self.record)
        text, pipe, loop = (os.path.join(folder, name) for name in ("notes.txt", "pipe", "loop"))
        with open(text, "w") as file:
            file.write("duration of the trip: 3 h\n")
        os.mkfifo(pipe)
        os.symlink(loop, loop)
        for path, reason in ((text, "is not a record of a drive's use"),
                             (pipe, "must be a file, not a directory, a device"),
                             (folder, "must be a file, not a directory"), (loop, "cannot be reached"),
                             (os.path.join(folder, 300 * "a"), "cannot be reached")):
            with self.subTest(path=path):
                node = self.start(**{"life/use_record": path})
                self.assertEqual(node.wait_for_exit(), 1)
                self.assertIn(f"life.use_record = '{path}' {reason}", node.output())
        self.assertEqual(sorted(os.listdir(folder)), ["loop", "notes.txt", "pipe"])

    def test_records_that_cannot_be_read_are_set_aside_and_do_not_replace_each_other(self):
        # No number a drive can have, and not one that may end the node; the last ends in a row.
        for end, row, said in (("", "1.0e+308,1.0e+308,5.0,1.0\n", ""), (".1", "1.0e+308,1.0e+308,5.0,2.0\n", ""),
                               (".2", "3600.0,100.0,5", f"{self.record}:2: too few columns")):
            with open(self.record, "w") as file:
                file.write("duration,motor_speed,load_torque,temperature\n" + row)
            node = self.start()
            self.assertLess(self.forecast().hours, 0.5)
            with open(self.record + ".unreadable" + end) as file:
                self.assertIn(row, file.read())
            self.assertIn(said, node.output())
            self.assertEqual(node.stop(signal.SIGINT)[0], 0)
            self.assertGreater(len(self.rows()), 1)


if __name__ == "__main__":
    rospy.init_node("life_test")
    rostest.rosrun(PACKAGE, "life", Life, sys.argv)
