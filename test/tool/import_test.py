# SPDX-License-Identifier: BSD-3-Clause
"""`joint_twin import`."""
import os

import tool


class Import(tool.ToolTest):
    def test_telemetry_command_and_load_stand_in_the_bag(self):
        lines = tool.telemetry_csv(rows=25)
        self.write("a.csv", "\n".join(lines) + "\n")
        summary = self.succeed_json("import", "a.csv", "--joint", 2, "--out", "a.bag")
        self.assertEqual((summary["rows"], summary["messages"], summary["joint"]), (25, 75, "elbow_joint"))
        telemetry = tool.series(self.path("a.bag"), "/joint_states")
        commands = tool.series(self.path("a.bag"), "/joint_twin/command")
        loads = tool.series(self.path("a.bag"), "/joint_twin/load")
        for row, ((at, state), (_, command), (_, load)) in enumerate(zip(telemetry, commands, loads)):
            self.assertAlmostEqual(at, row * 0.008, delta=1e-9)
            self.assertEqual(state.name, tool.JOINT_NAMES)
            for joint in range(6):
                self.assertAlmostEqual(state.position[joint], 0.1 * joint + 0.001 * row, delta=1e-9)
            self.assertEqual(list(state.velocity), [0.125] * 6)
            self.assertEqual(list(state.effort), [0.5 + joint for joint in range(6)])
            self.assertEqual((command.name, list(command.effort)), (["elbow_joint"], [2.5 * (10.7 / 101)]))
            self.assertEqual((load.name, list(load.effort)), (["elbow_joint"], [2.0]))
            self.assertEqual(state.header.stamp, command.header.stamp)
            self.assertEqual(state.header.stamp, load.header.stamp)

    def test_temperatures_that_were_recorded_stand_in_the_bag_once_a_second(self):
        head, *rows = tool.telemetry_csv(rows=300)
        lines = [head + ",joint_temperatures_2"] + [f"{row},{30.0 + 0.01 * i:.2f}" for i, row in enumerate(rows)]
        self.write("a.csv", "\n".join(lines) + "\n")
        self.succeed("import", "a.csv", "--joint", 2, "--out", "a.bag")
        messages = [message for _, message in tool.series(self.path("a.bag"), "/joint_temperatures")]
        self.assertEqual([(message.header.frame_id, message.temperature) for message in messages],
                         [("elbow_joint", 30.0), ("elbow_joint", 31.25), ("elbow_joint", 32.5)])

    def test_gain_ratio_start_and_namespace_can_be_given(self):
        self.write("a.csv", "\n".join(tool.telemetry_csv(rows=3)))
        self.succeed("import", "a.csv", "--joint", 0, "--out", "a.bag", "--gain", 8, "--ratio", 100, "--start-time", 5,
                     "--joint-namespace", "/base/twin")
        messages = tool.series(self.path("a.bag"), "/base/twin/command")
        self.assertEqual([list(message.effort) for _, message in messages], [[0.5 * (8.0 / 100.0)]] * 3)
        self.assertEqual(messages[1][1].header.stamp.to_nsec(), 5008000000)

    def test_same_input_gives_the_same_bytes(self):
        self.write("a.csv", "\n".join(tool.telemetry_csv()))
        for name in ["a.bag", "b.bag"]:
            self.succeed("import", "a.csv", "--joint", 1, "--out", name)
        self.assertEqual(tool.read_bytes(self.path("a.bag")), tool.read_bytes(self.path("b.bag")))

    def test_what_stands_before_a_bad_line_is_a_readable_bag(self):
        good = tool.telemetry_csv(rows=25)
        cells = good[11].split(",")

        def with_line_12(line):
            return good[:11] + [line] + good[12:]

        for lines, part in [(with_line_12(",".join(["0.080000", ""] + cells[2:])), "column 'target_moment_0' is empty"),
                            (with_line_12(",".join(cells[:-1])), "too few columns"),
                            (with_line_12(good[11] + ",1"), "too many columns"),
                            (with_line_12(",".join(["0.080000", "many"] + cells[2:])), "'many' is not a finite number"),
                            (with_line_12(",".join(["0.080000", "nan"] + cells[2:])), "'nan' is not a finite number"),
                            (with_line_12(",".join(["0.080000", "-inf"] + cells[2:])), "'-inf' is not a finite number"),
                            (with_line_12(",".join(["0.072000"] + cells[1:])), "time goes back"),
                            (with_line_12(",".join(["0.010000"] + cells[1:])), "time goes back"),
                            (good[:11] + [good[11][:40]], "too few columns")]:
            with self.subTest(part):
                self.write("a.csv", "\n".join(lines) + "\n")
                self.fail_with(1, ["a.csv:12: ", part, "a.bag is readable and contains the 10 rows before it"],
                               "import", "a.csv", "--joint", 0, "--out", "a.bag", "--force", "--json")
                self.assertEqual(len(tool.series(self.path("a.bag"), "/joint_twin/command")), 10)
                self.assertFalse(os.path.exists(self.path("a.bag.active")))

    def test_files_of_another_kind_are_refused_and_leave_nothing(self):
        good = tool.telemetry_csv(rows=2)
        for text, parts in [("\n".join([good[0].replace("actual_q_3", "q3")] + good[1:]),
                             ["a.csv:1: column 'actual_q_3' is missing"]),
                            ("time,motor_torque\n0,1\n", ["columns 'timestamp', ", "are missing"]),
                            (good[0].replace("target_q_1", "actual_q_1") + "\n",
                             ["a.csv:1: column 'actual_q_1' occurs twice"]),
                            (good[0] + "\n", ["a.csv has no rows"]),
                            (good[0] + "\n" + ",".join(["x"] * 31) + "\n", ["a.csv:2: ", "nothing was written"]),
                            (good[0] + "\n" + good[1] + "\0\n", ["a.csv:2: the file contains a zero byte"]),
                            ("", ["a.csv:1: the header is missing"]), ("#ROSBAG V2.0\n\0\1\2", ["a.csv"])]:
            with self.subTest(parts):
                self.write("a.csv", text)
                self.fail_with(1, parts, "import", "a.csv", "--joint", 0, "--out", "a.bag")
                self.assertEqual(sorted(os.listdir(self.directory)), ["a.csv"])
        for path, reason in [("nowhere.csv", "No such file"), (".", "Is a directory")]:
            self.fail_with(1, [f"{path} cannot be read: {reason}"], "import", path, "--joint", 0, "--out", "a.bag")

    def test_marks_of_other_editors_change_nothing(self):
        lines = tool.telemetry_csv()
        texts = ["\n".join(lines) + "\n", "\n".join(lines), "\ufeff" + "\r\n".join(lines) + "\r\n",
                 "\n".join(line.replace(",", " ,\t") for line in lines) + "\n"]
        found = []
        for text in texts:
            self.write("a.csv", text)
            self.succeed("import", "a.csv", "--joint", 0, "--out", "a.bag", "--force")
            found.append(tool.series(self.path("a.bag"), "/joint_twin/command"))
        self.assertGreater(len(found[0]), 0)
        for other in found[1:]:
            self.assertEqual(other, found[0])

    def test_existing_output_is_kept_without_force(self):
        self.write("a.csv", "\n".join(tool.telemetry_csv()))
        self.write("a.bag", "precious")
        self.fail_with(1, ["a.bag exists; --force overwrites it"], "import", "a.csv", "--joint", 0, "--out", "a.bag")
        self.assertEqual(tool.read_bytes(self.path("a.bag")), b"precious")
        self.succeed("import", "a.csv", "--joint", 0, "--out", "a.bag", "--force")

    def test_a_joint_has_a_name_too(self):
        self.write("a.csv", "\n".join(tool.telemetry_csv()) + "\n")
        for joint in ("elbow", "elbow_joint", "2"):
            found = self.succeed_json("import", "a.csv", "--joint", joint, "--out", "a.bag", "--force")
            self.assertEqual(found["joint"], "elbow_joint")
        self.fail_with(2, ["'elbo' is no joint", "wrist_3"], "import", "a.csv", "--joint", "elbo", "--out", "b.bag")


if __name__ == "__main__":
    tool.main()
