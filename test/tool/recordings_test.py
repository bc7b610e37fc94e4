# SPDX-License-Identifier: BSD-3-Clause
"""Recordings as people have them: formats, names, tables, what a recorder or a driver did to the rows, and files made
to exhaust a reader."""
import io
import json
import os
import shutil
import sqlite3
import struct
import subprocess

import genpy
import numpy as np
import rosbag
from sensor_msgs.msg import JointState

import tool
from recorded import record, sound, states, swinging, text, write_bag, write_csv, write_db3, write_mcap


class RecordingTest(tool.ToolTest):
    plain = {}  # what is found in the columns as they are

    def check(self, recording, *more):
        done = self.run_tool("check", recording, *more, "--json")
        self.assertIn(done.returncode, (0, 1), done.stderr)
        self.assertTrue(done.stdout, done.stderr)
        return json.loads(done.stdout)

    def assert_as_plain(self, found, rows=None):
        """Nothing of what was done to the rows is left in what the joints do."""
        if not RecordingTest.plain:
            RecordingTest.plain = self.check(write_csv(self.path("plain.csv"), self.columns))
        plain = RecordingTest.plain
        self.assertTrue(plain["usable"])
        self.assertEqual([joint["judged"] for joint in found["joints"]], [joint["judged"] for joint in plain["joints"]])
        self.assertEqual(found["findings"], plain["findings"])
        self.assertEqual(found["rows"], rows or plain["rows"])
        for joint, same in zip(found["joints"], plain["joints"]):
            for key in ("most_speed", "least_speed", "most_current"):
                self.assertAlmostEqual(joint[key], same[key], delta=0.03, msg=(joint["name"], key))

    def setUp(self):
        super().setUp()
        self.columns = sound(self)


