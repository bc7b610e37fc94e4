# SPDX-License-Identifier: BSD-3-Clause
"""`joint_twin lives`: data sets of drives that run to failure."""
import csv
import importlib.util
import json
import os
import shutil
import subprocess
import sys
import tempfile

import h5py
import numpy

import tool
from sweep_test import tree

PLAN = """
seed: 3
duration: 0.5
overlays: [real_sensors.yaml]
set:
  indicators.window_turns: 2.0
  sensors.output_eccentricity: {log_uniform: [2.0e-4, 8.0e-4]}
lives:
  drives: 5
  every: 15000.0
  longest: 70000.0
  duties: [rated.csv]
  test: 0.4
duty:
  - {name: check_up, speed: {constant: 1.0}, load: {constant: 10.0}}
  - {name: work, speed: {constant: {uniform: [0.8, 1.2]}}}
record:
  start: 0.2
  indicators: true
  groups: {signals: {rate: 100.0, columns: [motor_angle_encoder, motor_torque_reading]}}
"""
RATED = "duration,motor_speed,load_torque,temperature\n10,209.43951023931953,67,40\n"
TOOTH_WEAR_DEPTH = 30.0e-6  # [m] fault_scale of the shipped configuration
INTERFACE_WEAR_DEPTH = 10.0e-6


