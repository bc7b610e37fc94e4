# SPDX-License-Identifier: BSD-3-Clause
"""`joint_twin trend`: the friction of joints over the recordings of months."""
import csv
import datetime
import os
import re

import arm_test
import robot
import tool
from recorded import NAMES

JOINT = ["--joint", "elbow", "--config", "joints/elbow.yaml", "--set", f"telemetry.torque_per_current={robot.GAIN}"]
JANUARY = datetime.datetime(2026, 1, 1, 8, tzinfo=datetime.timezone.utc).timestamp()
MONTH = 30 * 86400.0


def write_csv(path, friction, start, duration=30.0):
    """A controller's table of the elbow, its first stamp `start` [s]."""
    with open(path, "w", encoding="ascii") as file:
        file.write("timestamp,actual_q_2,actual_current_2,target_moment_2\n")
        for row, (_, state, load) in enumerate(robot.rows(duration, friction)):
            file.write(f"{start + row / robot.RATE:.3f},{state.position[1]:.9f},{state.effort[1]:.6f},"
                       f"{load.effort[0]:.6f}\n")


class Trend(tool.ToolTest):
    def months(self, frictions, folder="months", start=JANUARY, step=MONTH):
        """Recordings a month apart; the names are against the order of their dates."""
        os.makedirs(self.path(folder), exist_ok=True)
        for month, friction in enumerate(frictions):
            write_csv(self.path(f"{folder}/{chr(ord('z') - month)}.csv"), friction, start + month * step)
        return folder

    def trend(self, *arguments):
        return self.succeed_json("trend", *arguments, *JOINT)

    def elbow(self, document):
        self.assertEqual([joint["joint"] for joint in document["joints"]], ["elbow"])
        return document["joints"][0]

    def test_rising_friction_is_named_with_its_slope(self):
        found = self.trend(self.months([1.0, 1.12, 1.24, 1.36, 1.48, 1.6]))
        elbow = self.elbow(found)
        self.assertEqual((found["level"], elbow["level"], elbow["recordings"]), ("WARN", "WARN", 6), found)
        self.assertIn("elbow: Friction rises: ", found["text"])
        self.assertIn("from 2026-01-01 08:00 to 2026-05-31 08:00", found["text"])
        self.assertAlmostEqual(elbow["change"], 1.6, delta=0.05)
        self.assertLess(elbow["change_low"], 1.6)
        self.assertGreater(elbow["change_low"], 1.05)
        self.assertEqual(found["slope_unit"], "per 1000 h")
        hours = 5 * MONTH / 3600.0
        self.assertAlmostEqual(elbow["slope"], 0.47 / hours * 1000.0, delta=0.01)
        self.assertLess(elbow["slope_low"], elbow["slope"])
        self.assertLess(elbow["slope"], elbow["slope_high"])
        rows = found["recordings"]
        self.assertEqual([row["date"][:10] for row in rows],
                         ["2026-01-01", "2026-01-31", "2026-03-02", "2026-04-01", "2026-05-01", "2026-05-31"])
        self.assertEqual([os.path.basename(row["recording"]) for row in rows],
                         ["z.csv", "y.csv", "x.csv", "w.csv", "v.csv", "u.csv"])

    def test_each_recording_is_judged_as_compare_judges_it(self):
        folder = self.months([1.0, 1.7])
        self.succeed("compare", f"{folder}/z.csv", *JOINT, "--report", "sound", environment=tool.NO_PAGE)
        for row in self.trend(folder, "--reference", "sound")["recordings"]:
            alone = self.succeed_json("compare", row["recording"], *JOINT, "--reference", "sound")
            self.assertEqual((row["level"], row["text"]), (alone["verdict"]["level"], alone["verdict"]["text"]))
            joint = row["joints"][0]
            self.assertEqual([joint["friction"], joint["friction_low"], joint["friction_high"]],
                             [alone["verdict"][f"friction_{name}"] for name in ("factor", "lower", "upper")])
            self.assertEqual((joint["temperature"], joint["temperature_source"]), (25.0, "configured"))

    def test_friction_that_stays_is_ok_and_the_exit_code_is_the_verdict(self):
        sound = self.months([1.0, 1.03, 0.98, 1.01, 0.99], "sound")
        found = self.trend(sound)
        self.assertEqual((found["level"], self.elbow(found)["level"]), ("OK", "OK"), found)
        worn = self.months([1.0, 1.2, 1.4, 1.6], "worn")
        repaired = self.months([1.7, 1.0, 1.0, 1.0, 1.0, 1.0], "repaired")  # too much at first, sound since
        broken = self.months([1.0, 1.0, 1.0, 1.0, 1.7], "broken")  # suddenly
        short = self.months([1.0], "short")
        write_csv(self.path("short/z.csv"), 1.0, JANUARY, 2.0)
        for folder, least, code in ((sound, "warn", 0), (worn, "warn", 3), (worn, "error", 0), (worn, None, 0),
                                    (repaired, "warn", 0), (broken, "warn", 3), (short, "warn", 4), (short, None, 0)):
            asked = ["--fail-on", least] if least else []
            done = self.run_tool("trend", folder, *JOINT, *asked)
            self.assertEqual(done.returncode, code, (folder, least, done.stdout, done.stderr))
        found = self.trend(broken)
        self.assertEqual(self.elbow(found)["level"], "OK")
        self.assertIn("The latest, v.csv: ", found["text"])

    def test_no_recording_is_lost_and_each_says_why_it_is_not_judged(self):
        folder = self.months([1.0, 1.0, 1.0, 1.0])
        write_csv(self.path(f"{folder}/short.csv"), 1.0, JANUARY - MONTH, 2.0)
        self.write(f"{folder}/torn.bag", "no bag")
        self.write(f"{folder}/other.csv", "time,angle\n1,2\n")
        self.write(f"{folder}/notes.txt", "no recording")
        os.mkdir(self.path(f"{folder}/older"))
        found = self.trend(folder)
        rows = {os.path.basename(row["recording"]): row for row in found["recordings"]}
        self.assertEqual(sorted(rows), ["other.csv", "short.csv", "torn.bag", "w.csv", "x.csv", "y.csv", "z.csv"])
        for name, why in (("torn.bag", "cannot be read as a bag"), ("other.csv", "'actual_q_2'"),
                          ("short.csv", "Fewer than three speeds")):
            self.assertEqual(rows[name]["level"], "NOT JUDGED")
            self.assertIn(why, rows[name]["text"])
        self.assertEqual((rows["torn.bag"]["date"], rows["torn.bag"]["joints"]), (None, []))
        self.assertEqual(rows["short.csv"]["joints"][0]["reason"], "ONE_SPEED")
        self.assertIsNone(rows["short.csv"]["joints"][0]["friction"])
        self.assertEqual(self.elbow(found)["recordings"], 4)
        text = self.succeed("trend", folder, *JOINT).stdout
        for parts in (("2026-01-01 08:00", "[", "z.csv"), ("2025-12-02 08:00", "ONE_SPEED", "short.csv"),
                      ("-", "NOT JUDGED", "torn.bag")):
            self.assertTrue(any(all(part in line for part in parts) for line in text.splitlines()), (parts, text))
        self.assertRegex(text.replace("\n  ", " "), r"months/torn\.bag: NOT JUDGED\. .* cannot be read as a bag")

    def test_a_file_has_a_row_for_each_recording_and_a_page_its_figures(self):
        folder = self.months([1.0, 1.2, 1.4, 1.6])
        write_csv(self.path(f"{folder}/short.csv"), 1.0, JANUARY - MONTH, 2.0)
        found = self.trend(folder, "--out", "trend.csv", "--report", "page")
        with open(self.path("trend.csv"), encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([(row["recording"], row["date"], row["level"], row["text"]) for row in rows],
                         [(row["recording"], row["date"], row["level"], row["text"]) for row in found["recordings"]])
        self.assertEqual(rows[0]["elbow_friction"], "")
        self.assertEqual([float(row["elbow_friction_high"]) for row in rows[1:]],
                         [row["joints"][0]["friction_high"] for row in found["recordings"][1:]])
        with open(self.path("page/report.html"), encoding="utf-8") as file:
            page = file.read()
        self.assertNotRegex(page, r"(?:src|href|srcset)=\"(?!data:)|url\(|@import")
        self.assertEqual(page.count("data:image/png;base64,"), 2)
        self.assertIn(self.elbow(found)["text"].split(":")[0], page)
        self.fail_with(1, ["trend.csv exists; --force"], "trend", folder, *JOINT, "--out", "trend.csv")
        self.fail_with(1, ["trend.json exists; --force"], "trend", folder, *JOINT, "--report", "page")

    def test_without_dates_the_order_stands_for_time(self):
        folder = self.months([1.6, 1.4, 1.2, 1.0], start=100.0)  # named against the order: it rises
        found = self.trend(folder)
        self.assertFalse(found["has_dates"])
        self.assertEqual({row["date"] for row in found["recordings"]}, {None})
        self.assertIn("their order stands for time", found["text"])
        elbow = self.elbow(found)
        self.assertEqual((elbow["level"], found["slope_unit"]), ("WARN", "from one recording to the next"))
        self.assertAlmostEqual(elbow["slope"], 0.47 / 3, delta=0.02)
        self.assertIn("from the first to the last recording", elbow["text"])
        self.assertIn("Friction falls", self.elbow(self.trend(*[f"{folder}/{name}.csv" for name in "zyxw"]))["text"])

    def test_too_few_recordings_and_those_of_a_day_have_no_trend(self):
        few = self.trend(self.months([1.0, 1.3, 1.6], "few"))
        self.assertEqual(self.elbow(few)["level"], "NOT JUDGED")
        self.assertIn("No trend of elbow: 3 recordings show its friction, 4 are needed.", few["text"])
        self.assertEqual(few["level"], "WARN", "that of the latest recording")
        day = self.elbow(self.trend(self.months([1.6, 1.4, 1.2, 1.0], "day", step=3600.0)))
        self.assertEqual((day["level"], day["change"]), ("NOT JUDGED", None))
        self.assertIn("are within 3.0 h. Within a day", day["text"])

    def test_what_cannot_be_read_at_all_is_an_error(self):
        os.mkdir(self.path("empty"))
        self.write("a.csv", "time,angle\n1,2\n")
        self.write("b.csv", "time,angle\n1,2\n")
        for parts, arguments in ((["empty holds no recordings", "folders in it are not searched"], ["empty"]),
                                 (["nowhere does not exist"], ["nowhere"]),
                                 (["none of 2 recordings can be read: a.csv"], ["a.csv", "b.csv", "./a.csv"]),
                                 (["arm crane"], ["a.csv"])):
            joint = ["--arm", "crane"] if "arm crane" in parts else JOINT
            self.fail_with(1, parts, "trend", *arguments, *joint)
        self.fail_with(2, ["recordings is required"], "trend", *JOINT)


class TrendOfArm(arm_test.ArmTest):
    def test_only_the_joint_whose_friction_rises_is_named(self):
        """Over a year whose temperatures nobody recorded, but in the last one."""
        os.mkdir(self.path("months"))
        for month, degrees in enumerate((18.0, 22.0, 30.0, 26.0, 20.0)):
            self.robot(["elbow"], 0.1 * month, f"months/{month}.csv", degrees, month == 4,
                       start=JANUARY + 2 * month * MONTH)
        found = self.succeed_json("trend", "months", "--arm", "ur5", "--out", "trend.csv")
        self.assertEqual({joint["joint"]: joint["level"] for joint in found["joints"]},
                         {name: "WARN" if name == "elbow" else "OK" for name in NAMES}, found)
        elbow = next(joint for joint in found["joints"] if joint["joint"] == "elbow")
        # A grease of another temperature hides some of it, within the interval.
        self.assertLess(elbow["change_low"], 1.4)
        self.assertGreater(elbow["change_high"], 1.4)
        self.assertEqual([row["joints"][2]["temperature_source"] for row in found["recordings"]],
                         ["configured"] * 4 + ["received"])
        self.assertEqual(found["recordings"][4]["joints"][2]["temperature"], 20.0)
        text = self.succeed("trend", "months", "--arm", "ur5").stdout
        self.assertEqual(text.splitlines()[0], "WARN")
        heading = next(line for line in text.splitlines() if "in common" in line)
        self.assertEqual(re.findall(r"[a-z]+(?:_\d)?", heading.split("common")[1])[:6], NAMES)


if __name__ == "__main__":
    tool.main()