class Recordings(RecordingTest):
    def test_ros_2_files_are_read_as_a_bag_is(self):
        self.assert_as_plain(self.check(write_db3(self.path("a.db3"), states(self.columns))))
        self.assert_as_plain(self.check(write_db3(self.path("big.db3"), states(self.columns), big=True)))
        self.assert_as_plain(self.check(write_mcap(self.path("a.mcap"), states(self.columns))))
        found = self.check(write_mcap(self.path("open.mcap"), states(self.columns), closed=False))
        self.assert_as_plain(found)
        self.assertIn("not closed", found["remarks"][0])
        os.mkdir(self.path("folder"))
        rows = list(states(self.columns))
        write_db3(self.path("folder/b_0.db3"), rows[:1000])
        write_db3(self.path("folder/b_1.db3"), rows[1000:])
        self.assert_as_plain(self.check("folder"))
        os.mkdir(self.path("split"))
        write_bag(self.path("split/b_0.bag"), rows[:1000])
        write_bag(self.path("split/b_1.bag"), rows[1000:])
        self.assert_as_plain(self.check("split"))
        done = self.run_tool("compare", "a.db3", "--arm", "ur5")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.succeed("follow", "a.mcap", "--arm", "ur5", "--bag", "out.bag")

    def test_compressed_chunks_of_mcap(self):
        packers = []
        for name, command in (("zstd", ["zstd", "-q", "-c"]), ("lz4", ["lz4", "-q", "-c"])):
            try:
                subprocess.run(command, input=b"x", stdout=subprocess.DEVNULL, check=True)
            except (OSError, subprocess.CalledProcessError):
                continue
            packers.append((name, lambda body, command=command: subprocess.run(
                command, input=body, stdout=subprocess.PIPE, check=True).stdout))
        if not packers:
            self.skipTest("neither zstd nor lz4 is here to pack with")
        for packer in packers:
            self.assert_as_plain(self.check(write_mcap(self.path(packer[0] + ".mcap"), states(self.columns), packer)))

    def test_other_files_are_named_by_what_they_are(self):
        for content, parts in ((b"SQLite format 3\0", ["SQLite", "rosbags-convert"]), (b"", ["is empty"]),
                               (b"\x89MCAP0\r\n", ["MCAP", "rosbags-convert"]),
                               (b"\x89HDF\r\n\x1a\n" + bytes(100), ["HDF5"]), (b"PK\x03\x04" + bytes(30), ["zip"]),
                               (b"\x28\xb5\x2f\xfd" + bytes(30), ["zstd -d"])):
            with open(self.path("a.bag"), "wb") as file:
                file.write(content)
            self.fail_with(1, ["a.bag", *parts], "check", "a.bag")
        write_bag(self.path("whole.bag"), list(states(swinging(seconds=20.0))))
        with open(self.path("whole.bag"), "rb") as whole, open(self.path("a.bag"), "wb") as file:
            file.write(whole.read()[:-100000])
        self.fail_with(1, ["a.bag", "rosbag reindex"], "check", "a.bag")

    def test_tables_as_programs_write_them(self):
        with open(write_csv(self.path("a.csv"), self.columns), encoding="ascii") as file:
            lines = file.read().splitlines()
        headers = (str, lambda line: "# " + line, lambda line: '"' + line.replace(",", '","') + '"')
        for separator, header in ((" ", headers[1]), ("\t", headers[2]), (";", headers[0]), ("  ", headers[0]),
                                  (", ", headers[2])):
            with open(self.path("a.txt"), "w", encoding="utf-8") as file:
                file.write("\ufeff" + "\r\n".join([header(lines[0])] + lines[1:]).replace(",", separator) + "\r\n")
            self.assert_as_plain(self.check("a.txt"))
        with open(self.path("cr.csv"), "w", encoding="ascii", newline="") as file:
            file.write("\r".join(lines))
        self.assert_as_plain(self.check("cr.csv"))
        with open(self.path("comma.csv"), "w", encoding="ascii") as file:
            file.write("\n".join([lines[0].replace(",", ";")] +
                                 [line.replace(",", ";").replace(".", ",") for line in lines[1:]]))
        self.assert_as_plain(self.check("comma.csv"))
        decimal = [lines[0]] + [",".join('"' + cell.replace(".", ",") + '"' for cell in line.split(","))
                                for line in lines[1:]]
        between_tabs = [lines[0].replace(",", "\t")] + [line.replace(",", "\t").replace(".", ",") for line in lines[1:]]
        unit_of = {"timestamp": "s", "actual_q": "rad", "actual_qd": "rad/s", "actual_current": "A"}
        units = [",".join(f"{name} [{unit_of[name.rstrip('_012345')]}]" for name in lines[0].split(","))] + lines[1:]
        with_comments = ["# by hand", "# ur5"] + lines[:500] + ["# a pause"] + lines[500:]
        for changed in (decimal, between_tabs, units, with_comments, lines[:1] + [line + "," for line in lines[1:]]):
            with open(self.path("other.csv"), "w", encoding="ascii") as file:
                file.write("\n".join(changed))
            self.assert_as_plain(self.check("other.csv"))

    def test_times_of_another_unit_are_tried(self):
        for scale in (1e3, 1e6, 1e9):
            changed = dict(self.columns, timestamp=scale * self.columns["timestamp"])
            write_csv(self.path("a.csv"), changed)
            found = self.check("a.csv", "--arm", "ur5")
            self.assertEqual(found["findings"][0]["kind"], "period")
            tried, = found["tried"]
            self.assertTrue(tried["helps"])
            self.assertAlmostEqual(float(tried["options"].split()[1]) * scale, 1.0, places=9)
            self.assert_as_plain(self.check("a.csv", "--arm", "ur5", *tried["options"].split()))
        write_csv(self.path("a.csv"), dict(self.columns, timestamp=np.arange(len(changed["timestamp"]), dtype=float)))
        found = self.check("a.csv", "--arm", "ur5")
        self.assertEqual(([tried["helps"] for tried in found["tried"]], found["next"]), ([False], []))

    def test_rows_whose_stamps_tell_nothing_are_named(self):
        times = self.columns["timestamp"]
        mixed = np.random.default_rng(3).permutation(times)
        for stamps, part in ((times[::-1], "go back"), (0.0 * times, "same stamp"), (mixed, "go back"),
                             (np.floor(10.0 * times) / 10.0, "are rounded")):
            changed = dict(self.columns, timestamp=stamps)
            write_bag(self.path("a.bag"), [(seconds, state) for seconds, (_, state) in
                                           zip(times, states(changed))])
            write_csv(self.path("a.csv"), changed)
            for name in ("a.csv", "a.bag"):
                found = self.check(name, "--arm", "ur5")
                self.assertIn(part, found["findings"][0]["text"], name)
                self.assertFalse(found["usable"])
        whole = dict(self.columns, actual_q_4=np.full(len(times), np.nan))
        self.fail_with(1, ["'actual_q_4'"], "check", write_csv(self.path("a.csv"), whole), "--arm", "ur5")

    def test_a_cut_line_and_rows_without_numbers_are_left_out(self):
        name = write_csv(self.path("a.csv"), self.columns)
        with open(name, encoding="ascii") as file:
            lines = file.read().splitlines()
        count = len(lines) - 1
        lines[700] = lines[700].replace(lines[700].split(",")[3], "nan", 1)
        lines[900] = ",".join(cell if i != 9 else "" for i, cell in enumerate(lines[900].split(",")))
        with open(self.path("cut.csv"), "w", encoding="ascii") as file:
            file.write("\n".join(lines)[:-40])
        found = self.check("cut.csv")
        self.assert_as_plain(found, rows=count - 3)
        self.assertEqual(found["unreadable"], 2)
        self.assertIn("cut off", found["remarks"][0])

    def test_all_that_a_header_lacks_is_named_at_once(self):
        with open(self.path("a.csv"), "w", encoding="ascii") as file:
            file.write("when,actual_q_0,actual_q_1\n0.0,1.0,1.0\n")
        self.fail_with(1, ["'timestamp'", "'actual_q_5'", "'actual_current_0'", "'actual_current_5'", "when"], "check",
                       "a.csv", "--arm", "ur5")
        with open(self.path("b.csv"), "w", encoding="ascii") as file:
            file.write("0.0,1.0,1.0\n0.1,1.0,1.0\n")
        self.fail_with(1, ["first line contains numbers", "header"], "check", "b.csv")
        with open(self.path("c.csv"), "w", encoding="ascii") as file:
            file.write(",".join(["timestamp"] + [f"actual_{what}_{i}" for what in ("q", "current") for i in range(6)]))
            file.write("\n" + ",".join(["0.5"] * 15) + "\n")
        self.fail_with(1, ["c.csv has no rows; the header has 13 columns, separated by commas, but a row has 15"],
                       "check", "c.csv")
        with open(self.path("c.csv"), "a", encoding="ascii") as file:
            file.write(3 * (",".join(["0.5"] * 6 + ["none"] + ["0.5"] * 6) + "\n"))
        self.fail_with(1, ["none of 4 rows holds a finite number in 'actual_q_5'"], "check", "c.csv")

    def test_arms_are_found_by_the_pattern_of_their_names(self):
        rows = []
        for one, other in zip(states(self.columns, "robot_"), states(self.columns, suffix="_b")):
            one[1].name += other[1].name + ["gripper"]
            for field in ("position", "velocity", "effort"):
                setattr(one[1], field, getattr(one[1], field) + getattr(other[1], field) + [0.0])
            rows.append(one)
        write_bag(self.path("two.bag"), rows)
        found = self.check("two.bag")
        self.assertEqual((found["prefix"], found["suffix"], found["arm"]), ("robot_", "", "ur5"))
        self.assert_as_plain(found)
        self.assertEqual([(arm["prefix"], arm["suffix"]) for arm in found["other_arms"]], [("", "_b")])
        self.assert_as_plain(found["other_arms"][0])
        self.assertIn("--prefix robot_", found["next"][1])
        self.assertIn("--suffix _b", found["other_arms"][0]["next"][1])
        printed = self.succeed("check", "two.bag").stdout
        self.assertEqual(printed.count("\nwrist_3 "), 2)
        for command in found["next"] + found["other_arms"][0]["next"][1:2]:
            done = self.run_tool(*command.split()[1:], "--force")
            self.assertIn(done.returncode, (0, 1), (command, done.stderr))
            self.assertNotIn("never contains", done.stderr)
        self.fail_with(1, ["with --prefix robot_ the", "with --suffix _b the"], "follow", "two.bag", "--arm", "ur5")
        self.succeed("follow", "two.bag", "--arm", "ur5", "--prefix", "robot_", "--bag", "followed.bag")

    def test_names_without_efforts_or_with_nan_are_told_apart(self):
        for value, part in (([], "effort is empty"), ([float("nan")] * 6, "not finite")):
            rows = list(states(swinging(seconds=3.0)))
            for _, state in rows:
                state.effort = value
            write_bag(self.path("a.bag"), rows)
            done = self.fail_with(1, [part], "follow", "a.bag", "--arm", "ur5")
            self.assertNotIn("joints found: none", done.stderr)
        apart = []
        for seconds, state in states(swinging(seconds=3.0)):
            apart.append((seconds, JointState(state.header, state.name, state.position, [], [])))
            apart.append((seconds, JointState(state.header, state.name, [], [], state.effort)))
        write_bag(self.path("a.bag"), apart)
        self.fail_with(1, ["never in the same message"], "follow", "a.bag", "--arm", "ur5")

    def test_a_joint_without_efforts_holds_up_no_other(self):
        none = np.full(len(self.columns["timestamp"]), np.nan)
        columns = dict(self.columns, actual_current_4=none)
        arm = self.succeed_json("compare", write_csv(self.path("a.csv"), columns), "--arm", "ur5")
        self.assertEqual([joint["level"] for joint in arm["joints"]], ["OK"] * 4 + ["NOT JUDGED", "OK"])
        found = self.check(write_bag(self.path("a.bag"), states(columns)), "--arm", "ur5")
        self.assertEqual([joint["name"] for joint in found["joints"] if not joint["judged"]], ["wrist_2"])
        self.assertIn("never a number", " ".join(found["remarks"]))

    def test_fewer_efforts_than_names_are_nobodys(self):
        rows = list(states(self.columns))
        for _, state in rows:
            state.name = ["finger_joint"] + state.name
            state.position = [0.3] + state.position
            state.velocity = [0.0] + state.velocity
        write_bag(self.path("a.bag"), rows)
        self.fail_with(1, ["effort"], "compare", "a.bag", "--arm", "ur5", "--json")
        self.fail_with(1, ["fewer efforts than names"], "compare", "a.bag", "--joint", "elbow", "--json")
        for _, state in rows:  # the gripper last: whose they are is plain
            for field in ("name", "position", "velocity"):
                setattr(state, field, getattr(state, field)[1:] + getattr(state, field)[:1])
        self.succeed("compare", write_bag(self.path("b.bag"), rows), "--joint", "elbow", "--json")

    def test_an_arm_in_parts_is_put_together(self):
        rows = []
        for row, (seconds, state) in enumerate(states(self.columns)):
            chosen = (0, 3, 4) if row % 2 else (1, 2, 5)
            for field in ("name", "position", "velocity", "effort"):
                setattr(state, field, [getattr(state, field)[joint] for joint in chosen])
            rows.append((seconds, state))
        write_bag(self.path("parts.bag"), rows)
        found = self.check("parts.bag")
        self.assertIn("2 messages", " ".join(found["remarks"]))
        self.assertGreater(found["rows"], 0.45 * len(rows))
        self.assertEqual([finding for finding in found["findings"] if finding["stops"]], [])
        self.assertTrue(found["usable"])

    def test_rows_that_no_source_measured_are_left_out(self):
        def spoil(joints, fields):
            rows = list(states(self.columns))
            for row in range(50, len(rows), 61):
                for field in fields:
                    values = list(getattr(rows[row][1], field))
                    setattr(rows[row][1], field, [0.0 if i in joints else value for i, value in enumerate(values)])
            return rows, len(range(50, len(rows), 61))
        whole = ("position", "velocity", "effort")
        for joints, fields in (((2,), whole), (range(6), whole[1:])):
            rows, spoilt = spoil(joints, fields)
            write_bag(self.path("zeros.bag"), rows)
            found = self.check("zeros.bag")
            self.assertEqual(found["unreadable"], spoilt, (joints, fields))
            self.assert_as_plain(found, rows=len(rows) - spoilt)

    def test_two_sources_are_told(self):
        rows = list(states(self.columns))
        for number, shift, part in ((1, 0.3, "two sources"), (4, 0.1, "two sources")):
            mixed = []
            for row, (seconds, state) in enumerate(rows):
                mixed.append((seconds, state))
                if row % number == 0:
                    other = JointState(name=state.name, position=[angle + shift for angle in state.position],
                                       velocity=state.velocity, effort=[current + 1.0 for current in state.effort])
                    other.header.stamp = state.header.stamp + genpy.Duration.from_sec(0.003)
                    mixed.append((seconds + 0.003, other))
            write_bag(self.path("two.bag"), mixed)
            found = self.check("two.bag")
            self.assertFalse(found["usable"])
            self.assertIn(part, found["findings"][0]["text"])
            self.assertEqual(found["next"], [])
            self.assertIn(part, self.succeed_json("compare", "two.bag", "--arm", "ur5")["text"].lower())

    def test_rounds_of_a_loop_and_rows_before_the_time(self):
        rows = list(states(self.columns))[5:]  # in the first all angles are exactly zero
        looped = rows + [(seconds + 45.0, state) for seconds, state in rows]
        write_bag(self.path("loop.bag"), looped)
        found = self.check("loop.bag")
        self.assertIn("2 rounds", found["remarks"][0])
        self.assertAlmostEqual(found["duration"], 2.0 * 39.952 + 1.0, delta=0.01)
        self.assertEqual((found["rows"], found["unreadable"]), (len(looped), 0))
        for _, state in rows[2500:]:  # a clock that was set back within the recording
            state.header.stamp -= genpy.Duration.from_sec(0.5)
        write_bag(self.path("set.bag"), rows)
        found = self.check("set.bag")
        self.assertIn("2 rounds", found["remarks"][0])
        self.assertEqual([joint["judged"] for joint in found["joints"]], [True] * 6)
        early = []
        for seconds, state in states(dict(self.columns)):
            if seconds < 1.0:
                state.header.stamp = genpy.Time(0)
            early.append((seconds, state))
        with rosbag.Bag(self.path("early.bag"), "w") as bag:
            for row, (seconds, state) in enumerate(early):
                late = genpy.Time(tool.START) + genpy.Duration.from_sec(seconds)
                bag.write("/joint_states", state, genpy.Time(0, row + 1) if seconds < 1.0 else late)
        found = self.check("early.bag")
        self.assertIn("125 rows without a time", found["remarks"][0])
        self.assertLess(found["duration"], 40.0)
        self.assertEqual(found["missing"], 0)

    def test_check_promises_what_compare_keeps(self):
        for rate in (10.0, 25.0, 125.0):
            time = np.arange(0.0, 40.0, 1.0 / rate)
            whole = self.columns
            columns = {name: np.interp(time, whole["timestamp"], values) for name, values in whole.items()}
            write_csv(self.path("rate.csv"), columns)
            found = self.check("rate.csv", "--arm", "ur5")
            arm = self.succeed_json("compare", "rate.csv", "--arm", "ur5")
            self.assertEqual({joint["name"] for joint in found["joints"] if joint["judged"]},
                             {joint["joint"] for joint in arm["joints"] if joint["level"] != "NOT JUDGED"}, rate)
            for joint in found["joints"]:
                self.assertEqual(joint["judged"], joint["verdict"]["level"] != "NOT JUDGED")
        write_csv(self.path("slow.csv"), {name: values[::13] for name, values in self.columns.items()})
        found = self.check("slow.csv")
        self.assertEqual(found["findings"][0]["kind"], "period")
        self.assertIn("Hz", found["findings"][0]["text"])

    def test_a_motor_of_another_ratio_is_named(self):
        for ratio, judged in ((-101.0, False), (51.0, False), (101.0, True)):
            rows = []
            for seconds, state in states(self.columns):
                state.name = ["leg", "leg_motor"]
                state.position = [state.position[2], ratio * state.position[2]]
                state.velocity = [state.velocity[2], ratio * state.velocity[2]]
                state.effort = [state.effort[2], 0.1]
                rows.append((seconds, state))
            write_bag(self.path("leg.bag"), rows)
            found = self.check("leg.bag")
            self.assertEqual([joint["name"] for joint in found["joints"]], ["leg"])
            ratios = [finding["text"] for finding in found["joints"][0]["findings"] if finding["kind"] == "ratio"]
            self.assertEqual(len(ratios), 0 if judged else 1, ratio)
            if not judged:
                self.assertIn(f"turns {ratio:g} times", ratios[0])
                printed = self.succeed("compare", "leg.bag", "--joint", "leg").stdout
                self.assertIn("NOT JUDGED", printed)
                self.assertIn(f"turns {ratio:g} times", printed)

    def test_an_md5sum_of_nothing_is_read(self):
        data = []
        for seconds, state in states(self.columns):
            buffer = io.BytesIO()
            state.serialize(buffer)
            data.append((seconds, buffer.getvalue()))
        with rosbag.Bag(self.path("md5.bag"), "w") as bag:
            for seconds, bytes_of in data:
                bag.write("/joint_states", (JointState._type, bytes_of, "d41d8cd98f00b204e9800998ecf8427e", JointState),
                          genpy.Time(tool.START) + genpy.Duration.from_sec(seconds), raw=True)
        self.assert_as_plain(self.check("md5.bag"))


