# SPDX-License-Identifier: BSD-3-Clause
"""`joint_twin replay`, and `import`, which makes the bags for it."""
import os
import signal
import struct
import time

import genpy
import rosbag
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64

import tool


class Replay(tool.ToolTest):
    def replay(self, name="in.bag", out="out.bag", *arguments):
        return self.succeed("replay", name, "--out", out, *arguments)

    def test_originals_are_untouched_and_everything_is_in_order_of_time(self):
        tool.write_recording(self.path("in.bag"), duration=1.1)  # every topic at least once
        self.replay()
        original = tool.raw_messages(self.path("in.bag"))
        replayed = tool.raw_messages(self.path("out.bag"))
        topics = {message[0] for message in original}
        self.assertEqual({message[0] for message in replayed} - topics, tool.SIMULATED_TOPICS)
        for topic in topics:
            self.assertEqual([message for message in replayed if message[0] == topic],
                             [message for message in original if message[0] == topic])
        with rosbag.Bag(self.path("in.bag")) as before, rosbag.Bag(self.path("out.bag")) as after:
            headers = {connection.topic: connection.header for connection in after._get_connections()}
            for connection in before._get_connections():
                self.assertEqual(headers[connection.topic], connection.header)
        # The file itself, not only its index, is in order: message positions ascend with time.
        with rosbag.Bag(self.path("out.bag")) as bag:
            entries = sorted(((entry.chunk_pos, entry.offset), entry.time) for entry in bag._get_entries())
        self.assertEqual([at for _, at in entries], sorted(at for _, at in entries))

    def test_simulated_messages_carry_the_simulated_instant(self):
        tool.write_recording(self.path("in.bag"), duration=0.2)
        self.replay()
        for topic, period in [("joint_states", 0.001), ("encoders", 0.001), ("contact_forces", 0.01), ("health", 0.1)]:
            messages = tool.series(self.path("out.bag"), f"/joint_twin/{topic}")
            self.assertEqual(len(messages), int(0.2011 / period), topic)
            for index, (at, message) in enumerate(messages):
                self.assertAlmostEqual(at, (index + 1) * period, delta=1e-9)
                self.assertAlmostEqual((message.header.stamp - genpy.Time(tool.START)).to_sec(), at, delta=1e-9)
        states = tool.series(self.path("out.bag"), "/joint_twin/joint_states")
        self.assertEqual(states[0][1].name, ["elbow_joint_motor", "elbow_joint"])
        self.assertGreater(max(message.position[0] for _, message in states), 0.1)

    def test_unstamped_torques_count_at_the_time_of_recording(self):
        with rosbag.Bag(self.path("in.bag"), "w") as bag:
            for step in range(26):
                at = genpy.Time(tool.START) + genpy.Duration.from_sec(0.008 * step)
                bag.write("/joint_twin/motor_torque_command", Float64(0.4), at)
                bag.write("/joint_twin/load_torque", Float64(5.0 if step < 13 else 7.0), at)
        self.replay("in.bag", "out.bag", "--set", "joint.name=elbow_joint")
        states = tool.series(self.path("out.bag"), "/joint_twin/joint_states")
        self.assertEqual({message.effort[0] for _, message in states}, {0.4})

    def test_shipped_files_of_a_recorded_load_do_not_degrade_the_solver(self):
        # recorded_load.yaml leaves little inertia at the output; the step must resolve its swing on the stiffest slope
        # too.
        for joint, name in [("base", "shoulder_pan_joint"), ("shoulder", "shoulder_lift_joint"),
                            ("elbow", "elbow_joint")]:
            for load in (5.0, 140.0):
                with self.subTest(joint=joint, load=load):
                    tool.write_recording(self.path("in.bag"), joint=name, load=load)
                    done = self.replay("in.bag", "out.bag", "--force", "--config", f"joints/{joint}.yaml", "--config",
                                       "recorded_load.yaml")
                    self.assertNotIn("too long", done.stdout + done.stderr)
                    health = [message for _, message in tool.series(self.path("out.bag"), "/joint_twin/health")]
                    self.assertEqual({message.solver_state for message in health}, {0})

    def test_torques_that_are_not_finite_are_refused_and_counted(self):
        tool.write_recording(self.path("in.bag"), duration=0.1)
        with rosbag.Bag(self.path("in.bag"), "a") as bag:
            for index, torque in enumerate([float("nan"), float("inf")]):
                message = tool.stamped_torque("elbow_joint", torque, 0.05)
                bag.write("/joint_twin/command", message, message.header.stamp + genpy.Duration(0, 100 + index))
        done = self.replay()
        self.assertIn("2 inputs were refused because they were not finite", done.stderr)
        for _, message in tool.series(self.path("out.bag"), "/joint_twin/joint_states"):
            for value in [*message.position, *message.velocity, *message.effort]:
                self.assertTrue(abs(value) < 1e6, value)

    def test_bag_without_inputs_says_what_it_holds(self):
        with rosbag.Bag(self.path("in.bag"), "w") as bag:
            bag.write("/chatter", Float64(1.0), genpy.Time(5))
        self.fail_with(1, ["no motor torque on an input topic", "/joint_twin/command", "/chatter (std_msgs/Float64)"],
                       "replay", "in.bag", "--out", "out.bag")
        self.assertEqual(os.listdir(self.directory), ["in.bag"])

    def test_a_bag_without_commands_is_replayed_on_request_alone(self):
        # One letter of a topic's name is damaged: what is left of the inputs is the load.
        tool.write_recording(self.path("in.bag"), duration=0.1)
        content = tool.read_bytes(self.path("in.bag")).replace(b"topic=/joint_twin/command",
                                                               b"topic=/joint_twin/commend")
        with open(self.path("bad.bag"), "wb") as file:
            file.write(content)
        self.fail_with(1, ["bad.bag has no motor torque on an input topic",
                           "/joint_twin/commend (sensor_msgs/JointState)",
                           "--without-command"], "replay", "bad.bag", "--out", "out.bag")
        self.assertFalse(os.path.exists(self.path("out.bag")))
        self.replay("bad.bag", "out.bag", "--without-command", "--set", "joint.name=elbow_joint")
        self.assertGreater(len(tool.series(self.path("out.bag"), "/joint_twin/joint_states")), 90)

    def test_a_damaged_time_of_recording_is_refused(self):
        tool.write_recording(self.path("in.bag"), duration=0.1)
        with rosbag.Bag(self.path("in.bag"), "a") as bag:
            bag.write("/foreign", Float64(1.0), genpy.Time(4000000000))
        started = time.monotonic()
        self.fail_with(1, ["in.bag: the times of recording span 3e+09 s, allowed: at most"],
                       "replay", "in.bag", "--out", "out.bag")
        self.assertLess(time.monotonic() - started, 5.0 * tool.SLOWER)

    def test_damaged_messages_are_left_out_and_counted(self):
        tool.write_recording(self.path("in.bag"), duration=0.1)
        with rosbag.Bag(self.path("in.bag"), "a") as bag:
            # A list of 2^32 - 1 names would take 100 GB.
            body = struct.pack("<IIIII", 0, tool.START, 0, 0, 2**32 - 1)
            bag.write("/joint_twin/command", ("sensor_msgs/JointState", body, JointState._md5sum, JointState),
                      genpy.Time(tool.START, 50000000), raw=True)
        code, _, memory = self.measure("replay", "in.bag", "--out", "out.bag")
        self.assertEqual(code, 0)
        self.assertLess(memory, 1e9)
        self.assertIn("1 damaged messages on input topics; ignored", self.replay("in.bag", "again.bag").stderr)

    def test_other_joints_are_not_mistaken_for_this_one(self):
        tool.write_recording(self.path("in.bag"), joint="elbow_joint")
        self.fail_with(1, ["contains commands for other joints (elbow_joint)", "joint.name = wrist"],
                       "replay", "in.bag", "--out", "out.bag", "--set", "joint.name=wrist")
        self.assertIn("joint.name = elbow_joint", self.replay().stderr)

    def test_wrong_types_and_clocks_are_refused(self):
        with rosbag.Bag(self.path("in.bag"), "w") as bag:
            bag.write("/joint_twin/command", Float64(1.0), genpy.Time(5))
        self.fail_with(1, ["/joint_twin/command has type std_msgs/Float64, expected sensor_msgs/JointState"],
                       "replay", "in.bag", "--out", "out.bag")
        with rosbag.Bag(self.path("in.bag"), "w") as bag:
            bag.write("/joint_twin/command", tool.stamped_torque("joint", 0.1, 0.0), genpy.Time(tool.START + 3600))
        self.fail_with(1, ["the clocks do not agree"], "replay", "in.bag", "--out", "out.bag")

    def test_topics_of_an_earlier_replay_are_not_mixed(self):
        tool.write_recording(self.path("in.bag"), duration=0.02)
        self.replay()
        self.fail_with(1, ["out.bag holds /joint_twin/", "already"], "replay", "out.bag", "--out", "twice.bag")

    def test_damaged_and_foreign_files_are_refused(self):
        tool.write_recording(self.path("in.bag"))
        whole = tool.read_bytes(self.path("in.bag"))
        for name, content in [("empty", b""), ("text", b"time,motor_torque\n0,1\n"), ("magic", b"#ROSBAG V2.0\n"),
                              ("head", whole[:5000]), ("tail", whole[:-1000])]:
            with self.subTest(name):
                with open(self.path("bad.bag"), "wb") as file:
                    file.write(content)
                self.fail_with(1, ["bad.bag"], "replay", "bad.bag", "--out", "out.bag", "--json")
                self.assertFalse(os.path.exists(self.path("out.bag")))
        self.fail_with(1, ["nowhere.bag"], "replay", "nowhere.bag", "--out", "out.bag")

    def test_what_stands_before_a_damaged_chunk_is_a_readable_bag(self):
        with rosbag.Bag(self.path("in.bag"), "w", chunk_threshold=5000) as bag:
            for step in range(200):
                message = tool.stamped_torque("elbow_joint", 0.1, 0.001 * step)
                bag.write("/joint_twin/command", message, message.header.stamp)
                bag.write("/foreign", JointState(name=["x" * 100]), message.header.stamp)
        with rosbag.Bag(self.path("in.bag")) as bag:
            entries = sorted((entry.chunk_pos, entry.offset)
                             for entry in bag._get_entries(bag._get_connections(["/foreign"])))
            chunk, offset = entries[120]
            record = bag._chunk_headers[chunk].data_pos + offset
        # The kind of the record, message data, becomes one that there is not.
        content = bytearray(tool.read_bytes(self.path("in.bag")))
        kind = content.index(b"op=\x02", record) + 3
        self.assertLess(kind - record, 100)
        content[kind] = 9
        with open(self.path("bad.bag"), "wb") as file:
            file.write(content)
        done = self.fail_with(1, ["bad.bag"], "replay", "bad.bag", "--out", "out.bag")
        self.assertIn("out.bag is readable", done.stderr)
        self.assertGreater(len(tool.raw_messages(self.path("out.bag"))), 100)

    def test_existing_output_is_kept_without_force(self):
        tool.write_recording(self.path("in.bag"), duration=0.02)
        self.write("out.bag", "precious")
        self.fail_with(1, ["out.bag exists; --force overwrites it"], "replay", "in.bag", "--out", "out.bag")
        self.assertEqual(tool.read_bytes(self.path("out.bag")), b"precious")
        self.replay("in.bag", "out.bag", "--force")
        self.fail_with(1, ["is the input file"], "replay", "in.bag", "--out", "in.bag", "--force")

    def test_interrupts_close_the_bag(self):
        tool.write_recording(self.path("in.bag"), duration=60.0)
        for number in [signal.SIGTERM, signal.SIGINT]:
            name = f"{int(number)}.bag"
            code, errors = self.interrupt_while_writing(name, number, "replay", "in.bag", "--out", name)
            self.assertEqual(code, 128 + number)
            self.assertIn(b"contains everything up to the interrupt", errors)
            self.assertGreater(len(tool.raw_messages(self.path(name))), 10)


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
                self.fail_with(1, ["a.csv:12: ", part, "a.bag is readable and contains the 10 rows before the error"],
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


if __name__ == "__main__":
    tool.main()
