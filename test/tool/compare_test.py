# SPDX-License-Identifier: BSD-3-Clause
"""`joint_twin compare`: recordings of strangers, and damaged ones."""
import json
import math
import os
import random
import re
import struct

import rosbag

import robot
import tool

OPTIONS = ["--joint", "elbow", "--config", "joints/elbow.yaml"]
GAIN = ["--set", f"telemetry.torque_per_current={robot.GAIN}"]
REPORT = ["--report", "report", "--force"]
FIGURES = ["course", "friction", "spectrum", "teeth"]


class Compare(tool.ToolTest):
    def compare(self, recording, *arguments):
        return self.succeed_json("compare", recording, *OPTIONS, *GAIN, *arguments)

    def finding(self, report, title):
        return next(finding for finding in report["verdict"]["findings"] if title in finding["title"])

    def damage(self, name, share, topic, places):
        """Turns over a byte inside of messages, where the file has them, at these places in turn; how many were hit."""
        data = bytearray(tool.read_bytes(self.path(name)))
        at, hit = 0, 0
        for number, (_, _, _, _, message) in enumerate(tool.raw_messages(self.path(name), [topic])):
            at = data.index(message, at)
            if number % round(1.0 / share) == 17:
                data[at + places[hit % len(places)] % len(message)] ^= 0xFF
                hit += 1
        with open(self.path(name), "wb") as file:
            file.write(data)
        return hit

    def test_a_matplotlibrc_in_the_folder_of_the_call_has_no_influence(self):
        robot.write_bag(self.path("a.bag"), 30.0)
        self.compare("a.bag", *REPORT)
        pictures = [f"report/{name}.png" for name in FIGURES]
        expected = [tool.read_bytes(self.path(name)) for name in pictures]
        for settings in (b"text.usetex: True\nbackend: module://other\nfont.size: 40\n", b"\xff\xfe"):
            with open(self.path("matplotlibrc"), "wb") as file:
                file.write(settings)
            self.compare("a.bag", *REPORT)
            self.assertEqual([tool.read_bytes(self.path(name)) for name in pictures], expected, settings)

    def test_a_bag_of_a_stranger_gets_a_page_that_needs_nothing_else(self):
        robot.write_bag(self.path("a.bag"), 30.0)
        report = self.compare("a.bag", *REPORT)
        files = os.listdir(self.path("report"))
        for name in FIGURES:
            self.assertIn(f"{name}.png", files)
            self.assertIn(f"{name}.csv", files)
        with open(self.path("report/report.html"), encoding="utf-8") as file:
            page = file.read()
        self.assertNotRegex(page, r"(?:src|href|srcset)=\"(?!data:)|url\(|@import")
        self.assertEqual(page.count("data:image/png;base64,"), 2 * len(FIGURES))
        for finding in report["verdict"]["findings"]:
            self.assertIn(re.sub("'.*", "", finding["text"]), page)
        with open(self.path("report/comparison.json"), encoding="utf-8") as file:
            self.assertEqual(json.load(file), report)
        found = {line["name"]: line["found"] for line in report["contents"]["topics"]}
        self.assertEqual(found, {"/joint_states": True, "/joint_states: elbow_joint_motor": False,
                                 "/joint_twin/load": True, "sensor_msgs/Temperature of elbow_joint": False,
                                 "/joint_twin/joint_states": False})
        self.assertEqual(report["contents"]["joints"], ["wrist_1_joint", "elbow_joint"])
        self.assertIn("motor's is needed", " ".join(report["verdict"]["cannot_show"]))

    def test_nothing_is_overwritten_unasked_and_bad_input_is_named(self):
        robot.write_bag(self.path("a.bag"), 3.0)
        self.succeed("compare", "a.bag", *OPTIONS, "--report", "report", environment=tool.NO_PAGE)
        self.fail_with(1, ["comparison.json exists; --force"], "compare", "a.bag", *OPTIONS, "--report", "report")
        for name in ("course.csv", "teeth.png", "windows.csv"):
            with self.subTest(name):
                folder = "of_" + name
                os.mkdir(self.path(folder))
                self.write(os.path.join(folder, name), "precious")
                self.fail_with(1, [f"already contains files, {name} among them", "--force"], "compare", "a.bag",
                               *OPTIONS, "--report", folder)
                self.assertEqual(tool.read_bytes(self.path(os.path.join(folder, name))), b"precious")
                self.assertEqual(os.listdir(self.path(folder)), [name])
        self.fail_with(1, ["joints found: elbow_joint, wrist_1_joint"], "compare", "a.bag", "--joint", "shoulder",
                       "--report", "r1")
        self.fail_with(1, ["no messages on /arm", "/joint_states (sensor_msgs/JointState)"], "compare", "a.bag",
                       *OPTIONS,
                       "--topic", "/arm", "--report", "r2")
        self.fail_with(1, ["nowhere.bag"], "compare", "nowhere.bag", *OPTIONS, "--report", "r3")
        before = sorted(os.listdir(self.directory))
        self.assertNotIn("written", self.succeed("compare", "a.bag", *OPTIONS).stdout)
        self.assertEqual(sorted(os.listdir(self.directory)), before)

    def test_data_are_written_where_no_page_can_be_made(self):
        robot.write_bag(self.path("a.bag"), 3.0)
        self.write("jinja2.py", "raise ImportError(name='jinja2')\n")
        done = self.run_tool("compare", "a.bag", *OPTIONS, "--report", "report",
                             environment={"PYTHONPATH": self.directory})
        self.assertEqual(done.returncode, 1)
        self.assertIn("apt-get install python3-jinja2", done.stderr)
        self.assertIn("the data are in report", done.stderr)
        self.assertIn("comparison.json", os.listdir(self.path("report")))

    def test_a_table_of_a_controller_will_do(self):
        lines = ["timestamp,actual_q_2,actual_current_2"]
        for number, (_, state, _) in enumerate(robot.rows(20.0)):
            lines.append(f"{number / robot.RATE:.3f},{state.position[1]:.9f},{state.effort[1]:.6f}")
        self.write("a.csv", "\n".join(lines) + "\n")
        report = self.compare("a.csv")
        self.assertEqual([line["found"] for line in report["contents"]["topics"]], [True, False, False])
        self.assertIn("no load was recorded", " ".join(report["verdict"]["cannot_show"]))

    def test_the_twin_that_ran_beside_is_found(self):
        self.write("a.csv", "\n".join(tool.telemetry_csv(rows=200)) + "\n")
        self.succeed("import", "a.csv", "--joint", 2, "--out", "in.bag")
        self.succeed("replay", "in.bag", "--out", "out.bag", "--config", "joints/elbow.yaml",
                     "--config", "recorded_load.yaml", "--set", "publish.contact_forces_rate=1")
        report = self.compare("out.bag", *REPORT)
        self.assertTrue(report["contents"]["topics"][-1]["found"])
        self.assertIn("/joint_twin/command", report["contents"]["not_used"])
        with open(self.path("report/twin_states.csv")) as file:
            self.assertGreater(len(file.readlines()), 1000)

    def test_more_friction_than_the_twin_is_a_warning_with_its_causes(self):
        levels = []
        for friction in (1.0, 1.7):
            robot.write_bag(self.path("a.bag"), 30.0, friction)
            report = self.compare("a.bag")
            levels.append(self.finding(report, "Friction")["level"])
            factor = report["friction_factor"]
            self.assertLess(factor["low"], factor["value"])
            self.assertGreater(factor["high"], factor["value"])
            self.assertEqual(factor["reference"], "twin")
        self.assertEqual(levels, ["OK", "WARN"])
        self.assertEqual(report["verdict"]["level"], "WARN")
        self.assertIn("lubricant_degradation", self.finding(report, "Friction")["text"])

    def test_the_exit_code_is_the_verdict_where_it_is_asked_for(self):
        robot.write_bag(self.path("sound.bag"), 30.0)
        robot.write_bag(self.path("worn.bag"), 30.0, 1.7)
        robot.write_bag(self.path("short.bag"), 2.0)
        self.compare("sound.bag")
        for name, least, code in (("sound.bag", "warn", 0), ("worn.bag", "warn", 3), ("worn.bag", "error", 0),
                                  ("worn.bag", None, 0), ("short.bag", "warn", 4), ("sound.bag", "not-judged", 0),
                                  ("worn.bag", "not-judged", 3), ("short.bag", "not-judged", 4),
                                  ("short.bag", None, 0)):
            asked = ["--fail-on", least] if least else []
            done = self.run_tool("compare", name, *OPTIONS, *GAIN, "--json", *asked)
            self.assertEqual(done.returncode, code, (name, least, done.stdout, done.stderr))
        self.fail_with(2, ["--fail-on", "{warn,error,not-judged}"], "compare", "sound.bag", *OPTIONS, "--json",
                       "--fail-on", "ok")

    def test_json_needs_no_report_and_leaves_no_file(self):
        robot.write_bag(self.path("a.bag"), 30.0)
        with_page = self.compare("a.bag", *REPORT)
        before = set(os.listdir(self.directory))
        alone = self.compare("a.bag")
        self.assertEqual(alone, with_page)
        self.assertEqual(set(os.listdir(self.directory)), before)

    def test_several_sound_recordings_are_one_reference(self):
        def factor_of(name, *references):
            found = self.succeed_json("compare", name, *OPTIONS, *GAIN, "--reference", *references)
            return found["friction_factor"], found["verdict"]["level"]

        for name, friction in (("low", 0.75), ("usual", 1.0), ("high", 1.25), ("again", 1.01), ("worn", 1.4)):
            robot.write_bag(self.path(f"{name}.bag"), 60.0, friction)
            self.succeed("compare", f"{name}.bag", *OPTIONS, *GAIN, "--report", name, environment=tool.NO_PAGE)
        one, level = factor_of("worn.bag", "usual")
        self.assertAlmostEqual(one["value"], 1.4, delta=0.02)
        self.assertEqual(one["reference"], "own")
        self.assertEqual(level, "WARN")
        alike, level = factor_of("worn.bag", "usual", "again")
        self.assertEqual(level, "WARN")
        self.assertLess(alike["high"] / alike["low"], one["high"] / one["low"])
        # A joint that repeats so badly when it is sound shows no fault with this factor.
        apart, level = factor_of("worn.bag", "low", "usual", "high")
        self.assertAlmostEqual(apart["value"], 1.4, delta=0.03)
        self.assertGreater(apart["high"] / apart["low"], one["high"] / one["low"])
        self.assertEqual(level, "OK")

    def test_a_reference_that_was_not_judged_is_none(self):
        robot.write_bag(self.path("short.bag"), 2.0)
        robot.write_bag(self.path("a.bag"), 60.0, 1.3)
        self.succeed("compare", "short.bag", *OPTIONS, *GAIN, "--report", "short", environment=tool.NO_PAGE)
        found = self.compare("a.bag", "--reference", "short")
        self.assertEqual(found["friction_factor"]["reference"], "twin")
        self.assertIn("The reference did not judge this joint's friction", self.finding(found, "Friction")["text"])

    def test_dropped_and_damaged_messages_change_little(self):
        robot.write_bag(self.path("sound.bag"), 120.0)
        robot.write_bag(self.path("bad.bag"), 120.0, dropped=0.01)
        # A stamp, a name's length, an array's length to its highest byte, an angle, a current; a load.
        hit = self.damage("bad.bag", 0.001, robot.STATES_TOPIC, [4, 20, -44, -41, -25, -1])
        self.damage("bad.bag", 0.001, robot.LOAD_TOPIC, [-1])
        self.assertGreater(hit, 10)
        sound, bad = self.compare("sound.bag"), self.compare("bad.bag")
        self.assertEqual(sound["reading"]["unreadable_or_impossible"], 0)
        self.assertGreater(bad["reading"]["unreadable_or_impossible"], hit // 2)
        self.assertLess(bad["reading"]["unreadable_or_impossible"], 2 * hit)
        self.assertGreater(bad["reading"]["rows"], 0.985 * sound["reading"]["rows"] - hit)
        for name in ("friction_ratio", "current"):
            one, other = sound[name], bad[name]
            if isinstance(one, dict):
                one, other = one["residual_rms"], other["residual_rms"]
            self.assertAlmostEqual(one, other, delta=0.02 * abs(one))

    def test_what_is_not_the_joints_current_is_not_judged(self):
        robot.write_bag(self.path("sound.bag"), 60.0)
        for name, factor, note in (("zero.bag", 0.0, "it is not the motor's current"),
                                   ("torque.bag", robot.GAIN, "expected in A, not in N.m")):
            self.rewrite("sound.bag", name, lambda state, factor=factor: [factor * value for value in state.effort])
            verdict = self.compare(name)["verdict"]
            self.assertEqual(verdict["level"], "NOT JUDGED", verdict)
            self.assertIn(note, verdict["findings"][0]["text"])
            self.assertEqual(verdict["findings"][0]["causes"], [])

    def test_a_load_that_does_not_fit_is_not_judged(self):
        robot.write_bag(self.path("sound.bag"), 60.0, with_load=False)
        # A weight that hangs on another axis: neither friction nor a constant.
        self.rewrite("sound.bag", "other.bag",
                     lambda state: [value + 5.0 * math.sin(2.0 * state.position[1]) for value in state.effort])
        verdict = self.compare("other.bag")["verdict"]
        self.assertEqual(verdict["level"], "NOT JUDGED", verdict)
        self.assertEqual({finding["level"] for finding in verdict["findings"]}, {"NOT JUDGED"})
        self.assertIn("neither predicted nor explained by another friction", verdict["findings"][0]["text"])
        # Twice the friction fits: it is what is judged.
        robot.write_bag(self.path("worn.bag"), 60.0, friction=2.0)
        self.assertEqual(self.compare("worn.bag")["verdict"]["level"], "ERROR")

    def rewrite(self, source, target, efforts):
        with rosbag.Bag(self.path(source)) as given, rosbag.Bag(self.path(target), "w") as changed:
            for topic, message, time in given.read_messages():
                if topic == robot.STATES_TOPIC:
                    message.effort = efforts(message)
                changed.write(topic, message, time)

    def test_stamps_that_disagree_with_the_velocities_are_said(self):
        rows = ["timestamp,actual_q_2,actual_qd_2,actual_current_2,target_moment_2"]
        generator = random.Random(3)
        for row in range(3000):
            seconds = row / robot.RATE
            angle, current, load = robot.telemetry(seconds, generator)
            speed = 0.63 * math.cos(0.9 * seconds) + 0.46 * math.cos(2.3 * seconds)
            rows.append(f"{0.5 * seconds:.4f},{angle:.9f},{speed:.9f},{current:.6f},{load:.6f}")
        self.write("fast.csv", "\n".join(rows) + "\n")
        done = self.succeed("compare", "fast.csv", *OPTIONS, "--report", "r")
        self.assertRegex(done.stderr, r"change (2|1\.99\d+|2\.0\d+) times as fast as the recorded velocities")
        self.assertNotIn("Warning", done.stderr)  # of Python
        self.assertLessEqual(max(map(len, done.stdout.splitlines())), 100, done.stdout)

    def test_a_bag_that_was_cut_off_is_told_from_one_that_is_none(self):
        robot.write_bag(self.path("a.bag"), 60.0)
        data = tool.read_bytes(self.path("a.bag"))
        for name, content, note in (("cut.bag", data[:len(data) * 2 // 3], "cut.bag"),
                                    ("open.bag", self.without_index(data), "`rosbag reindex` may repair it"),
                                    ("none.bag", b"not a bag", "cannot be read as a bag")):
            with open(self.path(name), "wb") as file:
                file.write(content)
            self.fail_with(1, [note], "compare", name, *OPTIONS, "--report", "r_" + name)

    @staticmethod
    def without_index(data):
        """As a recorder that was killed leaves it: the place of the index in the bag's header still 0."""
        at = data.index(b"index_pos=") + len(b"index_pos=")
        return data[:at] + struct.pack("<Q", 0) + data[at + 8:len(data) * 2 // 3]


if __name__ == "__main__":
    tool.main()