class Rows(RecordingTest):
    def remark(self, found, part):
        self.assertTrue([remark for remark in found["remarks"] if part in remark], found["remarks"])

    def test_tables_of_other_programs_are_read_or_named(self):
        names = {f"actual_{part}_{joint}": f"/joint_states/{name}/{quantity}"
                 for part, quantity in (("q", "position"), ("qd", "velocity"), ("current", "effort"))
                 for joint, name in enumerate(tool.JOINT_NAMES)}
        names["timestamp"] = "__time"
        juggler = {names[name]: values for name, values in self.columns.items()}
        self.assert_as_plain(self.check(write_csv(self.path("juggler.csv"), juggler)))
        for time in ("time", "t"):
            columns = {time if name == "timestamp" else name: values for name, values in self.columns.items()}
            self.assert_as_plain(self.check(write_csv(self.path("time.csv"), columns)))
        self.write("echo.csv", "%time,field.header.seq,field.name0,field.position0\n1,2,elbow_joint,0.1\n")
        self.write("bagpy.csv", "Time,header.seq,header.stamp.secs,name_0,position_0\n1,2,3,elbow_joint,0.1\n")
        self.write("lists.csv", 'time,position,effort\n1,"[0.1, 0.2]","[1, 2]"\n')
        for name, way in (("echo", "rostopic echo -p"), ("bagpy", "bagpy"), ("lists", "lists in its cells")):
            self.fail_with(1, [way, "the bag"], "check", name + ".csv", "--arm", "ur5")
            self.fail_with(1, [way, "the bag"], "compare", name + ".csv", "--arm", "ur5")

    def test_names_that_tell_no_joint_and_angles_that_are_not_there_are_named(self):
        messages = list(states(self.columns))[:1000]
        for _, state in messages:
            state.name = 6 * [""]
        self.fail_with(1, ["the joints have no names"], "check", write_bag(self.path("blank.bag"), messages))
        for _, state in messages:
            state.name = [name + "/position" for name in tool.JOINT_NAMES]
        self.fail_with(1, ["joints end with a quantity"], "check", write_bag(self.path("split.bag"), messages))
        for _, state in messages:
            state.name, state.position = tool.JOINT_NAMES, []
        done = self.run_tool("check", write_bag(self.path("empty.bag"), messages))
        self.assertEqual(done.returncode, 1)
        self.assertIn("their position is empty", done.stdout)

    def test_a_payload_that_the_controller_states_counts(self):
        columns = {**self.columns, "payload": np.full(len(self.columns["timestamp"]), 1.5),
                   **{f"payload_cog_{i}": np.zeros(len(self.columns["timestamp"])) for i in range(3)}}
        self.remark(self.check(write_csv(self.path("payload.csv"), columns), "--arm", "ur5"),
                    "payload of 1.5 kg, as the controller states")

    def test_a_database_is_read_without_writing_beside_it(self):
        folder = self.path("disk")
        os.mkdir(folder)
        path = write_db3(os.path.join(folder, "a.db3"), states(self.columns))
        database = sqlite3.connect(path)
        database.execute("PRAGMA journal_mode=WAL")
        database.close()
        os.chmod(folder, 0o555)
        self.addCleanup(os.chmod, folder, 0o755)
        self.assert_as_plain(self.check(path))
        self.assertEqual(os.listdir(folder), ["a.db3"])
        os.chmod(folder, 0o755)
        database = sqlite3.connect(path)  # as a recorder that was killed: rows in the -wal alone
        database.execute("INSERT INTO messages(topic_id, timestamp, data) SELECT topic_id, timestamp + 1, x'00' FROM "
                         "messages LIMIT 1")
        database.commit()
        os.mkdir(self.path("killed"))
        for name in os.listdir(folder):
            shutil.copy(os.path.join(folder, name), self.path("killed"))
        database.close()
        before = sorted(os.listdir(self.path("killed")))
        self.assertIn("a.db3-wal", before)
        self.assertEqual(self.check(self.path("killed/a.db3"))["unreadable"], 1)
        self.assertEqual(sorted(os.listdir(self.path("killed"))), before)

    def test_a_database_whose_tables_are_views_is_refused(self):
        endless = "AS WITH RECURSIVE n(x) AS (SELECT 1 UNION ALL SELECT x + 1 FROM n) SELECT "
        for name, columns in (("topics", "x AS id, 'a' AS name, 'b' AS type, 'cdr' AS serialization_format FROM n"),
                              ("messages", "x AS id, 7 AS topic_id, x AS timestamp, zeroblob(99999) AS data FROM n")):
            path = write_db3(self.path(name + ".db3"), list(states(self.columns))[:10])
            database = sqlite3.connect(path)
            database.execute(f"DROP TABLE {name}")
            database.execute(f"CREATE VIEW {name} {endless}{columns}")
            database.commit()
            database.close()
            self.fail_with(1, [f"without the table '{name}'"], "check", path)

    def test_chunks_of_an_mcap_take_no_memory_without_end(self):
        deep = b""
        for _ in range(5000):
            deep = record(6, struct.pack("<QQQI", 0, 0, len(deep), 0) + text("") + struct.pack("<Q", len(deep)) + deep)
        files = [deep]
        if shutil.which("zstd"):
            zeros = subprocess.run(["zstd", "-q", "-c"], input=bytes(1 << 28), stdout=subprocess.PIPE,
                                   check=True).stdout
            files.append(record(6, struct.pack("<QQQI", 0, 0, 1 << 28, 0) + text("zstd") +
                                struct.pack("<Q", len(zeros)) + zeros))
        for data in files:
            with open(self.path("bomb.mcap"), "wb") as file:
                file.write(b"\x89MCAP0\r\n" + data + b"\x89MCAP0\r\n")
            code, _, peak = self.measure("check", "bomb.mcap")
            self.assertEqual(code, 1)
            self.assertLess(peak, 200e6)


if __name__ == "__main__":
    tool.main()
