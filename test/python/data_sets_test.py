#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Data sets and verdicts as frames. Argument: the tool."""
import contextlib
import io
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
import warnings

import numpy as np

try:
    import h5py
    import pandas
except ImportError as error:
    print(f"skipped: {error}")
    sys.exit(77)

import harmonic_joint_twin as hjt

TOOL = sys.argv.pop(1)
CHECKOUT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
SOUND, WORN = 12, 2
PLAN = """
seed: 5
duration: 7.1
set:
  solver.scene: auto
  indicators.window_time: 6.0
  indicators.window_turns: 100000.0
  output.gravity_torque: {uniform: [30.0, 34.0]}
duty: [{name: slow, speed: {trapezoid: {peak: 0.5, slope: 5.0, hold: 0.9}}}]
repeats: %d
classes: {%s}
record:
  indicators: true
  groups:
    signals: {rate: 500.0, columns: [motor_angle_encoder, output_angle_encoder, motor_torque_reading]}
"""
OLD = "lubricant_degradation: [{kind: lubricant_degradation, severity: 0.9, place: -1, onset: 0.0}]"


class DataSets(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        os.chdir(cls.folder.name)
        for name, repeats, classes in (("sound", SOUND, "healthy: []"), ("old", WORN, OLD)):
            with open(name + ".yaml", "w", encoding="utf-8") as file:
                file.write(PLAN % (repeats, classes))
            hjt.sweep(name + ".yaml", name)
        cls.learned = hjt.reference("sound", "sound_reference.yaml")

    @classmethod
    def tearDownClass(cls):
        os.chdir("/")
        cls.folder.cleanup()

    def test_a_set_comes_as_one_frame_with_its_labels(self):
        runs, windows = hjt.load("old", group=None), hjt.load("old")
        self.assertEqual(list(runs["class"]), ["lubricant_degradation"] * WORN)
        self.assertEqual(list(windows.file), list(runs.file))
        with h5py.File(runs.file[1], "r") as file:
            self.assertEqual(windows.running_torque[1], file["indicators/running_torque"][0])
            samples = hjt.load("old", "signals").groupby("file").get_group(runs.file[1])
            np.testing.assert_array_equal(samples["motor_angle_encoder"], file["signals/motor_angle_encoder"][:])
        with self.assertRaisesRegex(hjt.InputError, "no group 'signal'; it holds .*signals"):
            hjt.load("old", "signal")
        with self.assertRaisesRegex(hjt.InputError, "index.csv does not exist"):
            hjt.load("nothing")

    def test_columns_are_chosen_and_labels_stand_apart(self):
        whole = hjt.load("old", "signals")
        names = ["motor_torque_reading", "class", "time"]
        some = hjt.load("old", "signals", columns=names)
        self.assertEqual(list(some), ["file", *names])
        pandas.testing.assert_frame_equal(some, whole[["file", *names]])
        self.assertEqual(some.attrs, {"features": ["motor_torque_reading", "time"], "labels": ["file", "class"]})
        windows = hjt.load("old")
        self.assertEqual(set(windows.attrs["labels"]) & {"window_severity", "class", "run", "running_torque"},
                         {"window_severity", "class", "run"})
        self.assertIn("running_torque", windows.attrs["features"])
        self.assertFalse([name for name in windows.attrs["features"] if "severity" in name or "class" in name])
        self.assertEqual(list(hjt.load("old", group=None, columns=["class"])), ["file", "class"])
        for group, wrong, said in (("signals", ["time", "clas"], "there is no 'clas'"),
                                   ("signals", ["class"], "group 'signals' has none of class"),
                                   (None, ["time"], "there is no 'time'")):
            with self.assertRaisesRegex(hjt.InputError, said):
                hjt.load("old", group, columns=wrong)

    def test_a_card_says_what_a_set_is_and_its_sums_hold(self):
        shutil.copytree("old", "published")
        found = hjt.write_card("published", licence="CC-BY-4.0", authors="A. Author", title="Old grease")
        self.assertEqual(found["files"], WORN + 2)
        with open(found["card"], encoding="utf-8") as file:
            card = file.read()
        self.assertTrue(card.startswith('---\npretty_name: "Old grease"\nlicense: cc-by-4.0\n'), card[:80])
        for part in ("| lubricant_degradation | 2 |", "CC-BY-4.0. A. Author: Old grease.",
                     "| `signals`, 500 Hz | `motor_torque_reading` | N.m |", "harmonic_joint_twin 0."):
            self.assertIn(part, card)
        check = ["sha256sum", "-c", "--quiet", "SHA256SUMS"]
        subprocess.run(check, cwd="published", check=True)
        self.assertEqual(hjt.sweep("old.yaml", "published")["done"], 0, "the set is as it was")
        with open("published/index.csv", "a", encoding="utf-8") as file:
            file.write("\n")
        self.assertNotEqual(subprocess.run(check, cwd="published", check=False, capture_output=True).returncode, 0)
        os.remove(sorted(hjt.load("published", group=None)["file"])[0])
        index = pandas.read_csv("published/index.csv")
        index.loc[0, "status"] = "missing"
        index.to_csv("published/index.csv", index=False)
        with warnings.catch_warnings(record=True) as said:
            warnings.simplefilter("always")
            with self.assertRaisesRegex(hjt.InputError, "1 of 2 runs are present, but a card needs"):
                hjt.write_card("published", licence="CC-BY-4.0", authors="A. Author")
        self.assertIn("published is unfinished: 1 of 2 runs are missing", str(said[0].message))

    def test_a_set_of_drives_is_split_by_them(self):
        drives = "drives: {number: 2, test: 0.5, set: {bearing.viscosity: {log_uniform: [1.0e-4, 2.0e-4]}}}\nduty:"
        with open("drives.yaml", "w", encoding="utf-8") as file:
            file.write((PLAN % (2, "healthy: []")).replace("duty:", drives))
        hjt.sweep("drives.yaml", "drives")
        windows = hjt.load("drives")
        self.assertEqual(list(zip(windows.drive, windows.split)), 2 * [(0, "train")] + 2 * [(1, "test")])
        self.assertEqual(list(windows.groupby("drive")["drives.set.bearing.viscosity"].nunique()), [1, 1])
        self.assertLess({"drive", "split", "drives.set.bearing.viscosity"}, set(windows.attrs["labels"]))
        pandas.testing.assert_frame_equal(hjt.load("drives", columns=["split", "running_torque"]),
                                          windows[["file", "split", "running_torque"]])
        with open(hjt.write_card("drives", licence="CC0-1.0", authors="A. Author")["card"], encoding="utf-8") as file:
            card = file.read()
        self.assertIn("harmonic drive: 4 runs of 2 drives.", card)
        self.assertIn("split by drive, as `split` says.", card)

    def test_the_page_judges_detectors_on_drives_that_they_have_not_seen(self):
        with open(os.path.join(CHECKOUT, "docs", "datasets.md"), encoding="utf-8") as file:
            example = re.search(r"```python\n([^`]*for name in [^`]*)```", file.read())[1]
        hjt.sweep(os.path.join(CHECKOUT, "plans", "drives.yaml"), "drives_of_the_page")
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed):
            exec(example.replace('"drives"', '"drives_of_the_page"', 1), {})  # pylint: disable=exec-used
        rows = [line.split() for line in printed.getvalue().splitlines()]
        shown = [line.split()[1:] for line in example.splitlines() if line.startswith("# ")]
        self.assertEqual([row[0] for row in rows], [row[0] for row in shown])
        for row, expected in zip(rows, shown):
            # A count of the encoders, which the C library's last digits decide, may turn a run or two about.
            np.testing.assert_allclose(np.array(row[1:], float), np.array(expected[1:], float), atol=0.01)

    def test_an_arm_comes_with_a_column_for_each_joint(self):
        with open("moves.yaml", "w", encoding="utf-8") as file:
            file.write("start: [0.0, -1.2, 1.0, -1.3, -1.5, 0.3]\nspeed: 1.0\nacceleration: 8.0\n"
                       "moves: [{to: [0.0, -1.2, 1.02, -1.3, -1.5, 0.3]}]\n")
        with open("arm.yaml", "w", encoding="utf-8") as file:
            file.write("arm: ur5\nduration: 0.6\nset: {solver.scene: full_ring}\nduty: [{motion: moves.yaml}]\n"
                       "classes: {worn: [{joint: elbow, kind: interface_wear, severity: 0.5}]}\nrecord: {start: 0.5, "
                       "groups: {states: {rate: 100.0, columns: [target_q, actual_q, actual_current]}}}\n")
        hjt.sweep("arm.yaml", "arm")
        states = hjt.load("arm", "states")
        self.assertEqual(len(states), 10)
        self.assertEqual(list(states.severity_2.round(3).unique()), [0.5])
        self.assertEqual(states.severity_1.max(), 0.0)
        self.assertLess((states.actual_q_2 - 1.0).abs().max(), 0.03)
        self.assertEqual(states.fault_joint[0], "elbow")
        episode = hjt.as_factorynet(states)
        self.assertEqual(set(episode), {"episode_id", "timestamp", "fault_label"} | {
            f"{name}_{i}" for name in ("setpoint_pos", "feedback_pos", "effort_current") for i in range(6)})
        self.assertEqual([*episode.iloc[0][["episode_id", "fault_label"]]], ["run_000000000", "worn"])
        for name, own in (("timestamp", "time"), ("setpoint_pos_2", "target_q_2"), ("effort_current_5",
                                                                                    "actual_current_5")):
            np.testing.assert_array_equal(episode[name], states[own])
        with self.assertRaisesRegex(hjt.InputError, "FactoryNet's setpoint_, which an episode needs"):
            hjt.as_factorynet(hjt.load("old", "signals"))

    def test_a_folder_is_judged_by_a_reference(self):
        self.assertEqual(len(self.learned), SOUND)
        verdicts = hjt.assess("old", "sound_reference.yaml", check_up=True)
        self.assertEqual(list(verdicts.recording), list(hjt.load("old", group=None).file))
        self.assertEqual(set(verdicts.state), {"assessed"})
        self.assertFalse((verdicts.level == "OK").any(), verdicts)
        self.assertTrue((verdicts.score > 1.0).all(), verdicts)
        sound = hjt.assess(hjt.load("sound", group=None).file[:3], "sound_reference.yaml", check_up=True)
        self.assertEqual(list(sound.level), ["OK"] * 3)
        for blind in sound.blind_to:
            self.assertIn("tooth_tip_crack", blind)
            self.assertNotIn("lubricant_degradation", blind)
        pandas.testing.assert_frame_equal(hjt.assess(list(verdicts.recording), "sound_reference.yaml", check_up=True),
                                          verdicts)

    def test_a_set_without_a_whole_window_is_told(self):
        with open("brief.yaml", "w", encoding="utf-8") as file:
            file.write((PLAN % (1, "healthy: []")).replace("duration: 7.1", "duration: 2.0"))
        hjt.sweep("brief.yaml", "brief")
        with self.assertRaisesRegex(hjt.InputError, "no run contains a row of 'indicators'; either a window"):
            hjt.load("brief")

    def test_signatures_of_another_gear_are_told(self):
        for name, told in (("size_14", True), ("size_25", False)):
            with warnings.catch_warnings(record=True) as caught:
                warnings.simplefilter("always")
                hjt.assess("old", "sound_reference.yaml", check_up=True,
                           overlays=[{"indicators.signatures": f"signatures/{name}.yaml"}])
            self.assertEqual(["signatures of another gear" in str(one.message) for one in caught], [True] * told, name)

    def test_no_recordings_are_an_error(self):
        for function in (hjt.indicators, hjt.remaining, lambda none: hjt.assess(none, "sound.yaml"),
                         lambda none: hjt.reference(none, "sound.yaml"), lambda none: hjt.trend(none, arm="ur5")):
            with self.assertRaisesRegex(hjt.InputError, "recordings: at least one is required"):
                function([])

    def test_runs_without_a_reference_are_one_warning_at_the_callers_line(self):
        runs = hjt.load("old", group=None)
        hjt.reference(runs.file[:2], "short.yaml")
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            hjt.assess("old", "short.yaml")
        [warning] = caught
        self.assertRegex(str(warning.message), f"and {WORN - 1} more: the healthy reference needs 8 windows")
        self.assertEqual(warning.filename, __file__)

    def test_columns_of_any_name_are_read(self):
        samples = hjt.load("sound", "signals")
        frame = samples[samples.run == 0]
        names = {"motor_angle_encoder": "m", "output_angle_encoder": "q", "motor_torque_reading": "i", "time": "t"}
        columns = {"motor_angle": "m", "output_angle": "q", "motor_torque": "i", "time": "t"}
        settings = {"overlays": [{"indicators.window_time": 6.0, "indicators.window_turns": 1e5}]}
        expected = hjt.indicators(frame, **settings)["windows"]
        found = hjt.indicators(frame.rename(columns=names), columns=columns, **settings)["windows"]
        self.assertEqual(found, expected)
        self.assertEqual(len(found), 1)
        with self.assertRaisesRegex(hjt.InputError, r"'motor_angel' is no signal \(did you mean motor_angle\?\)"):
            hjt.indicators(frame, columns={"motor_angel": "m"})

    def test_columns_that_are_no_numbers_are_named_not_dropped(self):
        samples = hjt.load("sound", "signals")
        frame = samples[samples.run == 0]
        settings = {"overlays": {"indicators.window_time": 6.0, "indicators.window_turns": 1e5}}
        expected = hjt.indicators(frame, **settings)["windows"]
        texts = frame.assign(motor_torque_reading=frame["motor_torque_reading"].map(repr))
        self.assertEqual(hjt.indicators(texts, **settings)["windows"], expected)
        for name in ("time", "motor_torque_reading", "load_torque"):
            with self.assertRaisesRegex(hjt.InputError, rf"recordings\[0\]: column '{name}' must be numbers of shape"):
                hjt.indicators(frame.assign(**{name: "heavy"}))
        with self.assertRaisesRegex(hjt.InputError, "column 'm' must be numbers"):
            hjt.indicators(frame.assign(m="x"), columns={"motor_angle": "m"})

    def test_a_damaged_file_is_named_and_the_others_are_read(self):
        shutil.copytree("sound", "damaged")
        files = hjt.load("damaged", group=None)["file"]
        os.truncate(files[0], 1000)
        with self.assertWarnsRegex(RuntimeWarning, f"not read: {files[0]}"):
            windows = hjt.load("damaged")
        self.assertEqual(list(windows.file), list(files[1:]))
        with self.assertWarnsRegex(RuntimeWarning, f"not read: {files[0]}"):
            verdicts = hjt.assess("damaged", "sound_reference.yaml", check_up=True)
        self.assertEqual(list(verdicts.recording), list(files))
        self.assertEqual(list(verdicts.state), ["not read"] + (SOUND - 1) * ["assessed"])
        with self.assertWarnsRegex(RuntimeWarning, f"not read: {files[0]}"):
            learned = hjt.reference("damaged", "others.yaml")
        self.assertEqual(list(learned.recording), list(files[1:]))
        for file in files[1:]:
            os.truncate(file, 1000)
        for function in (hjt.load, lambda folder: hjt.assess(folder, "sound_reference.yaml")):
            with self.assertRaisesRegex(hjt.InputError, files[0]):
                function("damaged")

    def test_times_that_are_not_in_seconds_are_named(self):
        samples = hjt.load("sound", "signals")
        frame = samples[samples.run == 0]
        frame = frame.assign(motor_velocity_encoder=np.gradient(frame.motor_angle_encoder, frame.time))
        for factor, text in ((1e3, "most samples are 0.5 s apart or more"), (200.0, "motor speed gives 200.* times")):
            for function in (hjt.indicators, hjt.remaining):
                with self.assertRaisesRegex(hjt.InputError, rf"recordings\[0\]: .*{text}.*, so the times are"):
                    function(frame.assign(time=factor * frame.time))

    def test_faults_of_brake_sensors_and_motor_grow_from_their_onset(self):
        time = np.arange(0.0, 4.0, 0.01)
        angle = 100.0 * np.where(time < 2.0, time, 4.0 - time)
        sound = {"time": time, "motor_angle_encoder": angle, "motor_torque_reading": np.full_like(time, 0.2),
                 "output_angle_encoder": angle / 101.0}
        dragging = hjt.drive_fault(sound, "brake_drag", 0.1, onset=1.0, ramp=1.0)["motor_torque_reading"]
        np.testing.assert_allclose(dragging[[50, 150, 350]], [0.2, 0.25, 0.1])
        lost = hjt.drive_fault(sound, "lost_counts", 0.01)["motor_angle_encoder"] - angle
        np.testing.assert_allclose(lost[[0, 200, 399]], [0.0, -0.01 * 200.0 / (2.0 * np.pi)] + [lost[200]], atol=1e-9)
        offset = hjt.drive_fault(sound, "encoder_offset", 0.002, onset=3.0)["output_angle_encoder"]
        np.testing.assert_allclose((offset - sound["output_angle_encoder"])[[0, 399]], [0.0, 0.002], atol=1e-12)
        weak = hjt.drive_fault(sound, "weak_magnets", 0.2)["motor_torque_reading"]
        np.testing.assert_allclose(weak, hjt.drive_fault(sound, "current_gain", 0.25)["motor_torque_reading"])
        np.testing.assert_array_equal(sound["motor_torque_reading"], 0.2)
        for wrong in (("brake", 0.1), ("weak_magnets", 1.0)):
            with self.assertRaises(hjt.InputError):
                hjt.drive_fault(sound, *wrong)

    def test_lives_are_written_as_cmapss_has_them(self):
        rows = []
        os.makedirs("lives/runs")
        for drive, (split, cause, length) in enumerate((("train", "flank_wear", 3), ("test", "flank_wear", 4),
                                                        ("train", "still in use", 5))):
            for check_up in range(length):
                file = f"runs/run_{len(rows)}.h5"
                with h5py.File("lives/" + file, "w") as run:
                    for name, value in (("window_end", 9.0), ("window_speed", 1.0), ("window_load", 2.0),
                                        ("window_temperature", 25.0), ("stiffness", 30.0 - check_up),
                                        ("loop", float("nan"))):
                        run.create_dataset("indicators/" + name, data=[value, value])
                rows.append({"run": len(rows), "file": file, "status": "ok", "duty": "check_up", "life.drive": drive,
                             "life.split": split, "life.hours": 100.0 * check_up,
                             "life.remaining": 100.0 * (length - check_up), "life.cause": cause})
        pandas.DataFrame(rows).to_csv("lives/index.csv", index=False)
        found = hjt.write_cmapss("lives", "cmapss")
        self.assertEqual(found, {"train": 1, "test": 1, "indicators": ["stiffness"]})
        train, test, left = (pandas.read_csv(f"cmapss/{name}.csv") for name in ("train", "test", "RUL"))
        self.assertEqual(list(train.columns), ["unit", "cycle", "hours", "speed", "load", "temperature", "stiffness"])
        self.assertEqual(list(train.cycle), [1, 2, 3])
        self.assertEqual(list(left.RUL), [100.0 * (4 - len(test) + 1)])
        with self.assertRaisesRegex(hjt.InputError, "contains no lives"):
            hjt.write_cmapss("sound", "none")


if __name__ == "__main__":
    unittest.main(verbosity=2)
