#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""One verdict by every way: a recording of a UR5 as a table and a bag, compared and checked by the tool, as arrays in
Python, among the recordings of a trend, and followed into a bag. The live node's is held against compare's in
ros/verdict_test.py. Argument: the tool.

Each case is the arm that the twins predict, with noise. Its verdict by `joint_twin compare` is known, and every other
way has to give the same fields."""
import json
import os
import subprocess
import sys
import tempfile
import unittest
import warnings

import numpy as np
import rosbag

import harmonic_joint_twin as hjt
from harmonic_joint_twin.msg import Verdict

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "support"))
from ur_recording import write_bag, write_csv  # noqa: E402

TOOL = sys.argv.pop(1)
ARM = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "config", "arms", "ur5.yaml")
JOINTS = ["base", "shoulder", "elbow", "wrist_1", "wrist_2", "wrist_3"]
GAINS = np.array([10.7, 10.7, 10.7, 10.21, 11.9, 11.92])  # of config/arms/ur5.yaml [N.m/A]
PERIOD, SECONDS = 1.0 / 64.0, 36.0  # stamps are the same in seconds and in whole nanoseconds
NOISE = 0.03  # [A]
# Of each joint: middle [rad], amplitude [rad], frequency [rad/s], phase.
SWINGS = np.array([[0.2, 0.8, 0.55, 0.3], [-1.3, 0.5, 0.83, 1.1], [1.0, 0.7, 0.71, 2.0], [-1.0, 0.8, 0.91, 0.5],
                   [-1.2, 0.7, 0.63, 1.7], [0.4, 0.9, 1.03, 2.6]])
LEVELS = {Verdict.OK: "OK", Verdict.WARN: "WARN", Verdict.ERROR: "ERROR", Verdict.NOT_JUDGED: "NOT JUDGED"}
FIELDS = ("joint", "level", "reason", "friction_measured", "friction_factor", "friction_lower", "friction_upper",
          "friction_has_interval", "causes", "cause_weights", "evidence_names", "evidence_values", "evidence_units",
          "text")
NUMBERS = ("friction_factor", "friction_lower", "friction_upper", "cause_weights", "evidence_values")
RARELY = {f"publish.{topic}_rate": 0.01 for topic in ("contact_forces", "encoders", "health", "stress")}


def motion():
    times = np.round(np.arange(0.0, SECONDS, PERIOD), 9)
    middle, amplitude, frequency, phase = SWINGS.T
    at = frequency * times[:, None] + phase
    return times, middle + amplitude * np.sin(at) + 0.25 * amplitude * np.sin(2.3 * at)


def arm_file(name, content):
    with open(name, "w", encoding="ascii") as file:
        file.write(f"like: {ARM}\n{content}\n")
    return os.path.abspath(name)


def recorded(arm, times, angles, degrees=25.0):
    """Currents of that arm, and the friction in them [A]."""
    still = {"time": times, "position": angles, "current": np.zeros_like(angles)}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # no current flows
        rows = hjt.follow(still, arm=arm, overlays={"input.temperature": degrees})["comparison"]

    def column(name):
        return np.column_stack([np.interp(times, rows[joint]["time"], rows[joint][name]) for joint in JOINTS])
    noise = np.random.default_rng(7).normal(0.0, NOISE, angles.shape)
    return column("current_predicted") + noise, column("friction_torque") / GAINS


def last_verdicts(path):
    """Of a bag, as the document of compare has them."""
    verdicts = {}
    with rosbag.Bag(path) as bag:
        for joint in JOINTS:
            *_, (_, message, _) = bag.read_messages(f"/{joint}/joint_twin/verdict")
            verdicts[joint] = {field: getattr(message, field) for field in FIELDS}
            verdicts[joint]["level"] = LEVELS[message.level]
    return verdicts


def tool(*words):
    done = subprocess.run([TOOL, *map(str, words), "--json"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                          check=False)
    if not done.stdout:
        raise AssertionError(done.stderr)
    return json.loads(done.stdout)


def verdicts_in(document):
    return {joint.get("name", joint["joint"]): joint["verdict"] for joint in document["joints"]}


class Verdicts(unittest.TestCase):
    maxDiff = None

    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        os.chdir(folder.name)
        cls.addClassCleanup(os.chdir, "/")
        cls.times, cls.angles = motion()
        cls.loaded = arm_file("loaded.yaml", "payload: {mass: 4.0, centre: [0.0, 0.03, 0.08]}")
        cls.currents, cls.friction = recorded("ur5", cls.times, cls.angles)

    def same(self, way, found, expected):
        """`found`: of each joint, what that way tells."""
        self.assertEqual(list(found), list(expected), way)
        for joint, verdict in expected.items():
            for field in FIELDS:
                mine, other = found[joint][field], verdict[field]
                where = (way, joint, field, found[joint]["text"], verdict["text"])
                if field == "reason" and not isinstance(mine, str):
                    self.assertEqual(mine, getattr(Verdict, other), where)
                elif field in NUMBERS:
                    # A message has 0 for a number that is none.
                    mine, other = ([0.0 if one is None else one for one in np.atleast_1d(value)]
                                   for value in (mine, other))
                    np.testing.assert_allclose(np.array(mine, float), np.array(other, float), 1e-5, 1e-6, True,
                                               str(where))
                else:
                    self.assertEqual(list(mine) if isinstance(mine, (list, tuple)) else mine, other, where)

    def judge(self, levels, arm="ur5", times=None, angles=None, currents=None, says="", every_way=False):
        """`levels`: of compare, from the base on; one stands for all. `says`: is in its text. `every_way`: by check
        and trend too, which are compare's own functions."""
        times, angles, currents = (mine if given is None else given for mine, given in
                                   ((self.times, times), (self.angles, angles), (self.currents, currents)))
        write_csv("arm.csv", times, angles, currents)
        write_bag("arm.bag", times, angles, currents)
        compared = tool("compare", "arm.csv", "--arm", arm)
        expected = verdicts_in(compared)
        found = [verdict["level"] for verdict in expected.values()]
        self.assertEqual(found, levels if isinstance(levels, list) else [levels] * 6, compared["text"])
        self.assertIn(says, compared["text"])
        columns = {"time": times, "position": angles, "current": currents}
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # remarks on the recording, which the tool's way has too
            self.same("arrays", verdicts_in(hjt.compare(columns, arm=arm)), expected)
            hjt.follow("arm.bag", arm=arm, bag="with_twin.bag", force=True, overlays=RARELY)
        self.same("follow", last_verdicts("with_twin.bag"), expected)
        if every_way:
            self.same("check", verdicts_in(tool("check", "arm.bag", "--arm", arm)), expected)
            dated = tool("trend", "arm.csv", "--arm", arm)["recordings"][0]
            self.assertEqual([joint["level"] for joint in dated["joints"]], found)
            self.assertEqual(dated["text"], compared["text"])
        return expected

    def test_sound(self):
        self.judge("OK", every_way=True)

    def test_payload_that_is_stated(self):
        currents, _ = recorded(self.loaded, self.times, self.angles)
        self.judge("OK", self.loaded, currents=currents)

    def test_payload_that_nobody_configured(self):
        currents, _ = recorded(self.loaded, self.times, self.angles)
        self.judge("OK", currents=currents, says="payload of ", every_way=True)

    def test_pick_and_place(self):
        loaded, _ = recorded(self.loaded, self.times, self.angles)
        carried = (self.times // 10.0 % 2.0 == 1.0)[:, None]
        self.judge("OK", currents=np.where(carried, loaded, self.currents), says="The payload changes")

    def test_one_gain(self):
        self.judge(["OK", "OK", "NOT JUDGED", "OK", "OK", "OK"], currents=self.currents * [1, 1, 1.4, 1, 1, 1])

    def test_cold_arm(self):
        currents, _ = recorded("ur5", self.times, self.angles, 5.0)
        self.judge("OK", currents=currents, says="degC")

    def test_worn_joint(self):
        more = 0.5 * self.friction * [0, 1, 0, 0, 0, 0]
        self.judge(["OK", "WARN", "OK", "OK", "OK", "OK"], currents=self.currents + more, every_way=True)

    def test_arm_on_a_wall(self):
        currents, _ = recorded(arm_file("wall.yaml", "gravity: [0.0, -9.82, 0.0]"), self.times, self.angles)
        self.judge("OK", currents=currents, says="tilted by")

    def test_angles_folded_into_one_turn(self):
        turned = self.angles + [2.9, 0, 0, 0, 0, 0]  # upright, the base's angle is no load
        self.judge("OK", angles=(turned + np.pi) % (2.0 * np.pi) - np.pi)

    def test_stamps_in_bunches(self):
        rows = len(self.times) // 2 * 2
        late = np.repeat(self.times[1:rows:2], 2) + np.tile([0.0, 1.0 / 512.0], rows // 2)
        self.judge("OK", times=late, angles=self.angles[:rows], currents=self.currents[:rows])

    def test_values_held_by_a_driver(self):
        row = np.repeat(np.arange(len(self.times)), 4)
        self.judge("OK", times=np.round(0.25 * PERIOD * np.arange(len(row)), 9), angles=self.angles[row],
                   currents=self.currents[row])


if __name__ == "__main__":
    unittest.main()
