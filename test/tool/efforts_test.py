# SPDX-License-Identifier: BSD-3-Clause
"""Efforts that are not of their motion: of another joint, of another time, of another gain, or of none."""
import numpy as np

import tool
from check_test import NAMES, sound, write_csv
from recorded import states, write_bag


class Efforts(tool.ToolTest):
    def setUp(self):
        super().setUp()
        self.columns = sound(self)

    def compare(self, columns, *more):
        """The arm's document, and the level of each joint."""
        write_csv(self.path("a.csv"), columns)
        arm = self.succeed_json("compare", "a.csv", "--arm", "ur5", *more)
        return arm, {joint["joint"]: joint["level"] for joint in arm["joints"]}

    def test_a_joint_without_efforts_is_not_judged_and_holds_up_no_other(self):
        for silent in (0, 4):
            name = NAMES[silent]
            none = np.full(len(self.columns["timestamp"]), np.nan)
            columns = dict(self.columns, **{f"actual_current_{silent}": none})
            arm, levels = self.compare(columns)
            self.assertEqual(levels, {joint: "NOT JUDGED" if joint == name else "OK" for joint in NAMES})
            write_bag(self.path("a.bag"), states(columns))
            found = self.succeed_json("check", "a.bag", "--arm", "ur5")
            self.assertEqual([joint["name"] for joint in found["joints"] if not joint["judged"]], [name])
            self.assertIn("never a number", " ".join(found["remarks"]))

    def test_fewer_efforts_than_names_are_nobodys(self):
        rows = list(states(self.columns))
        for _, state in rows:
            state.name = ["finger_joint"] + state.name
            state.position = [0.3] + state.position
            state.velocity = [0.0] + state.velocity
        write_bag(self.path("a.bag"), rows)
        for which in (["--joint", "elbow"], ["--arm", "ur5"]):
            self.fail_with(1, ["effort"], "compare", "a.bag", *which, "--json")
        self.fail_with(1, ["fewer efforts than names"], "compare", "a.bag", "--joint", "elbow", "--json")
        for _, state in rows:  # the gripper last: whose they are is plain
            state.name = state.name[1:] + state.name[:1]
            state.position = state.position[1:] + state.position[:1]
            state.velocity = state.velocity[1:] + state.velocity[:1]
        write_bag(self.path("b.bag"), rows)
        self.succeed("compare", "b.bag", "--joint", "elbow", "--json")

    def test_currents_of_another_time_are_said_and_not_judged(self):
        time = self.columns["timestamp"]
        for lag, word in ((0.2, "later"), (-0.15, "earlier")):
            late = {f"actual_current_{joint}": np.interp(time - lag, time, self.columns[f"actual_current_{joint}"])
                    for joint in range(6)}
            arm, levels = self.compare(dict(self.columns, **late))
            self.assertEqual(set(levels.values()), {"NOT JUDGED"})
            self.assertIn(word + " than the motion", arm["text"])
            self.assertRegex(arm["text"], "0.2 s later" if lag > 0.0 else "0.1[26] s earlier")
        self.assertEqual(set(self.compare(self.columns)[1].values()), {"OK"})

    def test_a_current_that_is_a_multiple_as_a_whole_is_no_friction(self):
        arm, levels = self.compare(dict(self.columns, actual_current_2=2.0 * self.columns["actual_current_2"]))
        self.assertEqual(levels, {joint: "NOT JUDGED" if joint == "elbow" else "OK" for joint in NAMES})
        self.assertIn("torque_per_current", arm["text"])

    def test_lines_may_end_with_a_carriage_return_alone(self):
        name = write_csv(self.path("a.csv"), self.columns)
        plain = self.succeed_json("check", "a.csv", "--arm", "ur5")
        with open(name, "rb") as file:
            text = file.read()
        for end in (b"\r", b"\r\n"):
            with open(name, "wb") as file:
                file.write(text.replace(b"\n", end))
            self.assertEqual(self.succeed_json("check", "a.csv", "--arm", "ur5")["joints"], plain["joints"])


if __name__ == "__main__":
    tool.main()
