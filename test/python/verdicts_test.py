#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""One verdict by every way: a recording of a UR5 as a table and a bag, compared and checked by the tool, as arrays in
Python, among the recordings of a trend, and followed into a bag. The live node's: ros/every_way_test.py. Argument: the
tool."""
import os
import sys
import unittest
import warnings

import rosbag

import harmonic_joint_twin as hjt

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "support"))
from ur_recording import write_bag  # noqa: E402
from verdict_cases import FIELDS, JOINTS, LEVELS, VerdictCases, verdicts_in  # noqa: E402

RARELY = {f"publish.{topic}_rate": 0.01 for topic in ("contact_forces", "encoders", "health", "stress")}


def last_verdicts(path):
    """Of a bag, as the document of compare has them."""
    verdicts = {}
    with rosbag.Bag(path) as bag:
        for joint in JOINTS:
            *_, (_, message, _) = bag.read_messages(f"/{joint}/joint_twin/verdict")
            verdicts[joint] = {field: getattr(message, field) for field in FIELDS}
            verdicts[joint]["level"] = LEVELS[message.level]
    return verdicts


class Verdicts(VerdictCases, unittest.TestCase):
    tool_path = sys.argv.pop(1)

    def judge_case(self, arm, rows, compared, every_way, reference):
        write_bag("arm.bag", *rows)
        expected = verdicts_in(compared)
        arrays = dict(zip(("time", "position", "current"), rows))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # remarks on the recording, which the tool's way has too
            self.same("arrays", verdicts_in(hjt.compare(arrays, arm=arm, reference=reference)), expected)
            if reference:
                return
            hjt.follow("arm.bag", arm=arm, bag="with_twin.bag", force=True, overlays=RARELY)
        self.same("follow", last_verdicts("with_twin.bag"), expected)
        if every_way:
            self.same("check", verdicts_in(self.tool("check", "arm.bag", "--arm", arm)), expected)
            dated = self.tool("trend", "arm.csv", "--arm", arm)["recordings"][0]
            self.assertEqual([joint["level"] for joint in dated["joints"]],
                             [verdict["level"] for verdict in expected.values()])
            self.assertEqual(dated["text"], compared["text"])


if __name__ == "__main__":
    unittest.main()