class Lives(tool.ToolTest):
    made = None  # the data set that most tests read

    def setUp(self):
        super().setUp()
        self.write("plan.yaml", PLAN)
        self.write("rated.csv", RATED)

    @classmethod
    def tearDownClass(cls):
        if cls.made:
            shutil.rmtree(cls.made)

    def lives(self, out, *arguments):
        return self.succeed("lives", "plan.yaml", "--out", out, *arguments)

    def read_only(self, out):
        """Made once for all tests, under this name."""
        if not self.made:
            Lives.made = tempfile.mkdtemp(prefix="joint_twin_lives_")
            self.lives(self.made, "--jobs", 1)
        os.symlink(self.made, self.path(out))

    def index(self, out):
        with open(self.path(out + "/index.csv")) as file:
            return list(csv.DictReader(file))

    def test_lives_go_from_new_to_the_end_with_the_wear_as_faults_and_labels(self):
        self.read_only("a")
        rows = self.index("a")
        drives = {}
        for row in rows:
            self.assertEqual((row["status"], row["class"]), ("ok", "life"))
            drives.setdefault(row["life.drive"], []).append(row)
        self.assertEqual(sorted(drives), list("01234"))
        self.assertEqual({drive: {row["life.split"] for row in life} for drive, life in drives.items()},
                         {"0": {"train"}, "1": {"train"}, "2": {"test"}, "3": {"train"}, "4": {"test"}})
        self.assertGreater(len({row["life.cause"] for row in rows}), 1)
        for life in drives.values():
            self.assertEqual([row["duty"] for row in life], ["check_up", "work"] * (len(life) // 2))
            self.assertEqual(len({row["set.sensors.output_eccentricity"] for row in life}), 1)
            check_ups = life[::2]
            hours = numpy.array([float(row["life.hours"]) for row in check_ups])
            numpy.testing.assert_array_equal(hours, 15000.0 * numpy.arange(len(hours)))
            length = float(life[0]["life.length"])
            self.assertTrue(hours[-1] < length <= min(hours[-1] + 15000.0, 70000.0))
            for row in life:
                self.assertAlmostEqual(float(row["life.remaining"]) + float(row["life.hours"]), length, delta=1e-6)
            for name in ("life.flank_wear", "life.interface_wear", "life.bearing_used"):
                wear = numpy.array([float(row[name]) for row in check_ups])
                self.assertEqual(wear[0], 0.0)
                self.assertTrue((numpy.diff(wear) > 0.0).all())
        self.assertEqual(len({row["set.sensors.output_eccentricity"] for row in rows}), 5)
        self.assertGreater(len({row["noise_seed"] for row in rows}), len(rows) - 2)
        last = max(drives.values(), key=len)[-1]
        severities = dict(zip(last["fault_kind"].split(";"), map(float, last["fault_severity"].split(";"))))
        # The rated duty presses one side of the teeth; the play grows by half the depth.
        self.assertAlmostEqual(severities["tooth_wear"], 0.5 * float(last["life.flank_wear"]) / TOOTH_WEAR_DEPTH,
                               delta=1e-9)
        self.assertAlmostEqual(severities["interface_wear"], float(last["life.interface_wear"]) / INTERFACE_WEAR_DEPTH,
                               delta=1e-9)
        self.assertAlmostEqual(severities["lubricant_degradation"], 0.3 * float(last["life.grease"]), delta=1e-9)
        with h5py.File(self.path("a/" + last["file"]), "r") as file:
            truth = json.loads(file["record"][()])["variables"]
            self.assertEqual(truth["life.cause"], last["life.cause"])
            self.assertAlmostEqual(float(file["signals/severity"][-1]), max(severities.values()), delta=1e-6)
            self.assertGreaterEqual(len(file["indicators/window_end"]), 1)

    def test_any_number_of_workers_and_shards_gives_the_same_bytes_and_what_is_there_is_kept(self):
        self.read_only("one")
        for shard in ("0/2", "1/2"):
            self.lives("two", "--jobs", 2, "--shard", shard)
        self.assertEqual(tree(self.made), tree(self.path("two")))
        self.assertIn(" 0 runs done", self.lives("two").stderr)

    def test_a_life_is_that_of_the_laws(self):
        every, longest = 1000.0, 12000.0
        self.write("plan.yaml", PLAN.replace("every: 15000.0", f"every: {every}")
                   .replace("longest: 70000.0", f"longest: {longest}"))
        self.succeed("life", "age", "rated.csv", "--grease-changes", "--positions", 8, "--hours", longest,
                     "--every", every, "--csv", "nominal.csv")
        nominal = {row["hours"]: row["interface_wear"] for row in self.rows("nominal.csv")}
        rows = list(csv.DictReader(self.lives("unused", "--list").stdout.splitlines()))
        check_ups = [{name[5:]: row[name] for name in row if name.startswith("life.")} for row in rows
                     if row["duty"] == "check_up" and float(row["life.interface_factor"]) < 1.0]
        compared = 0
        for one, other in zip(check_ups, check_ups[1:]):
            same_filling = one["filling_factor"] == other["filling_factor"] and one["drive"] == other["drive"]
            if same_filling:
                begin, end = float(one["hours"]), float(other["hours"])
                law = (nominal[end] - nominal[begin]) * float(one["interface_factor"]) * float(one["filling_factor"])
                worn = float(other["interface_wear"]) - float(one["interface_wear"])
                self.assertAlmostEqual(worn / law, 1.0, delta=0.05)  # wear changes the loads that wear
                compared += 1
        self.assertGreater(compared, 5)
        self.assertGreater(len({row["filling_factor"] for row in check_ups}), 2)

    def test_the_learner_of_the_page_reads_them(self):
        if importlib.util.find_spec("sklearn") is None:
            self.skipTest("python3-sklearn is not installed")
        self.read_only("a")
        script = tool.CHECKOUT + "/lab/lives_learner.py"
        done = subprocess.run([sys.executable, script, "a", "--prior", "a/index.csv", "--out", "a.png"],
                              cwd=self.directory, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                              universal_newlines=True, timeout=120 * tool.SLOWER, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stdout, r"judged: [1-9]\d* of [12] drives")
        for name in ("prior", "hours, duty", "hours, duty, indicators"):
            self.assertRegex(done.stdout, rf"\| {name} \| \d+ \| \d+ \| \d+ % \|")
        self.assertGreater(len(tool.read_bytes(self.path("a.png"))), 10000)

    def test_a_dry_run_counts_check_ups_and_the_response_surfaces_that_each_needs(self):
        self.write("plan.yaml", PLAN.replace("set:\n", "set:\n  solver.scene: auto\n").replace("drives: 5", "drives: 1")
                   .replace("every: 15000.0", "every: 30000.0").replace("  - {name: work", "  # - {name: work"))
        done = self.lives("a", "--dry-run")
        check_ups = len(self.lives("a", "--list").stdout.splitlines()) - 1
        self.assertRegex(done.stdout, rf"check-ups +{check_ups}\n")
        self.assertRegex(done.stdout, rf"response surfaces to build +{check_ups}\n")

    def test_bad_plans_are_refused(self):
        for old, new, parts in [
                ("lives:\n", "life:\n", ["bad.yaml:9: life is unknown"]),
                ("drives: 5", "drives: 0", ["lives.drives = 0 [-] is out of range, allowed: 1"]),
                ("every: 15000.0", "every: 0.005",
                 ["bad.yaml:10: lives.every = 0.005 [h] makes more than 1000000 check-ups in the first 1 of 5 drives"]),
                ("[rated.csv]", "[none.csv]", ["none.csv cannot be read"]),
                ("duty:\n", "classes: {a: []}\nduty:\n", ["classes is not allowed in a plan of lives"]),
                ("duty:\n", "drives: {number: 2}\nduty:\n",
                 ["drives is not allowed in a plan of lives, where lives.drives gives the drives"]),
                ("{log_uniform: [2.0e-4, 8.0e-4]}", "{grid: [2.0e-4, 8.0e-4]}", ["give a distribution or one value"])]:
            with self.subTest(new):
                self.assertIn(old, PLAN)
                self.write("bad.yaml", PLAN.replace(old, new, 1))
                self.fail_with(1, parts, "lives", "bad.yaml", "--out", "b")
        begin, end = PLAN.index("lives:"), PLAN.index("duty:")
        self.write("sweep.yaml", PLAN[:begin] + PLAN[end:])
        self.fail_with(1, ["has no mapping 'lives'"], "lives", "sweep.yaml", "--out", "b")

    def test_the_shipped_plan_is_right(self):
        lines = self.succeed("lives", tool.CHECKOUT + "/plans/lives.yaml", "--out", "unused", "--list")
        self.assertGreater(len(lines.stdout.splitlines()), 100)


if __name__ == "__main__":
    tool.main()
