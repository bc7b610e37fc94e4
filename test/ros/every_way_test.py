#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""The live node says of a recording of an arm what `joint_twin compare` says of it, in the cases of
python/verdicts_test.py, played faster than recorded. What it finds of the load while rows come counts from then on; a
payload that changes from leg to leg is said, and not judged."""
import os
import sys
import time
import unittest
import urllib.parse

import rosgraph
import rospy
import rostest
from sensor_msgs.msg import JointState

from harmonic_joint_twin.msg import Comparison, Verdict
from ros_support import LAUNCH_TIMEOUT, PACKAGE, Launch, Listener, executable, wait_until

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "support"))
from ur_recording import JOINTS as NAMES, write_csv  # noqa: E402
from verdict_cases import FIELDS, JOINTS, LEVELS, VerdictCases, verdicts_in  # noqa: E402

FASTER = 12.0  # played than stamped
LATE = 0.5     # a row is judged when the ones behind it have come [s]
# In the text of compare: what the node finds while rows come, and starts again with.
FOUND = ("payload of", "tilted by")
CHANGES = "as in picking and placing"


class EveryWay(VerdictCases, unittest.TestCase):
    tool_path = executable("joint_twin")

    def play(self, arm, rows):
        """Verdicts by joint, and how many of the rows the node judged: it waits for later ones at the end."""
        port = urllib.parse.urlparse(rosgraph.get_master_uri()).port
        launch = Launch(os.path.abspath("launch.log"), "arm.launch", f"arm:={arm}", port=port)
        self.addCleanup(launch.interrupt)
        publisher = rospy.Publisher("/joint_states", JointState, queue_size=10000)
        self.addCleanup(publisher.unregister)
        verdicts = {joint: Listener(f"/{joint}/joint_twin/verdict", Verdict) for joint in JOINTS}
        comparisons = Listener("/wrist_3/joint_twin/comparison", Comparison)
        wait_until(lambda: publisher.get_num_connections() == 1, "the node", LAUNCH_TIMEOUT)
        comparisons.wait_for_connection()
        begin = rospy.Time.now()
        stamps = [begin + rospy.Duration.from_sec(seconds) for seconds in rows[0]]
        for stamp, position, current in zip(stamps, *rows[1:]):
            time.sleep(max(0.0, (stamp - begin).to_sec() / FASTER - (rospy.Time.now() - begin).to_sec()))
            message = JointState(name=NAMES, position=list(position), effort=list(current))
            message.header.stamp = stamp
            publisher.publish(message)
        last = stamps[-1] - rospy.Duration.from_sec(LATE)
        wait_until(lambda: comparisons.messages() and comparisons.messages()[-1].header.stamp >= last, "the last rows")
        time.sleep(1.0)  # rows that are still on their way
        at = comparisons.messages()[-1].header.stamp
        return launch, verdicts, sum(stamp <= at for stamp in stamps)

    def judge_case(self, arm, rows, compared, _every_way):
        launch, verdicts, judged = self.play(arm, rows)
        write_csv("judged.csv", *(values[:judged] for values in rows))
        expected = verdicts_in(self.tool("compare", "judged.csv", "--arm", arm))

        def check():
            for joint, verdict in expected.items():
                last = verdicts[joint].messages()[-1]
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
        launch.interrupt()


if __name__ == "__main__":
    rospy.init_node("every_way_test")
    rostest.rosrun(PACKAGE, "every_way", EveryWay, sys.argv)
