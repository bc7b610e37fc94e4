#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Recordings of a sound UR5, played as its driver publishes: angles, velocities and currents, nothing else. They are
taken from HJT_TELEMETRY_DIR, else from shared/telemetry beside the checkout; without them nothing is tested."""
import csv
import glob
import os
import sys
import time
import unittest

import rospy
import rostest
from sensor_msgs.msg import JointState
from std_srvs.srv import Trigger

from harmonic_joint_twin.msg import Comparison, ContactForces
from ros_support import OK, PACKAGE, SLOWNESS, Diagnostics, Listener, package_path, wait_until

JOINTS = {"elbow": "elbow_joint", "shoulder": "shoulder_lift_joint", "base": "shoulder_pan_joint",
          "wrist_1": "wrist_1_joint", "wrist_2": "wrist_2_joint", "wrist_3": "wrist_3_joint"}  # the order of the driver
NUMBERS = dict(zip(JOINTS, (2, 1, 0, 3, 4, 5)))  # of the columns
DIRECTORY = os.environ.get("HJT_TELEMETRY_DIR", package_path("..", "shared", "telemetry"))
RECORDINGS = sorted(glob.glob(os.path.join(DIRECTORY, "ur5_cb", "*.csv")))
PUSHED = {"ur5_cb_no5_pushed.csv": {"base"}}  # joints at which somebody pushes the arm
# A push on a joint at rest is not reported: other recordings with pushes are left out.
RECORDINGS = [path for path in RECORDINGS if "pushed" not in path or os.path.basename(path) in PUSHED]
FASTER = 3.0 / SLOWNESS  # than they were recorded; the stamps are those of the recording


class Recordings(unittest.TestCase):
    def setUp(self):
        self.publisher = rospy.Publisher("/joint_states", JointState, queue_size=1000)
        self.comparisons = {joint: Listener(f"/{joint}/joint_twin/comparison", Comparison) for joint in JOINTS}
        self.forces = {joint: Listener(f"/{joint}/joint_twin/contact_forces", ContactForces) for joint in JOINTS}
        self.diagnostics = {joint: Diagnostics(f"/{joint}/joint_twin") for joint in JOINTS}
        for listener in [*self.comparisons.values(), *self.forces.values()]:
            listener.wait_for_connection()
        wait_until(lambda: self.publisher.get_num_connections() == 1, "the node")

    def play(self, path, slower=1.0, torque_per_effort=None):
        """Returns how many rows were sent, and how many seconds they cover. `slower`: the stamps than the recording's;
        `torque_per_effort`: of the joints, else efforts are currents [N.m/A]."""
        with open(path) as file:
            rows = list(csv.DictReader(file))
        begin, first = rospy.Time.now(), float(rows[0]["timestamp"])
        for row in rows:
            since = slower * (float(row["timestamp"]) - first)
            time.sleep(max(0.0, (begin - rospy.Time.now()).to_sec() + since / FASTER))
            message = JointState(name=list(JOINTS.values()),
                                 position=[float(row[f"actual_q_{i}"]) for i in NUMBERS.values()],
                                 velocity=[float(row[f"actual_qd_{i}"]) for i in NUMBERS.values()],
                                 effort=[float(row[f"actual_current_{i}"]) * (torque_per_effort or {}).get(joint, 1.0)
                                         for joint, i in NUMBERS.items()])
            message.header.stamp = begin + rospy.Duration.from_sec(since)
            self.publisher.publish(message)
        return len(rows), since

    def restart(self):
        for joint in JOINTS:
            self.assertTrue(rospy.ServiceProxy(f"/{joint}/joint_twin/reset", Trigger)().success)
        return {joint: {task: len(self.diagnostics[joint].statuses(task)) for task in ("Drive", "Health")}
                for joint in JOINTS}

    @unittest.skipUnless(RECORDINGS, f"no recordings of a UR5 in {DIRECTORY}; name it in HJT_TELEMETRY_DIR")
    def test_telemetry_that_does_not_fit_is_not_judged(self):
        path = next(path for path in RECORDINGS if path.endswith("no5.csv"))
        gains = dict(zip(sorted(NUMBERS, key=NUMBERS.get), (10.7, 10.7, 10.7, 10.21, 11.9, 11.92)))
        for change, expected in (({"torque_per_effort": gains}, "telemetry.effort: joint_torque"),
                                 ({"slower": 0.5}, "stamps")):
            seen = self.restart()
            self.play(path, **change)
            for joint in JOINTS:
                for task in ("Drive", "Health"):
                    def since(joint=joint, task=task):
                        return self.diagnostics[joint].statuses(task)[seen[joint][task]:]
                    wait_until(lambda: any("Not judged" in status.message and expected in status.message
                                           for status in since()), (expected, joint, task))
                    statuses = since()
                    levels = {status.level for status in statuses
                              if "stopped" not in status.message and "Nothing" not in status.message}
                    self.assertEqual(levels, {OK}, (expected, joint, task))

    @unittest.skipUnless(RECORDINGS, f"no recordings of a UR5 in {DIRECTORY}; name it in HJT_TELEMETRY_DIR")
    def test_sound_joints_are_ok_and_have_tooth_forces(self):
        for path in RECORDINGS:
            name = os.path.basename(path)
            seen = self.restart()
            for listener in [*self.comparisons.values(), *self.forces.values()]:
                listener.clear()
            rows, seconds = self.play(path)
            for joint in JOINTS:
                self.comparisons[joint].wait_for(int(0.98 * rows) - 30)
                self.assertGreater(len(self.forces[joint].messages()), 0.9 * 10.0 * seconds, (name, joint))
                for task in ("Drive", "Health"):
                    found = {(status.level, status.message)
                             for status in self.diagnostics[joint].statuses(task)[seen[joint][task]:]
                             if "stopped" not in status.message and "Nothing" not in status.message}
                    self.assertEqual({level for level, _ in found}, {OK}, (name, joint, task, found))
                    # Where rows scatter, a touch is one of several reasons that the sentence offers.
                    self.assertEqual(any("touched the arm" in message.replace("touched the arm, or angles", "")
                                         for _, message in found),
                                     joint in PUSHED.get(name, ()), (name, joint, task, found))
            print(f"{name}: {rows} rows, {seconds:.0f} s", flush=True)


if __name__ == "__main__":
    rospy.init_node("recordings_test")
    rostest.rosrun(PACKAGE, "recordings", Recordings, sys.argv)
