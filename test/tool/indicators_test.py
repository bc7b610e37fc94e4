# SPDX-License-Identifier: BSD-3-Clause
"""`joint_twin indicators`, and `life` and `remaining`, which counts what they show."""
import json
import math
import pathlib
import re
import sys

import h5py

import robot
import tool

sys.path.insert(0, tool.CHECKOUT + "/lab")
import health_signatures  # noqa: E402  (after its folder)

HEADER = "duration,motor_speed,load_torque,temperature\n"  # of a duty cycle
ARCSEC = math.pi / 180.0 / 3600.0
SMALL_WINDOWS = ["--set", "indicators.window_turns=25.0", "--set", "indicators.baseline_windows=8"]


def recording(line_after=None, seconds=30.0, rate=500.0, line=4.0):
    """CSV of a joint with 5 arcsec at order 2; from `line_after` on also `line` arcsec at the outer race's order."""
    lines = ["t,theta,phi,amps"]
    for row in range(int(seconds * rate)):
        time = row / rate
        motor = 80.0 * time + 10.0 * math.sin(3.0 * time)
        error = 5.0 * math.cos(2.0 * motor)
        if line_after is not None and time > line_after:
            error += line * math.cos(10.3207 * motor)
        # A little of what is not in any model, so that healthy windows differ.
        error += 0.5 * math.sin(row * row * 0.37)
        torque = 2.0 + 0.01 * math.cos(row * 1.3)
        lines.append(f"{time:.6f},{motor:.9f},{motor / 101.0 - ARCSEC * error:.12f},{torque:.5f}")
    return "\n".join(lines) + "\n"


def to_and_fro(speed, drag, error, names="t,theta,phi,amps"):
    """CSV of a joint whose motor turns 80 rad one way and back at a speed [rad/s], with friction [N.m] and an error at
    order 2 [arcsec]."""
    lines = [names]
    for row in range(15000):
        time = row / 500.0
        back, travel = divmod(speed * time, 80.0)
        motor = 80.0 - travel if back % 2 else travel
        torque = (-drag if back % 2 else drag) + 0.001 * math.cos(row * 1.3)
        noise = 0.5 * math.sin(row * row * 0.37)
        output = motor / 101.0 - ARCSEC * (error * math.cos(2.0 * motor) + noise)
        lines.append(f"{time:.6f},{motor:.9f},{output:.12f},{10.0 * torque:.5f}")
    return "\n".join(lines) + "\n"


COLUMNS = ["--time", "t", "--motor-angle", "theta", "--output-angle", "phi", "--motor-torque", "amps",
           "--torque-scale", 0.1]


