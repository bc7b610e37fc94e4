# SPDX-License-Identifier: BSD-3-Clause
"""Rows that were not measured or cannot be true, tables of other programs, and files made to exhaust a reader."""
import os
import shutil
import sqlite3
import struct
import subprocess

import numpy as np

import tool
from check_test import write_csv
from recorded import record, states, text, write_bag, write_db3
from recordings_test import RecordingTest

MEMORY = 200e6  # of a reader that is given little [byte]


class Rows(RecordingTest):
    def remark(self, found, part):
        self.assertTrue([remark for remark in found["remarks"] if part in remark], found["remarks"])

    def test_an_angle_that_the_rows_beside_it_contradict_is_left_out(self):
        for joint, off in ((2, 0.5), (5, -0.2), (0, 1e300)):
            columns = {name: values.copy() for name, values in self.columns.items()}
            columns[f"actual_q_{joint}"][2000] += off
            rows = len(columns["timestamp"]) - 1
            for recording in (write_csv(self.path("one.csv"), columns),
                              write_bag(self.path("one.bag"), states(columns))):
                found = self.check(recording)
                self.assert_as_plain(found, rows)
                self.assertEqual(found["unreadable"], 1)
            if off < 1e3:
                self.remark(found, "1 row is left out: angles that the joints cannot have reached")

    def test_values_that_repeat_while_the_arm_moves_are_left_out(self):
        rows = len(self.columns["timestamp"])
        held = np.repeat(np.arange(rows), 4)
        columns = {name: values[held] for name, values in self.columns.items()}
        columns["timestamp"] = 0.002 * np.arange(len(held))
        found = self.check(write_csv(self.path("held.csv"), columns))
        self.assertEqual([joint["judged"] for joint in found["joints"]], 6 * [True])
        self.remark(found, f"{3 * rows} rows are left out: they repeat the values")
        stuck = np.arange(rows)
        for begin in range(500, rows - 30, 400):
            stuck[begin:begin + 21] = begin
        columns = {name: values[stuck] for name, values in self.columns.items()}
        columns["timestamp"] = self.columns["timestamp"]
        found = self.check(write_csv(self.path("stuck.csv"), columns))
        self.assertEqual([joint["judged"] for joint in found["joints"]], 6 * [True])
        self.remark(found, "they repeat the values")

    def test_stamps_in_bunches_are_left_out(self):
        rows = len(self.columns["timestamp"]) // 4 * 4
        columns = {name: values[:rows] for name, values in self.columns.items()}
        columns["timestamp"] = (np.repeat(self.columns["timestamp"][3:rows:4], 4) +
                                np.tile([0.0, 0.0002, 0.0004, 0.0006], rows // 4))
        found = self.check(write_csv(self.path("bunched.csv"), columns))
        self.remark(found, "stamps come in bunches")
        self.assertNotIn("another arm", str(found))
        self.assertLess(found["missing"], 10)

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
        self.fail_with(1, ["the names carry the quantity"], "check", write_bag(self.path("split.bag"), messages))
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
            self.assertLess(peak, MEMORY)


if __name__ == "__main__":
    tool.main()
