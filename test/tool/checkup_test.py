# SPDX-License-Identifier: BSD-3-Clause
"""`joint_twin checkup`."""
import csv
import math
import os
import re

import tool


class Checkup(tool.ToolTest):
    def rows(self, name):
        with open(self.path(name), newline="", encoding="utf-8") as file:
            return [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]

    def test_the_joint_alone_moves_within_the_limits_and_its_load_swings_through_zero(self):
        summary = self.succeed_json("checkup", "--arm", "ur5", "--joint", "shoulder", "--out", "a.csv")
        rows = self.rows("a.csv")
        self.assertAlmostEqual(rows[-1]["time"], summary["duration"], delta=1e-9)
        self.assertLessEqual(max(abs(row["shoulder_velocity"]) for row in rows), math.pi)
        torques = [row["shoulder_torque"] for row in rows]
        self.assertTrue(-150.0 < min(torques) < -50.0 and 50.0 < max(torques) < 150.0)
        self.assertEqual({(row["base_velocity"], row["elbow_position"]) for row in rows}, {(0.0, 0.0)})
        self.assertEqual(rows[0]["shoulder_velocity"], 0.0)
        self.assertAlmostEqual(rows[-1]["shoulder_position"], rows[0]["shoulder_position"], delta=1e-9)

    def test_rates_are_the_derivatives_of_the_angles(self):
        self.succeed("checkup", "--arm", "ur5e", "--joint", "wrist_1_joint", "--out", "a.csv")
        rows = self.rows("a.csv")
        for before, row in zip(rows, rows[1:]):
            mean = 0.5 * (before["wrist_1_velocity"] + row["wrist_1_velocity"])
            self.assertAlmostEqual(row["wrist_1_position"] - before["wrist_1_position"], 0.008 * mean, delta=1.0e-4)

    def test_all_joints_come_one_after_the_other_and_the_program_makes_the_same_moves(self):
        one = self.succeed_json("checkup", "--arm", "ur5", "--joint", "base", "--out", "one.csv")
        summary = self.succeed_json("checkup", "--arm", "ur5", "--out", "a.script", "--format", "urscript")
        self.assertGreater(summary["duration"], 5.9 * one["duration"])
        with open(self.path("a.script"), encoding="utf-8") as file:
            moves = re.findall(r"movej\(\[([^\]]*)\], a=([^,]*), v=(.*)\)", file.read())
        self.assertEqual(len(moves), summary["moves"])
        self.assertTrue(all(len(move[0].split(",")) == 6 and float(move[2]) <= math.pi for move in moves))

    def test_a_link_to_a_pipe_is_written_into(self):
        link = self.path("link")
        os.symlink("/proc/self/fd/1", link)
        arguments = ["checkup", "--arm", "ur5", "--joint", "base", "--format", "urscript", "--out"]
        self.assertIn("def check_up():", self.succeed(*arguments, link, "--force").stdout)
        self.assertTrue(os.path.islink(link))
        self.succeed(*arguments, "a.script")
        os.symlink("a.script", self.path("other"))
        self.write("a.script", "")
        self.succeed(*arguments, "other", "--force")
        self.assertTrue(os.path.islink(self.path("other")))
        self.assertGreater(os.path.getsize(self.path("a.script")), 100)

    def test_the_bag_holds_the_table_as_a_trajectory(self):
        for name, how in (("a.csv", "csv"), ("a.bag", "bag")):
            self.succeed("checkup", "--arm", "ur5", "--joint", "elbow", "--out", name, "--format", how)
        rows = self.rows("a.csv")
        [(_, trajectory)] = tool.series(self.path("a.bag"), "/joint_trajectory")
        self.assertEqual(trajectory.joint_names, tool.JOINT_NAMES)
        self.assertEqual(len(trajectory.points), len(rows))
        for row, point in zip(rows, trajectory.points):
            self.assertAlmostEqual(point.time_from_start.to_sec(), row["time"], delta=1e-8)
            self.assertEqual((point.positions[2], point.velocities[2], point.accelerations[2]),
                             (row["elbow_position"], row["elbow_velocity"], row["elbow_acceleration"]))

    def write_arm(self, name, *changes):
        """The UR5's file, with texts replaced."""
        urdf = os.path.join(tool.CHECKOUT, "config/arms/ur5.urdf")
        with open(os.path.join(tool.CHECKOUT, "config/arms/ur5.yaml"), encoding="utf-8") as file:
            text = file.read().replace("description: ur5.urdf", f"description: {urdf}")
        for before, after in changes:
            self.assertIn(before, text)
            text = text.replace(before, after)
        self.write(name, text)

    def test_no_program_is_written_without_limits_or_for_hours(self):
        wrists = "limits: {speed: 3.141592653589793, torque: 28.0, feedback: 14.0}"
        for before, after, text in ((wrists, "", "wrist_1_joint has no limits"),
                                    ("torque: 150.0", "torque: .nan", "arm.yaml:31: joints.0.limits.torque = .nan"),
                                    ("[0.0, -1.5707963267948966,", "[0.0, -100.0,", "joints.1.check_up = [0.0, -100.0"),
                                    ("speed: 3.141592653589793", "speed: 0.001",
                                     "take more than 3600 s: it moves at 0.000833 rad/s")):
            self.write_arm("arm.yaml", (before, after))
            self.fail_with(1, [text], "checkup", "--arm", "arm.yaml", "--joint", "base", "--out", "a.script",
                           "--format", "urscript")
            self.assertFalse(os.path.exists(self.path("a.script")))

    def test_a_payload_beyond_the_torque_limit_is_refused_by_the_joint(self):
        self.write_arm("heavy.yaml", ("mass: 0.0", "mass: 15.0"))
        self.fail_with(1, ["shoulder_lift_joint", "limit is 150"], "checkup", "--arm", "heavy.yaml", "--joint",
                       "shoulder", "--out", "a.csv")
        self.fail_with(1, ["no joint 'knee'"], "checkup", "--arm", "ur5", "--joint", "knee", "--out", "a.csv")


if __name__ == "__main__":
    tool.main()
