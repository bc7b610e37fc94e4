#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""The verdict of the node beside a robot is that of joint_twin compare on the same messages: the made-up UR5 of
ur5_test, whose elbow has more friction, for twelve swings and the rest after them."""
import json
import math
import os
import shutil
import subprocess
import sys
import tempfile
import time
import unittest

import rosbag
import rospy
import rostest
from sensor_msgs.msg import JointState

from ros_support import NO_PAGE, OK, PACKAGE, STALE, WARN, Diagnostics, Listener, executable, wait_until
from harmonic_joint_twin.msg import Comparison
from harmonic_joint_twin.msg import Verdict as VerdictMessage
from ur5_test import JOINTS, PERIOD, SICK, WAIT_OF_ARM, angles, run_robot

# Until the end of a swing, and longer than RecordingFit::PATIENCE by what the ranking of arms takes [s].
MOVING = 12 * 2.0 * math.pi / 1.6
SECONDS = MOVING + 1.0
FASTER = 4.0  # played than stamped
FINDINGS = ("Friction", "Torsion", "Signals by windows")
LEVELS = {"OK": OK, "NOT JUDGED": OK, "WARN": WARN}


class Verdict(unittest.TestCase):
    def setUp(self):
        self.directory = tempfile.mkdtemp(prefix="verdict_test_")
        self.addCleanup(shutil.rmtree, self.directory)
        self.bag = os.path.join(self.directory, "robot.bag")
        self.diagnostics = {joint: Diagnostics(f"/{joint}/joint_twin") for joint in JOINTS}
        self.verdicts = {joint: Listener(f"/{joint}/joint_twin/verdict", VerdictMessage) for joint in JOINTS}
        self.comparisons = Listener("/wrist_3/joint_twin/comparison", Comparison)
        self.publisher = rospy.Publisher("/joint_states", JointState, queue_size=1000)
        wait_until(lambda: self.publisher.get_num_connections() == 1, "the node")
        self.comparisons.wait_for_connection()

    def play(self):
        robot = run_robot(self.directory, lambda seconds: angles(min(seconds, MOVING)), SECONDS)
        begin = rospy.Time.now()
        with rosbag.Bag(self.bag, "w") as bag:
            for row, (position, current) in enumerate(robot):
                since = PERIOD * row
                time.sleep(max(0.0, (begin - rospy.Time.now()).to_sec() + since / FASTER))
                message = JointState(name=list(JOINTS.values()), position=position, effort=current)
                message.header.stamp = begin + rospy.Duration.from_sec(since)
                self.publisher.publish(message)
                bag.write("/joint_states", message, message.header.stamp)
        self.comparisons.wait_for(len(robot) - WAIT_OF_ARM, patience=60.0)

    def offline(self):
        subprocess.run([executable("joint_twin"), "compare", self.bag, "--arm", "ur5", "--report",
                        os.path.join(self.directory, "report")], check=True, stdout=subprocess.DEVNULL,
                       env={**os.environ, **NO_PAGE})
        verdicts = {}
        for joint in JOINTS:
            with open(os.path.join(self.directory, "report", joint, "comparison.json")) as file:
                verdicts[joint] = json.load(file)["verdict"]
        return verdicts

    def test_live_and_offline_give_the_same_verdict(self):
        self.play()
        offline = self.offline()
        self.assertEqual({joint: verdict["level"] for joint, verdict in offline.items()},
                         {joint: "WARN" if joint == SICK else "OK" for joint in JOINTS})
        for joint, verdict in offline.items():
            expected = {finding["title"]: finding["level"] + ". " + finding["text"] for finding in verdict["findings"]}
            self.assertEqual(set(expected), set(FINDINGS))

            def live(joint=joint):
                values = self.diagnostics[joint].values("Drive")
                return {finding: values.get(finding) for finding in FINDINGS}

            try:
                wait_until(lambda expected=expected, live=live: live() == expected, f"the verdict on {joint}")
            except AssertionError:
                self.assertEqual(live(), expected, joint)  # shows both
            self.assertEqual(self.diagnostics[joint].values("Drive")["Verdict"], verdict["level"])
            whole = verdict["evidence_values"][verdict["evidence_names"].index("rows")]
            wait_until(lambda joint=joint, whole=whole: self.evidence(joint)["rows"] >= whole - WAIT_OF_ARM,
                       "the verdict on all rows that were compared")
            self.check_message(self.verdicts[joint].messages()[-1], verdict)
            wait_until(lambda joint=joint: self.diagnostics[joint].level("Drive") == STALE, f"{joint} stopped")
            reported = {(status.level, status.message) for status in self.diagnostics[joint].statuses("Drive")
                        if status.level != STALE}
            if joint == SICK:
                self.assertIn((LEVELS[verdict["level"]], verdict["text"].rstrip(".")), reported)
            else:
                self.assertEqual({level for level, _ in reported}, {OK}, joint)
            self.assertIn("Last: " + verdict["level"], self.diagnostics[joint].statuses("Drive")[-1].message)
            late = rospy.wait_for_message(f"/{joint}/joint_twin/verdict", VerdictMessage, timeout=10.0)
            self.assertEqual(late.header, self.verdicts[joint].messages()[-1].header, "latched")

    def evidence(self, joint):
        message = self.verdicts[joint].messages()[-1]
        return dict(zip(message.evidence_names, message.evidence_values))

    def check_message(self, message, offline):
        """Every field of the message is that of the JSON document."""
        self.assertEqual(message.level, getattr(VerdictMessage, offline["level"].replace(" ", "_")))
        self.assertEqual(message.reason, getattr(VerdictMessage, offline["reason"]))
        self.assertTrue(message.friction_measured)
        for field in ("joint", "text", "friction_factor", "friction_lower", "friction_upper", "friction_has_interval"):
            self.assertEqual(getattr(message, field), offline[field], field)
        self.assertEqual((list(message.causes), list(message.cause_weights)),
                         (offline["causes"], offline["cause_weights"]))
        live = dict(zip(message.evidence_names, message.evidence_values))
        stored = dict(zip(offline["evidence_names"], offline["evidence_values"]))
        for name in ("friction_of_twin", "friction_speeds", "lowest_speed", "highest_speed"):
            self.assertEqual(live[name], stored[name], name)
        self.assertGreater(message.header.stamp, rospy.Time(1))


if __name__ == "__main__":
    rospy.init_node("verdict_test")
    rostest.rosrun(PACKAGE, "verdict", Verdict, sys.argv)
