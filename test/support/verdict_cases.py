# SPDX-License-Identifier: BSD-3-Clause
"""Recordings of a UR5 whose verdicts are known: the arm that the twins predict, with noise."""
import json
import os
import subprocess
import tempfile
import warnings

import numpy as np

import harmonic_joint_twin as hjt
from harmonic_joint_twin.msg import Verdict
from ur_recording import write_csv

CHECKOUT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
ARM = os.path.join(CHECKOUT, "config", "arms", "ur5.yaml")
# With it `--report` writes its data and no page is drawn, which takes seconds for each joint.
NO_PAGE = {"PYTHONPATH": os.path.join(CHECKOUT, "test", "support", "no_page")}
JOINTS = ["base", "shoulder", "elbow", "wrist_1", "wrist_2", "wrist_3"]
GAINS = np.array([10.7, 10.7, 10.7, 10.21, 11.9, 11.92])  # of config/arms/ur5.yaml [N.m/A]
PERIOD, SECONDS = 1.0 / 64.0, 36.0  # of motion; stamps are the same in seconds and in whole nanoseconds
SLOWING, REST = 2.0, 1.0  # how the motion ends, and what follows: a live stream's last rows are not judged [s]
NOISE = 0.03  # [A]
# Of each joint: middle [rad], amplitude [rad], frequency [rad/s], phase.
SWINGS = np.array([[0.2, 0.8, 0.55, 0.3], [-1.3, 0.5, 0.83, 1.1], [1.0, 0.7, 0.71, 2.0], [-1.0, 0.8, 0.91, 0.5],
                   [-1.2, 0.7, 0.63, 1.7], [0.4, 0.9, 1.03, 2.6]])
LEVELS = {Verdict.OK: "OK", Verdict.WARN: "WARN", Verdict.ERROR: "ERROR", Verdict.NOT_JUDGED: "NOT JUDGED"}
FIELDS = ("joint", "level", "reason", "friction_measured", "friction_factor", "friction_lower", "friction_upper",
          "friction_has_interval", "causes", "cause_weights", "evidence_names", "evidence_values", "evidence_units",
          "text")
NUMBERS = ("friction_factor", "friction_lower", "friction_upper", "cause_weights", "evidence_values")


def motion(seconds=SECONDS):
    times = np.round(np.arange(0.0, seconds + REST, PERIOD), 9)
    left = np.clip((seconds - times) / SLOWING, 0.0, 1.0)
    way = np.cumsum(left * left * (3.0 - 2.0 * left)) * PERIOD
    middle, amplitude, frequency, phase = SWINGS.T
    at = frequency * way[:, None] + phase
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


def verdicts_in(document):
    return {joint.get("name", joint["joint"]): joint["verdict"] for joint in document["joints"]}


class VerdictCases:
    """Each case is a test; `judge_case` holds it against `joint_twin compare` in the ways that are tested."""
    maxDiff = None
    tool_path = None

    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        os.chdir(folder.name)
        cls.addClassCleanup(os.chdir, "/")
        cls.times, cls.angles = motion()
        cls.loaded = arm_file("loaded.yaml", "payload: {mass: 4.0, centre: [0.0, 0.03, 0.08]}")
        cls.currents, cls.friction = recorded("ur5", cls.times, cls.angles)

    def tool(self, *words):
        done = subprocess.run([self.tool_path, *map(str, words), "--json"], stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, text=True, check=False, env={**os.environ, **NO_PAGE})
        if not done.stdout:
            raise AssertionError(done.stderr)
        return json.loads(done.stdout)

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

    def judge(self, levels, arm="ur5", times=None, angles=None, currents=None, says="", every_way=False,
              reference=None):
        """`levels`: of compare, from the base on; one stands for all. `says`: is in its text. `every_way`: by check
        and trend too, which are compare's own functions. `reference`: folder of a report."""
        rows = tuple(mine if given is None else given for mine, given in
                     ((self.times, times), (self.angles, angles), (self.currents, currents)))
        write_csv("arm.csv", *rows)
        compared = self.tool("compare", "arm.csv", "--arm", arm, *(["--reference", reference] if reference else []))
        expected = verdicts_in(compared)
        found = [verdict["level"] for verdict in expected.values()]
        self.assertEqual(found, levels if isinstance(levels, list) else [levels] * 6, compared["text"])
        self.assertIn(says, compared["text"])
        self.judge_case(arm, rows, compared, every_way, reference)

    def test_sound(self):
        self.judge("OK", every_way=True)

    def test_payload_that_is_stated(self):
        currents, _ = recorded(self.loaded, self.times, self.angles)
        self.judge("OK", self.loaded, currents=currents)

    def test_payload_that_nobody_configured(self):
        currents, _ = recorded(self.loaded, self.times, self.angles)
        self.judge("OK", currents=currents, says="payload of ", every_way=True)

    def test_payload_that_is_configured_and_not_carried(self):
        self.judge("OK", self.loaded, says="show no payload")

    def test_pick_and_place(self):
        loaded, _ = recorded(self.loaded, self.times, self.angles)
        carried = (self.times // 10.0 % 2.0 == 1.0)[:, None]
        self.judge("OK", currents=np.where(carried, loaded, self.currents), says="The payload changes")

    def test_one_gain(self):
        self.judge(["OK", "OK", "NOT JUDGED", "OK", "OK", "OK"], currents=self.currents * [1, 1, 1.4, 1, 1, 1])

    def test_currents_of_the_other_sign(self):
        self.judge(["OK", "OK", "NOT JUDGED", "OK", "OK", "OK"], currents=self.currents * [1, 1, -1, 1, 1, 1],
                   says="sign")

    def test_efforts_in_newton_metres(self):
        self.judge("NOT JUDGED", currents=self.currents * GAINS, says="telemetry.effort: joint_torque")

    def test_currents_of_another_time(self):
        late = np.column_stack([np.interp(self.times - 0.2, self.times, current) for current in self.currents.T])
        self.judge("NOT JUDGED", currents=late, says="0.2 s later than the motion")

    def test_another_arm(self):
        self.judge("NOT JUDGED", "ur10", says="The arm may be a ur5")

    def test_cold_arm(self):
        currents, _ = recorded("ur5", self.times, self.angles, 5.0)
        self.judge("OK", currents=currents, says="degC")

    def test_worn_joint(self):
        more = 0.5 * self.friction * [0, 1, 0, 0, 0, 0]
        self.judge(["OK", "WARN", "OK", "OK", "OK", "OK"], currents=self.currents + more, every_way=True)

    def test_joint_worn_since_its_report(self):
        write_csv("sound.csv", self.times, self.angles, self.currents)
        self.tool("compare", "sound.csv", "--arm", "ur5", "--report", "sound")
        more = 0.3 * self.friction * [1, 0, 0, 0, 0, 0]
        self.judge(["WARN", "OK", "OK", "OK", "OK", "OK"], currents=self.currents + more, reference="sound")

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
