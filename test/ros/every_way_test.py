#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""The live node says of a recording of an arm what `joint_twin compare` says of it, in the cases of
python/verdicts_test.py, played faster than recorded. What it finds of the load while rows come counts from then on; a
payload that changes from leg to leg is said, and not judged.

Recordings of a sound UR5 are taken from HJT_TELEMETRY_DIR, else from shared/telemetry beside the checkout."""
import os
import re
import sys
import time
import unittest
import urllib.parse

import numpy as np
import rosgraph
import rospy
import rostest
from sensor_msgs.msg import JointState

from harmonic_joint_twin.msg import Comparison, Verdict
from ros_support import (LAUNCH_TIMEOUT, PACKAGE, STALE, Diagnostics, Launch, Listener, executable, package_path,
                         wait_until)

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "support"))
from ur_recording import JOINTS as NAMES, write_csv  # noqa: E402
from verdict_cases import FIELDS, JOINTS, LEVELS, VerdictCases, motion, recorded, verdicts_in  # noqa: E402

FASTER = 12.0  # played than stamped
LOOKED_FOR, PICKED = 80.0, 35.0  # a motion longer than that after which a payload is looked for and tried [s]
LATE = 0.5     # a row is judged when the ones behind it have come [s]
# In the text of compare: what the node finds while rows come, and starts again with.
FOUND = ("payload of", "tilted by", "no payload", "may be a")
CHANGES = "as in picking and placing"
DIRECTORY = os.path.join(os.environ.get("HJT_TELEMETRY_DIR", package_path("..", "shared", "telemetry")), "ur5_cb")


class EveryWay(VerdictCases, unittest.TestCase):
    tool_path = executable("joint_twin")

    def launch(self, *arguments):
        port = urllib.parse.urlparse(rosgraph.get_master_uri()).port
        launch = Launch(os.path.abspath("launch.log"), "arm.launch", *arguments, port=port)
        self.addCleanup(launch.interrupt)
        return launch

    def play(self, rows, *arguments, faster=FASTER):
        """The launch; verdicts and diagnostics by joint; how many of the rows the node judged: it waits for later ones
        at the end."""
        launch = self.launch(*arguments)
        publisher = rospy.Publisher("/joint_states", JointState, queue_size=10000)
        self.addCleanup(publisher.unregister)
        verdicts = {joint: Listener(f"/{joint}/joint_twin/verdict", Verdict) for joint in JOINTS}
        self.diagnostics = {joint: Diagnostics(f"/{joint}/joint_twin") for joint in JOINTS}
        comparisons = Listener("/wrist_3/joint_twin/comparison", Comparison)
        wait_until(lambda: publisher.get_num_connections() == 1, "the node", LAUNCH_TIMEOUT)
        comparisons.wait_for_connection()
        begin = rospy.Time.now()
        stamps = [begin + rospy.Duration.from_sec(seconds) for seconds in rows[0]]
        for stamp, position, current in zip(stamps, *rows[1:]):
            time.sleep(max(0.0, (stamp - begin).to_sec() / faster - (rospy.Time.now() - begin).to_sec()))
            message = JointState(name=["finger_joint", *NAMES], position=[0.1, *position], effort=[0.0, *current])
            message.header.stamp = stamp
            publisher.publish(message)
        last = stamps[-1] - rospy.Duration.from_sec(LATE)
        wait_until(lambda: comparisons.messages() and comparisons.messages()[-1].header.stamp >= last, "the last rows")
        time.sleep(1.0)  # rows that are still on their way
        at = comparisons.messages()[-1].header.stamp
        return launch, verdicts, sum(stamp <= at for stamp in stamps)

    def judge_case(self, arm, rows, compared, _every_way=False, reference=None):
        beside = [f"reference:={os.path.abspath(reference)}"] if reference else []
        launch, self.verdicts, judged = self.play(rows, f"arm:={arm}", *beside)
        write_csv("judged.csv", *(values[:judged] for values in rows))
        expected = verdicts_in(self.tool("compare", "judged.csv", "--arm", arm,
                                         *(["--reference", reference] if reference else [])))

        def check():
            for joint, verdict in expected.items():
                last = self.verdicts[joint].messages()[-1]
                if "payload changes" in compared["text"]:
                    self.assertIn(CHANGES, last.text)
                elif any(found in compared["text"] for found in FOUND):
                    # The rows since it was found may be too few.
                    self.assertIn(LEVELS[last.level], ("NOT JUDGED", verdict["level"]), last.text)
                    if last.level != Verdict.NOT_JUDGED:
                        self.assertGreater(last.friction_factor, verdict["friction_lower"])
                        self.assertLess(last.friction_factor, verdict["friction_upper"])
                else:
                    said = {field: getattr(last, field) for field in FIELDS}
                    self.same("node", {joint: {**said, "level": LEVELS[last.level]}}, {joint: verdict})

        def is_said():
            try:
                check()
            except (AssertionError, IndexError):
                return False
            return True

        try:
            wait_until(is_said, "the verdicts")
        except AssertionError:
            check()  # says what differs
            raise
        for joint, verdict in expected.items():
            self.assertLessEqual(self.alarms(joint), {verdict["level"]}, joint)
        wait_until(self.said, "what else is said")
        late = rospy.wait_for_message("/base/joint_twin/verdict", Verdict, timeout=10.0)
        self.assertEqual(late.header, self.verdicts["base"].messages()[-1].header, "latched")
        launch.interrupt()
        self.assertIn("reference: " + os.path.abspath(reference) if reference else "", launch.log())

    def alarms(self, joint):
        """The levels above OK that were said of it, at the end or before."""
        return {LEVELS[message.level] for message in self.verdicts[joint].messages()} & {"WARN", "ERROR"}

    def said(self):
        """Whether the node says what else is to be said at the end of the case."""
        return True

    def test_worn_joint(self):
        self.said = lambda: self.diagnostics["shoulder"].level("Drive") == STALE
        super().test_worn_joint()
        statuses = self.diagnostics["shoulder"].statuses("Drive")
        self.assertIn("Last: WARN", statuses[-1].message)
        self.assertEqual(self.diagnostics["shoulder"].values("Drive")["Verdict"], "WARN")
        self.assertIn(self.verdicts["shoulder"].messages()[-1].text.rstrip("."), {each.message for each in statuses})
        self.assertEqual(self.diagnostics["base"].values("Drive")["Friction"].split(". ")[0], "OK")

    def test_payload_is_told_with_the_time_since_when(self):
        times, angles = motion(LOOKED_FOR)
        empty, loaded = (recorded(arm, times, angles)[0] for arm in ("ur5", self.loaded))
        self.play((times, angles, np.where(times[:, None] < PICKED, empty, loaded)), faster=3.0)
        wait_until(lambda: re.search(r"show a payload of [34]\.\d* .* since \d\d:\d\d:\d\d UTC",
                                     self.diagnostics["base"].values("Input")["Payload that is not configured"]),
                   "the payload")

    def test_angles_folded_into_one_turn(self):
        self.said = lambda: self.diagnostics["base"].number("Input", "Jumps of angles by a turn, taken out") > 0
        super().test_angles_folded_into_one_turn()

    def test_joint_without_efforts(self):
        _, verdicts, _ = self.play((self.times, self.angles, np.where(np.arange(6) == 4, np.nan, self.currents)))
        expected = {joint: "NOT JUDGED" if joint == "wrist_2" else "OK" for joint in JOINTS}
        wait_until(lambda: {joint: LEVELS[verdicts[joint].messages()[-1].level] for joint in JOINTS} == expected,
                   "the verdicts")
        self.assertEqual(verdicts["wrist_2"].messages()[-1].reason, Verdict.EFFORT_CONSTANT)

    @unittest.skipUnless(os.path.isdir(DIRECTORY), f"no recordings of a UR5 in {DIRECTORY}")
    def test_recordings_of_a_ur5(self):
        for name, pushed in (("no7", set()), ("no5_pushed", {"base"})):
            table = np.genfromtxt(os.path.join(DIRECTORY, f"ur5_cb_{name}.csv"), delimiter=",", names=True)
            launch, self.verdicts, _ = self.play(
                (table["timestamp"] - table["timestamp"][0], *(np.column_stack(
                    [table[f"actual_{quantity}_{joint}"] for joint in range(6)]) for quantity in ("q", "current"))))
            launch.interrupt()
            self.assertEqual(set().union(*map(self.alarms, JOINTS)), set(), name)
            self.assertEqual({joint for joint in JOINTS for message in self.verdicts[joint].messages()
                              if "omething touched the arm" in message.text}, pushed, name)

    def test_what_is_no_report_ends_the_node_with_the_reason(self):
        with open("arm.json", "w", encoding="ascii") as file:
            file.write("{}\n")
        launch = self.launch(f"reference:={os.path.abspath('arm.json')}")
        wait_until(lambda: "FATAL" in launch.log(), "the error", LAUNCH_TIMEOUT)
        self.assertIn(os.path.abspath("base") + " lacks comparison.json, a file of a report", launch.log())


if __name__ == "__main__":
    rospy.init_node("every_way_test")
    rostest.rosrun(PACKAGE, "every_way", EveryWay, sys.argv)
