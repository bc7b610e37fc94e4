# SPDX-License-Identifier: BSD-3-Clause
"""`joint_twin life` as its user meets it."""
import csv
import math

import indicators_test
import tool

HEADER = "duration,motor_speed,load_torque,temperature\n"


class Life(tool.ToolTest):
    def duty(self, rows="10,209.4,67,40\n"):
        return self.write("duty.csv", HEADER + rows)

    def test_a_drive_ages_until_its_first_limit(self):
        path = self.path("age.csv")
        document = self.succeed_json("life", "age", self.duty(), "--every", 5000, "--csv", path)
        self.assertEqual(document["end"], "flank wear")
        with open(path, encoding="utf-8") as file:
            rows = [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]
        self.assertEqual(rows[0]["hours"], 0.0)
        self.assertEqual(rows[-1]["hours"], document["hours"])
        for before, after in zip(rows, rows[1:]):
            self.assertLess(before["flank_wear"], after["flank_wear"])
            self.assertLess(before["bearings_failed"], after["bearings_failed"])

    def test_more_torque_and_warmth_wear_faster(self):
        hours = ("--hours", 1000)
        rated, heavy, warm = (self.succeed_json("life", "age", self.duty(row), *hours)
                              for row in ("10,209.4,67,40\n", "10,209.4,108,40\n", "10,209.4,67,70\n"))
        self.assertEqual(rated["end"], "still in use")
        self.assertGreater(heavy["flank_wear"], 1.3 * rated["flank_wear"])
        self.assertGreater(warm["flank_wear"], rated["flank_wear"])

    def test_a_deep_scratch_cracks_the_root(self):
        document = self.succeed_json("life", "age", self.duty(), "--set", "life.flaw_depth=1.0e-4")
        self.assertEqual(document["end"], "root crack")

    def test_overloads_end_a_life_by_fatigue(self):
        document = self.succeed_json("life", "age", self.duty("10,209.4,284,40\n"), "--config", "golden.yaml")
        self.assertEqual(document["end"], "tooth space fatigue")
        self.assertGreater(2.0 * document["turns"], 1e4)  # deflections that the catalogue allows
        self.assertAlmostEqual(document["fatigue"], 1.0, places=6)

    def test_fatigue_at_the_torques_of_the_catalogue(self):
        rows = self.succeed_json("life", "fatigue", "--config", "golden.yaml")["rows"]
        self.assertEqual([row["torque"] for row in rows[::3]], [67.0, 157.0, 284.0])
        self.assertEqual([row["place"] for row in rows[:3]], ["tooth space", "transition", "flange"])
        for row in rows:
            self.assertGreater(row["equivalent"], row["amplitude"])
            lasts = row["place"] != "tooth space" or row["torque"] < 200.0
            self.assertEqual(row["cycles"] > 1e6, lasts, row)  # beyond the knee of the S-N curve
            self.assertEqual(row["allowed"], 1e4 if row["torque"] > 200.0 else None)
        self.assertGreater(rows[6]["cycles"], rows[6]["allowed"])
        rated = self.succeed_json("life", "fatigue", "--torques", 67, "--config", "golden.yaml")["rows"]
        self.assertEqual(rated, rows[:3])
        beyond = self.succeed_json("life", "fatigue", "--torques", 300)["rows"]
        self.assertEqual([row["allowed"] for row in beyond], [0.0] * 3)

    def test_trials_are_the_same_every_time(self):
        trials = ("life", "trials", self.duty(), "--lives", 5, "--every", 5000)
        first = self.succeed_json(*trials, "--seed", 3)
        self.assertEqual(first, self.succeed_json(*trials, "--seed", 3))
        self.assertEqual(first["lives"], 5)
        self.assertIn("80 % interval", self.succeed(*trials).stdout)

    def test_wrong_usage(self):
        self.fail_with(2, [], "life")
        self.fail_with(2, [], "life", "age", self.path("nowhere.csv"))
        self.fail_with(2, [], "life", "trials", self.duty(), "--lives", 0)

    def test_bad_duty_cycles_are_named(self):
        self.fail_with(1, ["duration", ":2"], "life", "age", self.duty("0,1,2,3\n"))
        self.fail_with(1, ["never turns"], "life", "age", self.duty("10,0,67,40\n"))
        self.fail_with(1, ["temperature"], "life", "age",
                       self.write("duty.csv", "duration,motor_speed,load_torque\n1,2,3\n"))

    def test_remaining_life_of_a_recorded_joint(self):
        speed = 209.43951023931953
        rows = [f"{0.01 * i:.2f},{0.01 * speed * i:.8f},0.9,67,40" for i in range(1001)]
        self.write("work.csv", "time,motor_angle_encoder,motor_torque,load_torque,temperature\n" + "\n".join(rows))
        half, new = (self.succeed_json("remaining", "work.csv", "--hours", hours, *more)
                     for hours, more in [(20000.0, ["--use-record", "use.csv"]), (1.0, [])])
        self.assertAlmostEqual(half["hours"], 20000.0, delta=1e-6)
        self.assertAlmostEqual(half["turns"], 20000.0 * 3600.0 * speed / (2.0 * math.pi), delta=1e-3 * half["turns"])
        self.assertTrue(0.0 < half["remaining_q10"] < half["remaining_q50"] < half["remaining_q90"])
        # Those that last so long are not those that wear fast.
        self.assertGreater(half["hours"] + half["remaining_q50"], new["remaining_q50"])
        self.assertEqual(new["nearest"], "bearing")
        for report in (half, new):
            hours, probability = (report["density"][key] for key in ("hours", "probability"))
            self.assertAlmostEqual(sum(probability), 1.0, delta=1e-9)
            self.assertAlmostEqual(sum(report["end_probability"].values()), 1.0, delta=1e-9)
            self.assertTrue(all(a < b for a, b in zip(hours, hours[1:])))
            begun = sum(p for hour, p in zip(hours, probability) if hour <= report["remaining_q50"])
            self.assertTrue(0.5 <= begun < 0.75, begun)
        self.assertLess(new["remaining_q50"], 38500.0)  # of the bearing alone, docs/life.md
        age = self.succeed_json("life", "age", "use.csv", "--grease-changes", "--hours", 20000.0)
        self.assertAlmostEqual(age["turns"], half["turns"], delta=1e-3 * half["turns"])
        self.fail_with(1, ["the motor does not turn"], "remaining", self.write(
            "rest.csv", "time,motor_angle_encoder,motor_torque\n0,1,0\n1,1,0\n"))

    def test_an_assessment_tells_of_the_wear(self):
        new = self.write("new.csv", indicators_test.recording())
        spalled = self.write("spalled.csv", indicators_test.recording(line_after=0.0, seconds=12.0))
        options = [*indicators_test.COLUMNS, *indicators_test.SMALL_WINDOWS]
        self.succeed("indicators", new, *options, "--save-baseline", "b.yaml")
        sound, sound_unread, worn, unread = (
            self.succeed_json("remaining", path, *options, "--hours", 1e6, *more)
            for path in (new, spalled) for more in (["--baseline", "b.yaml"], []))
        self.assertEqual((sound["level"], worn["cause"]), ("OK", "bearing_outer_race"))
        self.assertNotIn("level", unread)
        self.assertNotIn("blind_to", worn)
        blind = sound["blind_to"].split(", ")
        self.assertIn("buckling", blind)
        self.assertEqual(blind, [cause for cause, from_ in sound["seen_from"].items() if from_ is None])
        self.assertIn("bearing_outer_race", sound["seen_from"])
        self.assertNotIn("bearing_outer_race", blind)
        self.assertGreater(worn["end_probability"]["bearing"], unread["end_probability"]["bearing"])
        self.assertLess(worn["remaining_q50"], 0.5 * unread["remaining_q50"])
        # The load went one way only: that nothing was found says nothing.
        self.assertEqual(sound["density"], sound_unread["density"])
        self.fail_with(1, ["lost_motion_limit: no recording shows the lost motion beside b.yaml"], "remaining", new,
                       *options, "--hours", 1e6, "--baseline", "b.yaml", "--lost-motion-limit", 5e-4)
        self.fail_with(1, ["nothing can be judged by b.yaml: ", "slow.csv: no whole window of steady motion"],
                       "remaining", self.write("slow.csv", "t,theta,phi,amps\n0,0,0,1\n0.5,1,0.01,1\n"), *options,
                       "--baseline", "b.yaml")
        # Too few windows to be called sound; and two of one operating point are no reference.
        short = self.write("short.csv", indicators_test.recording(line_after=0.0, seconds=7.0))
        self.fail_with(1, ["short.csv: too few windows: a verdict needs 5 at one operating point, has 3"], "remaining",
                       short, *options, "--hours", 1e6, "--baseline", "b.yaml")
        self.succeed("indicators", short, *options, "--save-baseline", "few.yaml")
        self.fail_with(1, ["new.csv: the healthy reference needs 8 windows at this operating point, has 3\n",
                           "spalled.csv: the healthy reference needs 8"], "remaining", new, spalled, *options,
                       "--baseline", "few.yaml")

    def test_the_laws_of_ageing_of_a_run_are_not_taken_from_it(self):
        plan = ("duration: 3.0\nset: {solver.scene: auto%s}\nduty: [{speed: {constant: 1.5}, load: {constant: 60.0}}]\n"
                "record: {start: 1.0, groups: {signals: {rate: 100.0, columns: [motor_angle_encoder, "
                "motor_torque_reading, load_torque, housing_temperature]}}}\n")
        laws = ("life.flank_wear_coefficient: 3.0e-17", "life.interface_wear_coefficient: 3.0e-17",
                "life.wear_spread: 0.1", "life.endurance_limit: 5.0e+7", "life.grease_wear_factor: 30.0")
        self.write("plain.yaml", plan % "")
        self.write("worn.yaml", plan % "".join(", " + law for law in laws))
        found = []
        for name in ("plain", "worn"):
            self.succeed("sweep", name + ".yaml", "--out", name)
            found.append(self.succeed_json("remaining", name + "/runs/run_000000000.h5", "--hours", 1000.0))
        self.assertEqual(found[0]["density"], found[1]["density"])
        told = self.succeed_json("remaining", "plain/runs/run_000000000.h5", "--hours", 1000.0, "--set",
                                 "life.flank_wear_coefficient=3.0e-17")
        self.assertLess(told["remaining_q50"], 0.5 * found[0]["remaining_q50"], "but from the command line")

    def test_the_use_may_be_a_duty_cycle(self):
        new = self.write("new.csv", indicators_test.recording())
        options = [*indicators_test.COLUMNS, *indicators_test.SMALL_WINDOWS]
        self.succeed("indicators", new, *options, "--save-baseline", "b.yaml")
        report = self.succeed_json("remaining", new, *options, "--baseline", "b.yaml", "--duty", self.duty(), "--hours",
                                   1000.0)
        self.fail_with(1, ["--hours has 2 values for 1 recordings"], "remaining", new, "--hours", "1,2")
        self.fail_with(1, ["ascending"], "remaining", new, new, "--hours", "2,1")
        self.fail_with(1, ["lost_motion_limit = 1.0 [rad] is out of range"], "remaining", new, *options, "--baseline",
                       "b.yaml", "--lost-motion-limit", 1.0)
        age = self.succeed_json("life", "age", self.duty(), "--grease-changes", "--hours", 1000.0)
        self.assertAlmostEqual(report["turns"], age["turns"], delta=1e-3 * age["turns"])
        self.assertEqual(report["level"], "OK")
        self.fail_with(2, ["--baseline"], "remaining", new, *options, "--duty", self.duty())


if __name__ == "__main__":
    tool.main()