class Indicators(tool.ToolTest):
    def test_a_line_that_appears_is_found_and_named(self):
        self.write("a.csv", recording(line_after=20.0, seconds=40.0))
        report = self.succeed_json("indicators", "a.csv", *COLUMNS, *SMALL_WINDOWS, "--out", "windows.csv")
        # Lines begin once the motion is known to be calm: the first window has too few turns for orders 2 and 1.98.
        first, last = report["windows"][1], report["windows"][-1]
        self.assertAlmostEqual(first["indicators"]["error_wave_generator_2"] / ARCSEC, 5.0, delta=0.2)
        self.assertLess(first["indicators"]["error_outer"] / ARCSEC, 0.2)
        self.assertAlmostEqual(last["indicators"]["error_outer"] / ARCSEC, 4.0, delta=0.2)
        self.assertAlmostEqual(last["indicators"]["running_torque"], 0.2, delta=0.001)
        self.assertEqual(first["assessment"]["state"], "learning")
        self.assertIn(report["assessment"]["level"], ["WARN", "ERROR"])
        self.assertEqual(report["assessment"]["cause"], "bearing_outer_race")
        # The whole error grows with the line, and repeats better than eight windows tell of a line.
        self.assertEqual([each["indicator"] for each in report["assessment"]["evidence"]][:2],
                         ["kinematic_error", "error_outer"])
        with open(self.path("windows.csv")) as file:
            self.assertEqual(len(file.readlines()), 1 + len(report["windows"]))

    def test_gaps_and_stamps_off_even_steps_are_remarked(self):
        rows = recording(seconds=20.0).splitlines()
        self.write("even.csv", "\n".join(rows))
        self.write("gap.csv", "\n".join(rows[:5000] + rows[5500:]))
        shifted = [f"{float(row.split(',')[0]) + 2e-4 * math.sin(1.7 * i * i):.6f},{row.split(',', 1)[1]}"
                   for i, row in enumerate(rows[1:])]
        self.write("jitter.csv", "\n".join(rows[:1] + shifted))
        said = [self.succeed("indicators", name, *COLUMNS, *SMALL_WINDOWS, "--json").stderr
                for name in ("even.csv", "gap.csv", "jitter.csv")]
        self.assertEqual(said[0], "")
        self.assertIn("gap.csv: 1 gap between samples, the longest 1.002 s, where a step of 2 ms is usual", said[1])
        self.assertRegex(said[2], r"jitter.csv: steps between samples differ by 0\.(1|2)\d* ms rms from the usual "
                                  r"(2|1\.99\d*) ms")
        self.assertNotIn("gaps", said[2])

    def test_a_reference_is_saved_and_given(self):
        self.write("healthy.csv", recording())
        self.write("faulty.csv", recording(line_after=0.0, seconds=13.0))
        healthy = self.succeed_json("indicators", "healthy.csv", *COLUMNS, *SMALL_WINDOWS, "--save-baseline", "b.yaml")
        self.assertEqual(healthy["assessment"]["level"], "OK")
        faulty = self.succeed_json("indicators", "faulty.csv", *COLUMNS, *SMALL_WINDOWS, "--baseline", "b.yaml")
        self.assertEqual([window["assessment"]["state"] for window in faulty["windows"][3:5]],
                         ["too few windows", "assessed"])
        self.assertEqual(faulty["assessment"]["cause"], "bearing_outer_race")

    def test_too_few_windows_are_no_verdict(self):
        self.write("healthy.csv", recording())
        self.write("faulty.csv", recording(line_after=0.0, seconds=7.0))
        self.succeed("indicators", "healthy.csv", *COLUMNS, *SMALL_WINDOWS, "--save-baseline", "b.yaml")
        judged = ["indicators", "faulty.csv", *COLUMNS, *SMALL_WINDOWS, "--baseline", "b.yaml"]
        done = self.run_tool(*judged)
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("faulty.csv: too few windows: a verdict needs 5 at one operating point, but there are 3",
                      done.stderr)
        self.assertRegex(done.stdout, r"state +too few windows\nlevel +not judged\n")
        self.assertRegex(done.stdout, r"furthest off +kinematic_error\nits deviation +[1-9][0-9.]+ spreads\n")
        # A check-up that is made once is judged by its window.
        once = self.succeed_json(*judged, "--set", "indicators.evidence_windows=1")
        self.assertEqual(once["windows"][0]["assessment"]["state"], "assessed")
        self.assertNotEqual(once["assessment"]["level"], "OK")

    def test_a_recording_that_cannot_be_read_is_named_and_the_others_are_read(self):
        self.write("a.csv", recording(seconds=7.0))
        self.write("b.csv", "t\n0\n")
        self.write("c.h5", "")
        done = self.run_tool("indicators", "c.h5", "a.csv", "b.csv", *COLUMNS, *SMALL_WINDOWS, "--json")
        self.assertEqual(done.returncode, 1, done.stderr)
        for text in ("not read: c.h5", "not read: b.csv:1: --motor-torque amps: no such column"):
            self.assertIn(text, done.stderr)
        report = json.loads(done.stdout)
        self.assertEqual({window["recording"] for window in report["windows"]}, {"a.csv"})
        self.assertEqual([each["recording"] for each in report["unread"]], ["c.h5", "b.csv"])
        self.fail_with(1, ["none of 2 recordings can be read: c.h5"], "indicators", "c.h5", "c.h5")

    def test_a_column_that_is_not_there_is_refused(self):
        self.write("a.csv", recording(seconds=3.0))
        for option in ("--time", "--motor-torque", "--motor-angle", "--output-angle", "--motor-velocity",
                       "--load-torque", "--temperature"):
            self.fail_with(1, [f"a.csv:1: {option} thetta: no such column (did you mean theta?); it holds t, theta, "
                               "phi, amps"], "indicators", "a.csv", option, "thetta")
        robot.write_bag(self.path("a.bag"), 20.0)
        self.fail_with(1, ["a.bag is a bag: --temperature t names a column"], "indicators", "a.bag", "--joint", "elbow",
                       "--temperature", "t")
        self.fail_with(1, ["a.bag has no topic /load; it holds:", "/joint_states"], "indicators", "a.bag", "--joint",
                       "elbow", "--load-topic", "/load")

    def test_a_run_of_a_data_set_brings_its_parameters_and_windows(self):
        self.write("plan.yaml", """
duration: 2.5
overlays: [real_sensors.yaml]
set: {output.gravity_torque: 30.0, indicators.window_turns: 5.0}
duty: [{speed: {constant: 1.0}}]
record:
  indicators: true
  groups: {signals: {rate: 2000.0, columns: [motor_angle_encoder, output_angle_encoder, motor_torque_reading,
                                             load_torque]}}
""")
        self.succeed("sweep", "plan.yaml", "--out", "a")
        run = "a/runs/run_000000000.h5"
        with h5py.File(self.path(run), "r") as file:
            windows = {name: column[:] for name, column in file["indicators"].items()}
        self.assertGreaterEqual(len(windows["window_end"]), 3)

        def read(*options):
            """The windows, and what they were made of and with."""
            found = self.succeed_json("indicators", run, *options)["windows"]
            self.assertEqual(len(found), len(windows["window_end"]))
            return found, found[0]["made_of"], found[0]["parameters"]

        found, *origin = read()
        self.assertEqual(origin, ["windows of the run", "run"])
        for name in ("kinematic_error", "running_torque", "ripple_outer", "error_wave_generator_2"):
            self.assertEqual([window["indicators"][name] for window in found],
                             [None if math.isnan(value) else value for value in windows[name]])
        self.assertEqual([window["load"] for window in found], list(windows["window_load"]))
        self.assertTrue((windows["window_error_ripple_outer"] > 0.0).all(), windows["window_error_ripple_outer"])
        self.succeed("indicators", run, "--save-baseline", "errors.yaml")
        learned = pathlib.Path(self.path("errors.yaml")).read_text(encoding="utf-8")
        relative = [float(error) for error in
                    re.findall(r" ripple_outer: \[\d+, [^,]+, [^,]+, [^,]+, ([^,\]]+)", learned)]
        self.assertTrue(relative and min(relative) >= 1.0, relative)
        _, *origin = read("--set", "indicators.evidence_windows=1")
        self.assertEqual(origin, ["windows of the run", "run, under those of the command line"])
        # The motor's speed was not recorded: it is that of the drive's sensors all the same.
        found, *origin = read("--time", "time")
        self.assertEqual(origin, ["signals", "run"])
        for name in ("running_torque", "kinematic_error"):
            for window, value in list(zip(found, windows[name]))[1:]:
                self.assertAlmostEqual(window["indicators"][name], value, delta=1e-9)
        found, *origin = read("--set", "output.gravity_torque=0.0")
        self.assertEqual(origin, ["signals", "run, under those of the command line"])
        self.assertEqual(found[0]["load"], 0.0)
        self.fail_with(1, [f"{run}: --motor-angle motor_angel_encoder: no such column (did you mean "
                           "motor_angle_encoder?); it holds load_torque, motor_angle_encoder, motor_torque_reading"],
                       "indicators", run, "--motor-angle", "motor_angel_encoder")
        self.fail_with(1, [f"{run}: --motor-torque torque: no such column; it holds load_torque"], "indicators", run,
                       "--motor-torque", "torque")

    def test_the_assessment_has_the_law_that_its_errors_are_fitted_with(self):
        table, errors = health_signatures.read(
            pathlib.Path(tool.CHECKOUT) / "config" / "signatures" / "size_25.yaml")
        self.write("healthy.csv", recording())
        self.succeed("indicators", "healthy.csv", *COLUMNS, *SMALL_WINDOWS, "--save-baseline", "b.yaml")
        for line in (1.0, 4.0):
            self.write("faulty.csv", recording(line_after=0.0, seconds=12.0, line=line))
            windows = self.succeed_json("indicators", "faulty.csv", *COLUMNS, *SMALL_WINDOWS, "--baseline", "b.yaml",
                                        "--set", "indicators.evidence_windows=1", "--set",
                                        "indicators.false_alarm_rate=1e-3")["windows"]
            alarms = [window for window in windows if window["assessment"]["level"] != "OK"]
            self.assertTrue(alarms)
            for window in alarms:
                layout = health_signatures.Layout(window["indicators"])
                probability, *_ = health_signatures.Hypotheses(layout, window, table).posterior(errors)
                found = window["assessment"]
                self.assertEqual(found["cause"], max(probability, key=probability.get))
                self.assertAlmostEqual(found["confidence"], probability[found["cause"]], delta=1e-6)

    def test_what_a_model_shows_too_is_taken_off(self):
        self.write("a.csv", recording(line_after=0.0, seconds=12.0))
        with open(self.path("a.csv")) as file:
            self.write("model.csv", file.read().replace("t,theta,phi,amps",
                                                        "time,motor_angle_encoder,output_angle_encoder,motor_torque"))
        report = self.succeed_json("indicators", "a.csv", *COLUMNS, *SMALL_WINDOWS, "--model", "model.csv")
        for name in ["error_wave_generator_2", "error_outer", "kinematic_error"]:
            self.assertAlmostEqual(report["windows"][-1]["indicators"][name], 0.0, delta=1e-12)

    def test_a_model_carries_the_reference_to_another_motion(self):
        model = "time,motor_angle_encoder,output_angle_encoder,motor_torque"
        for name, speed, drag in [("slow", 60.0, 0.25), ("fast", 100.0, 0.25), ("worn", 100.0, 0.4)]:
            self.write(f"{name}.csv", to_and_fro(speed, drag, 5.0))
            self.write(f"{name}_model.csv", to_and_fro(speed, 0.024, 4.0, model))  # motor_torque has no scale
        self.succeed("indicators", "slow.csv", *COLUMNS, *SMALL_WINDOWS, "--model", "slow_model.csv",
                     "--save-baseline", "b.yaml")
        judged = [*COLUMNS, *SMALL_WINDOWS, "--baseline", "b.yaml"]
        report = self.succeed_json("indicators", "fast.csv", "worn.csv", *judged, "--carry", "--model",
                                   "fast_model.csv", "--model", "worn_model.csv")
        last = {window["recording"]: window["assessment"] for window in report["windows"]}
        self.assertEqual([last[name]["state"] for name in ("fast.csv", "worn.csv")], ["assessed", "assessed"])
        self.assertEqual(last["fast.csv"]["level"], "OK")
        self.assertNotEqual(last["worn.csv"]["level"], "OK")
        self.assertIn("running_torque", [item["indicator"] for item in last["worn.csv"]["evidence"]])

        self.fail_with(1, ["b.yaml is no baseline: it was saved with --model, so it serves only with --model"],
                       "indicators", "fast.csv", *judged)
        self.fail_with(1, ["--model was given 1 times for 2 recordings"],
                       "indicators", "fast.csv", "worn.csv", *COLUMNS, "--model", "fast_model.csv")
        self.fail_with(2, ["--model"], "indicators", "fast.csv", *judged, "--carry")

    def test_a_bag_of_the_twin_gives_the_same_as_its_table(self):
        run = ["--torque", 0.2, "--duration", 1.5, "--set", "publish.joint_states_rate=2000"]
        short = ["--set", "indicators.window_turns=5.0"]
        reports = []
        for name in ["a.bag", "a.csv"]:
            self.succeed("simulate", *run, "--out", name)
            reports.append(self.succeed_json("indicators", name, *short))
        self.assertGreater(len(reports[0]["windows"]), 0)
        self.assertEqual(len(reports[0]["windows"]), len(reports[1]["windows"]))
        for one, other in zip(*(report["windows"] for report in reports)):
            self.assertAlmostEqual(one["indicators"]["kinematic_error"], other["indicators"]["kinematic_error"],
                                   delta=1e-9)
            self.assertAlmostEqual(one["indicators"]["running_torque"], other["indicators"]["running_torque"],
                                   delta=1e-9)

    def test_windows_that_were_published_are_those_of_the_signals(self):
        run = ["--torque", 0.2, "--set", "publish.joint_states_rate=2000", "--set", "publish.indicators_rate=100",
               "--set", "indicators.window_turns=5.0"]
        for name, seconds in [("a.bag", 1.5), ("b.bag", 1.2)]:
            self.succeed("simulate", *run, "--duration", seconds, "--out", name)
        short = ["--set", "indicators.window_turns=5.0"]
        reported = self.succeed_json("indicators", "--windows", "a.bag", "b.bag", *short)["windows"]
        self.assertEqual({window["recording"] for window in reported}, {"a.bag", "b.bag"})
        found = self.succeed_json("indicators", "a.bag", "b.bag", *short)["windows"]
        self.assertEqual([window["recording"] for window in reported], [window["recording"] for window in found])
        for one, other in zip(reported, found):
            for name in ["kinematic_error", "running_torque", "error_wave_generator_2_cos"]:
                self.assertAlmostEqual(one["indicators"][name], other["indicators"][name], delta=1e-8)

    def test_a_window_that_was_not_judged_has_no_level(self):
        self.write("a.csv", recording(seconds=3.0))
        text = self.succeed("indicators", "a.csv", *COLUMNS, *SMALL_WINDOWS).stdout
        self.assertRegex(text, r"state +learning")
        self.assertRegex(text, r"level +not judged")
        self.assertRegex(text, r"it has 1 of 8 windows at this operating point")

    def test_a_robots_joint_is_named_as_elsewhere(self):
        robot.write_bag(self.path("a.bag"), 120.0)
        options = ["--config", "joints/elbow.yaml", "--set", "indicators.window_turns=5.0",
                   "--set", f"telemetry.torque_per_current={robot.GAIN}"]
        for other, topic in ((["--joint", "base"], "/joint_states"),
                             (["--joint", "elbow", "--states-topic", "/arm/states"], "/arm/states")):
            self.fail_with(1, ["no state of", "on " + topic], "indicators", "a.bag", *options, *other)
        windows = self.succeed_json("indicators", "a.bag", *options, "--joint", "elbow")["windows"]
        # Torque at the motor: the current's share of the gain, not the current itself.
        self.assertLess(max(abs(window["indicators"]["running_torque"]) for window in windows), 1.0)

    def test_what_cannot_be_read_is_said(self):
        self.write("short.csv", recording(seconds=1.0))
        self.write("no_angle.csv", "time,motor_torque\n0,1\n")
        self.fail_with(1, ["too short for one window"], "indicators", "short.csv", *COLUMNS)
        self.fail_with(1, ["neither column 'motor_angle_encoder'"], "indicators", "no_angle.csv")
        row = "[0, 0, 0, 0, 0, 0, 0]"
        place = f"place: {row}, information: [{', '.join([row] * 7)}], "
        head = "format: 4\nload_step: 25.125\nbaseline:\n"
        point = "  - {speed: 1, direction: 0, load: 0, temperature: 0, windows: 3, runs: 3, tail: [0, 0], "
        for text, parts in (
                ("load_step: 25.125\nbaseline:\n  - {speed: 1}\n", ["version of the software", "save the file again"]),
                (head.replace("25.125", "2.925") + point + "indicators: {}}\n",
                 ["its load_step is 2.925 [N.m], expected 25.125"]),
                (head + point + place + "indicators: {nonsense: [3, 1.0, 0.1, 0.1, 0.0, 1.0]}}\n",
                 ["unknown indicator nonsense"]),
                (head + point.replace("[0, 0], ", "[.nan, 0], ") + place + "indicators: {}}\n",
                 ["tail within 0 ... 0.22"])):
            self.write("bad.yaml", text)
            self.fail_with(1, ["bad.yaml is no baseline", *parts], "indicators", "short.csv", *COLUMNS, "--baseline",
                           "bad.yaml")


class Life(tool.ToolTest):
    def duty(self, rows="10,209.4,67,40\n"):
        return self.write("duty.csv", HEADER + rows)

    def test_a_drive_ages_until_its_first_limit(self):
        path = self.path("age.csv")
        document = self.succeed_json("life", "age", self.duty(), "--every", 5000, "--csv", path)
        self.assertEqual(document["end"], "flank wear")
        rows = self.rows(path)
        self.assertEqual(rows[0]["hours"], 0.0)
        self.assertEqual(rows[-1]["hours"], document["hours"])
        for before, after in zip(rows, rows[1:]):
            self.assertLess(before["flank_wear"], after["flank_wear"])
            self.assertLess(before["bearings_failed"], after["bearings_failed"])

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

    def test_bad_duty_cycles_are_named(self):
        self.fail_with(1, ["duration", ":2"], "life", "age", self.duty("0,1,2,3\n"))
        self.fail_with(1, ["turns in none of the phases"], "life", "age", self.duty("10,0,67,40\n"))
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
        new = self.write("new.csv", recording())
        spalled = self.write("spalled.csv", recording(line_after=0.0, seconds=12.0))
        options = [*COLUMNS, *SMALL_WINDOWS]
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
        self.fail_with(1, ["judged with the reference b.yaml: ", "slow.csv: no whole window of steady motion"],
                       "remaining", self.write("slow.csv", "t,theta,phi,amps\n0,0,0,1\n0.5,1,0.01,1\n"), *options,
                       "--baseline", "b.yaml")
        # Too few windows to be called sound; and two of one operating point are no reference.
        short = self.write("short.csv", recording(line_after=0.0, seconds=7.0))
        self.fail_with(1, ["short.csv: too few windows: a verdict needs 5 at one operating point, but there are 3"],
                       "remaining", short, *options, "--hours", 1e6, "--baseline", "b.yaml")
        self.succeed("indicators", short, *options, "--save-baseline", "few.yaml")
        self.fail_with(1, ["new.csv: the healthy reference needs 8 windows at this operating point, but has 3\n",
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
        new = self.write("new.csv", recording())
        options = [*COLUMNS, *SMALL_WINDOWS]
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
