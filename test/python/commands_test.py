#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""The tool's commands, and the tracker, from Python: the tool's documents, its words, its files. Argument: the tool."""
import csv
import inspect
import json
import math
import os
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import unittest.mock
import warnings

import h5py
import numpy as np
import rosbag

import harmonic_joint_twin as hjt

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "support"))
from ur_recording import write_bag, write_csv  # noqa: E402

TOOL = sys.argv.pop(1)
ELBOW = ["joints/elbow.yaml", "recorded_load.yaml"]
PERIOD = 0.008
SILENT = {"time": [0.0, 0.1, 0.2], "motor_torque": [math.nan] * 3, "motor_angle_encoder": [0.0, 1.0, 2.0]}
PLAN = """
seed: 3
duration: 0.3
classes:
  healthy: []
  crack: [{kind: tooth_root_crack, severity: {grid: [0.3, 0.9]}, place: 40, onset: 0.0}]
duty:
  - {name: turning, speed: {constant: 1.0}, load: {constant: 10.0}}
record:
  start: 0.0
  groups: {signals: {rate: 100.0, columns: [motor_angle, output_angle]}}
"""


def motion(seconds=20.0):
    """Angles of six joints, shape (rows, 6), and the times."""
    times = np.arange(0.0, seconds, PERIOD)
    ends = np.array([0.6, -0.9, 1.1, -0.5, 0.4, 0.7])
    return times, 0.5 * (1.0 - np.cos(1.3 * times))[:, None] * ends


def recording(seconds=6.0):
    time = np.arange(0.0, seconds, 0.008)
    return (time, 0.6 * np.sin(1.3 * time), 1.0 + 2.0 * np.cos(1.3 * time), 5.0 * np.sin(time))


class Recordings(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        os.chdir(self.folder.name)
        self.addCleanup(os.chdir, "/")

    def tool(self, *words):
        done = subprocess.run([TOOL, *map(str, words), "--json"], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                              text=True, check=False)
        return json.loads(done.stdout)

    def record(self, write=write_csv, name="arm.csv"):
        """The recording of a sound arm: the currents are those that its twins predict."""
        times, angles = motion()
        write_csv("silent.csv", times, angles, np.zeros_like(angles))
        rows = hjt.follow("silent.csv", arm="ur5")["comparison"]
        currents = np.column_stack([np.interp(times, rows[joint]["time"], rows[joint]["current_predicted"])
                                    for joint in ("base", "shoulder", "elbow", "wrist_1", "wrist_2", "wrist_3")])
        write(name, times, angles, currents)

    @staticmethod
    def columns():
        """Of arm.csv as arrays."""
        table = np.genfromtxt("arm.csv", delimiter=",", names=True)
        return {"time": table["timestamp"],
                **{name: np.column_stack([table[f"actual_{part}_{i}"] for i in range(6)])
                   for name, part in (("position", "q"), ("current", "current"))}}


class Commands(Recordings):
    def test_follow_gives_the_rows_of_the_tool(self):
        self.record()
        found = hjt.follow("arm.csv", joint="elbow", overlays=[*ELBOW, {"telemetry.load": "model"}])
        expected = self.tool("follow", "arm.csv", "--joint", "elbow", "--config", ELBOW[0], "--config", ELBOW[1],
                             "--set", "telemetry.load=model", "--out", "rows.csv")
        rows = found.pop("comparison")
        self.assertEqual(found, expected)
        with open("rows.csv", newline="", encoding="utf-8") as file:
            written = list(csv.DictReader(file))
        self.assertEqual(len(rows), len(written))
        self.assertEqual(rows.dtype, hjt.COMPARISON_DTYPE)
        for name in written[0]:
            np.testing.assert_array_equal(rows[name], [float(row[name]) for row in written], name)

    def test_a_bag_is_followed_and_one_is_written(self):
        self.record(write_bag, "arm.bag")
        found = hjt.follow("arm.bag", arm="ur5", bag="out.bag")
        self.assertEqual(sorted(found["comparison"]), ["base", "elbow", "shoulder", "wrist_1", "wrist_2", "wrist_3"])
        for rows in found["comparison"].values():
            self.assertGreater(len(rows), 2000)
            self.assertLess(np.sqrt(np.mean(rows["current_residual"]**2)), 0.05)
        with rosbag.Bag("out.bag") as bag:
            self.assertIn("/elbow/joint_twin/contact_forces", bag.get_type_and_topic_info().topics)

    def test_check_and_identify_and_compare_answer_as_the_tool(self):
        self.record()
        self.assertEqual(hjt.check("arm.csv"), self.tool("check", "arm.csv"))
        self.assertTrue(hjt.check("arm.csv", "ur5")["usable"])
        found = hjt.identify("arm.csv", arm="ur5", out="identified", train=(0.0, 12.0), folds=2)
        expected = self.tool("identify", "arm.csv", "--arm", "ur5", "--train", "0,12", "--folds", "2")
        self.assertEqual(found, expected)
        self.assertEqual(hjt.Parameters("identified/elbow.yaml")["joint.name"], "elbow_joint")
        verdict = hjt.compare("arm.csv", "report", arm="ur5")
        self.assertIn(verdict["level"], ("OK", "WARN", "not judged"))
        self.assertLessEqual({"level", "text", "joints"}, set(verdict))
        self.assertLessEqual({"level", "reason", "text", "friction_factor"}, set(verdict["joints"][0]["verdict"]))
        with open("report/report.html", encoding="utf-8") as file:
            self.assertIn(verdict["level"], file.read())
        self.assertEqual(hjt.trend("arm.csv", arm="ur5"), self.tool("trend", "arm.csv", "--arm", "ur5"))

    def test_arrays_at_hand_give_what_their_file_gives(self):
        self.record()
        columns = self.columns()
        of_file, of_arrays = (hjt.follow(recording, arm="ur5") for recording in ("arm.csv", columns))
        for joint, rows in of_file.pop("comparison").items():
            np.testing.assert_array_equal(of_arrays["comparison"][joint], rows, joint)
        self.assertEqual(of_arrays["joints"], of_file["joints"])
        dates = np.array(np.round(1e9 * columns["time"]), "datetime64[ns]")
        dated = hjt.follow({**columns, "time": dates}, arm="ur5")
        self.assertEqual([joint["rows"] for joint in dated["joints"]], [joint["rows"] for joint in of_file["joints"]])
        residual = "current_residual_rms"
        self.assertAlmostEqual(dated["joints"][0][residual], of_file["joints"][0][residual], delta=1e-6)
        elbow = {"time": columns["time"], **{name: columns[name][:, 2] for name in ("position", "current")}}
        of_file, of_arrays = (hjt.identify(recording, joint="elbow", overlays=ELBOW[:1])
                              for recording in ("arm.csv", elbow))
        self.assertEqual(of_arrays, of_file)

    def test_an_arm_in_closed_loop_gives_what_the_tool_writes(self):
        time = 0.008 * np.arange(40)
        position = np.array([0.0, -1.2, 1.0, -1.3, -1.5, 0.3]) + 0.1 * (1.0 - np.cos(8.0 * time))[:, None]
        scene = {"solver.scene": "full_ring"}
        np.savetxt("motion.csv", np.column_stack([time, position]), "%.17g", ",", comments="",
                   header="timestamp," + ",".join(f"target_q_{i}" for i in range(6)))
        fault = "elbow:lubricant_degradation:0.5"
        found = hjt.arm("motion.csv", "ur5", faults=[fault], out="run.csv", overlays=[scene])
        of_arrays = hjt.arm({"time": time, "position": position}, "ur5", faults=[fault], overlays=[scene])
        expected = self.tool("arm", "motion.csv", "--arm", "ur5", "--fault", fault, "--out", "tool.csv", "--set",
                             "solver.scene=full_ring")
        written = np.genfromtxt("run.csv", delimiter=",", names=True)
        self.assertEqual(found["rows"]["target_q"].shape, (len(written), 6))
        for name, values in found["rows"].items():
            np.testing.assert_array_equal(of_arrays["rows"][name], values, name)
            for column in range(values.shape[1] if values.ndim > 1 else 0):
                np.testing.assert_array_equal(written[f"{name}_{column}"], values[:, column], name)
        self.assertEqual(found["joints"], expected["joints"])
        self.assertEqual(found["tool_error_max"], expected["tool_error_max"])

    def test_an_arm_as_an_object_moves_as_the_function_and_stops_by_itself(self):
        time = 0.008 * np.arange(40)
        phase = 8.0 * np.maximum(time - 0.016, 0.0)
        position = np.array([0.0, -1.2, 1.0, -1.3, -1.5, 0.3]) + 0.1 * (1.0 - np.cos(phase))[:, None]
        velocity = np.repeat(0.8 * np.sin(phase)[:, None], 6, axis=1)
        motion = {"time": time, "position": position, "velocity": velocity, "acceleration": np.zeros((40, 6))}
        scene = {"solver.scene": "full_ring"}
        expected = hjt.arm(motion, "ur5", overlays=[scene])["rows"]
        arm = hjt.Arm("ur5", position[0], overlays=[scene])
        self.assertEqual((arm.joints[2], arm.time, arm.protective_stop), ("elbow", 0.0, None))
        self.assertAlmostEqual(arm.move(motion), time[-1])
        parts = [arm.run(0.104), arm.run(time[-1] - 0.104)]
        for name, values in expected.items():
            np.testing.assert_array_equal(np.concatenate([part[name] for part in parts]), values[1:], name)
        arm.inject_fault("elbow:lubricant_degradation:1.0")
        arm.set_wrench((0.0, 0.0, -1000.0))
        arm.run(0.5)
        self.assertIn(arm.protective_stop["reason"], ("off its set point", "faster than its limit"))
        arm.set_wrench()
        arm.reset()
        self.assertIsNone(arm.protective_stop)
        arm.move(motion)
        np.testing.assert_allclose(arm.run(time[-1])["actual_current"], expected["actual_current"][1:], atol=1e-6)
        self.assertEqual(arm.counters["solver_failures"], 0)
        held = arm.run(0.4)["actual_current"][-1]  # at rest, the motion's end behind it
        arm.set_payload(2.0, (0.0, 0.0, 0.1))
        arm.set_temperature(60.0, "wrist_3")
        loaded = arm.run(0.4)
        self.assertGreater(abs(loaded["actual_current"][-1, 1] - held[1]), 0.5)  # 2 kg at some 0.5 m over 10.7 N.m/A
        self.assertLess(np.abs(loaded["actual_qd"][-1]).max(), 0.01)
        arm.move({"time": [0.0, 0.5], "position": [loaded["target_q"][-1], loaded["target_q"][-1] + 0.05]})
        np.testing.assert_allclose(arm.run(0.6)["target_q"][-1], loaded["target_q"][-1] + 0.05, atol=1e-9)
        for call, said in ((lambda: arm.set_payload(-1.0), "mass = -1"),
                           (lambda: arm.set_payload(1.0, (0.0, 0.0, 20.0)), "centre: 20"),
                           (lambda: arm.set_temperature(float("nan")), "degC"),
                           (lambda: arm.set_temperature(20.0, "knee"), "no joint 'knee'"),
                           (lambda: arm.inject_fault("knee:pitting:1.0"), "JOINT is one of base"),
                           (lambda: arm.run(-1.0), "duration"), (lambda: arm.run(0.1, rate=1e-300), "rate = 1.0?e-300"),
                           (lambda: arm.set_wrench((0.0, 0.0, 2000.0)), "1000"),
                           (lambda: hjt.Arm("ur5", [0.0]), "6 finite angles"),
                           (lambda: hjt.Arm("ur5", []), "6 finite angles"),
                           (lambda: hjt.Arm("ur5", [0.0, 1e300] + 4 * [0.0]), "angle = 1.0e.300 .rad. is out of range"),
                           (lambda: arm.move({"time": [0.0, 1.0], "position": [6 * [0.0], 6 * [1e300]]}),
                            "speed = 1.0e.300 .rad/s. is out of range"),
                           (lambda: arm.move({"time": [0.0], "position": [[0.0]]}), "6"),
                           (lambda: hjt.Arm("ur5", payload=-1.0), "payload")):
            with self.assertRaisesRegex(ValueError, said):
                call()

    def test_indicators_and_remaining_answer_as_the_tool_of_files_and_arrays(self):
        twin = hjt.Twin(hjt.Parameters())
        rows = twin.run(60000, motor_torque=0.4, load_torque=5.0, every=10)
        names = [name for name in rows.dtype.names if rows[name].ndim == 1]
        np.savetxt("run.csv", np.column_stack([rows[name] for name in names]), "%.17g", ",",
                   header=",".join(names), comments="")
        expected = self.tool("indicators", "run.csv")
        found = hjt.indicators("run.csv")
        self.assertEqual(found, expected)
        self.assertGreater(len(found["windows"]), 1)
        of_arrays = hjt.indicators(rows, save_baseline="new.yaml")
        for window in (*found["windows"], *of_arrays["windows"]):
            window.pop("recording")
        self.assertEqual(of_arrays, found)
        expected = self.tool("remaining", "run.csv", "--hours", "100")
        self.assertEqual(hjt.remaining("run.csv", hours=100.0), expected)
        self.assertEqual(hjt.remaining(rows, hours=100.0), expected)

    def test_progress_is_told_and_its_error_ends_the_function(self):
        self.record()
        told = []
        hjt.follow("arm.csv", arm="ur5", progress=lambda step, done: told.append((step, done)))
        self.assertIn("reading", {step for step, _ in told})
        self.assertTrue(all(0.0 <= done <= 1.0 for _, done in told), told)

        def fail(step, done):
            raise ZeroDivisionError

        with self.assertRaises(ZeroDivisionError):
            hjt.follow("arm.csv", arm="ur5", progress=fail)

    def test_an_arm_ends_while_its_first_table_is_built(self):
        steps = []

        def fail(step, done):
            steps.append(step)
            raise ZeroDivisionError

        with unittest.mock.patch.dict(os.environ, {"XDG_CACHE_HOME": os.path.abspath("cache")}):
            with self.assertRaises(ZeroDivisionError):
                hjt.arm({"time": [0.0, 1.0], "position": np.zeros((2, 6))}, "ur5", progress=fail)
            with self.assertRaises(ZeroDivisionError):
                hjt.Arm("ur5", progress=fail)
        self.assertEqual(steps, ["building the response surface"] * 2)

    def test_check_of_arrays_gives_what_their_file_gives_and_tells_its_progress(self):
        self.record()
        columns = self.columns()
        steps = set()
        of_file, of_arrays = hjt.check("arm.csv"), hjt.check(columns, progress=lambda step, done: steps.add(step))
        self.assertEqual((of_arrays.pop("recording"), of_arrays.pop("next")), ("recording", []))
        self.assertTrue(of_arrays["usable"])
        # Arms behind the first may fit by another unit of effort, which is not open in arrays.
        self.assertEqual(of_arrays.pop("ranking")[0], of_file["ranking"][0])
        for name in of_arrays:
            self.assertEqual(of_arrays[name], of_file[name], name)
        self.assertIn("reading", steps)
        with self.assertRaisesRegex(hjt.InputError, "recording has 1 joints, but no arm in config/arms has"):
            hjt.check({name: column[:, 2] if column.ndim > 1 else column for name, column in columns.items()})

    def test_checkup_writes_its_motion(self):
        found = hjt.checkup("ur10e", "motion.csv", joint="wrist_1")
        expected = self.tool("checkup", "--arm", "ur10e", "--out", "other.csv", "--joint", "wrist_1")
        self.assertEqual(found, {**expected, "output": "motion.csv"})
        with open("motion.csv", "rb") as mine, open("other.csv", "rb") as other:
            self.assertEqual(mine.read(), other.read())

    def test_a_sweep_leaves_its_files_and_resumes(self):
        with open("plan.yaml", "w", encoding="utf-8") as file:
            file.write(PLAN)
        found = hjt.sweep("plan.yaml", "data", jobs=2, shard=(0, 2))
        self.assertEqual((found["runs"], found["done"], found["present"], found["failed"]), (3, 2, 0, 0))
        told = []
        found = hjt.sweep("plan.yaml", "data", progress=lambda step, done: told.append(step))
        self.assertEqual((found["done"], found["present"]), (1, 2))
        self.assertTrue(set(told) <= {"building response surfaces", "sweep"}, told)
        with open(found["index"], newline="", encoding="utf-8") as file:
            lines = list(csv.DictReader(file))
        self.assertEqual([line["status"] for line in lines], ["ok"] * 3)
        with h5py.File(os.path.join("data", lines[2]["file"]), "r") as file:
            self.assertEqual(file["signals/motor_angle"].shape, (30,))
        with self.assertRaisesRegex(hjt.InputError, "has no mapping 'lives'"):
            hjt.lives("plan.yaml", "lives")


class Tracker(unittest.TestCase):
    def follow_by_tool(self, mode, columns):
        time, position, current, load = columns
        with tempfile.TemporaryDirectory() as folder:
            path, out = os.path.join(folder, "recording.csv"), os.path.join(folder, "followed.csv")
            np.savetxt(path, np.column_stack([time, position, current, load]), fmt="%.17g", delimiter=",", comments="",
                       header="timestamp,actual_q_2,actual_current_2,target_moment_2")
            subprocess.run([TOOL, "follow", path, "--joint", "elbow", "--mode", mode, "--out", out, "--config",
                            ELBOW[0]], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, check=True)
            return np.genfromtxt(out, delimiter=",", names=True)

    def test_gives_the_numbers_of_the_tool(self):
        columns = recording()
        for mode in ("motion", "torque", "observer"):
            with self.subTest(mode):
                expected = self.follow_by_tool(mode, columns)
                time, position, current, load = columns
                rows = hjt.Tracker(hjt.Parameters(ELBOW[0]), mode).follow(time, position, current, load=load)
                self.assertEqual(len(rows), len(expected))
                for name in expected.dtype.names:
                    np.testing.assert_array_equal(rows[name], expected[name], name)
                self.assertEqual(rows.dtype, hjt.COMPARISON_DTYPE)

    def test_in_parts_is_the_same_as_at_once(self):
        columns = recording()
        whole = hjt.Tracker(hjt.Parameters(ELBOW[0])).follow(*columns)
        tracker = hjt.Tracker(hjt.Parameters(ELBOW[0]))
        parts = [tracker.follow(*[column[begin:begin + 100] for column in columns], at_end=begin + 100 >= len(whole))
                 for begin in range(0, len(whole), 100)]
        np.testing.assert_array_equal(np.concatenate(parts), whole)
        self.assertEqual(tracker.counters["compared"], len(whole))

    def test_bad_arguments_are_named(self):
        tracker = hjt.Tracker(hjt.Parameters(ELBOW[0]))
        time, position, current, _ = recording()
        with self.assertRaisesRegex(hjt.InputError, "position has 3 values in 1 dimensions"):
            tracker.follow(time, position[:3], current)
        with self.assertRaisesRegex(hjt.InputError, "mode = 'commands' must be 'motion', 'torque' or 'observer'"):
            hjt.Tracker(hjt.Parameters(ELBOW[0]), "commands")
        self.assertEqual(len(tracker.follow(time, np.full_like(time, np.nan), current)), 0)
        self.assertEqual(tracker.counters["refused"], len(time))


class Errors(Recordings):
    def test_have_the_words_of_the_tool(self):
        for call, words, *error in (
                (lambda: hjt.check("none.csv"), "none.csv"),
                (lambda: hjt.follow("none.csv"), "joint"),
                (lambda: hjt.follow("none.csv", joint="elbow", mode="backwards"), "mode = 'backwards'"),
                (lambda: hjt.follow({"time": [0.0], "current": [0.0]}, joint="elbow"), "'position'"),
                (lambda: hjt.follow(None, joint="elbow"), "recording = None must be the name of"),
                (lambda: hjt.follow({"time": ["now"], "position": [0.0]}, joint="elbow"),
                 "column 'time' must contain numbers"),
                (lambda: hjt.check({"time": [0.0]}), "'position' are required"),
                (lambda: hjt.follow({"time": [0.0], "position": np.array([0], "M8[s]")}, joint="elbow"),
                 "column 'position' must contain numbers"),
                (lambda: hjt.follow({"time": 0.0}, joint="elbow"), "'time' has 0 dimensions"),
                (lambda: hjt.follow("a.csv", joint="elbow", time_scale="fast"), "time_scale = 'fast' must be a number"),
                (lambda: hjt.identify("a.csv", joint="elbow", train=(1.0,)), "must be a pair of num"),
                (lambda: hjt.indicators("a.csv", columns=["time"]), "columns = ['time'] must be a map"),
                (lambda: hjt.indicators(SILENT, torque_scale=0.0), "torque_scale = 0"),
                (lambda: hjt.indicators(SILENT), "3 samples were ignored, because they have no angle"),
                (lambda: hjt.Arm("ur5", "abc"), "start = 'abc' must be a list of numbers"),
                (lambda: hjt.indicators("a.txt"), "'a.txt' must end in"),
                (lambda: hjt.arm({"time": [0.0], "position": [0.0]}, "ur5"),
                 "motion: set point 1: it has 1 joints, but the arm has 6"),
                (lambda: hjt.arm({"time": [0.0, 0.0], "position": np.zeros((2, 6))}, "ur5"),
                 "motion: set point 2: the time does not increase"),
                (lambda: hjt.arm({"time": [0.0]}, "ur5"), "'position', of shape (rows, joints)"),
                (lambda: hjt.remaining({"time": [0.0]}), "recordings[0]: column 'motor_torque'"),
                (lambda: hjt.remaining("a.csv", hours=0.0), "hours = 0"),
                (lambda: hjt.checkup("ur5", "a.csv", joint="knee"), "has no joint 'knee'", hjt.ParameterError),
                (lambda: hjt.checkup("ur6", "a.csv"), "neither a file nor an arm", hjt.ParameterError),
                (lambda: hjt.checkup("ur5", "a.csv", file_format="txt"), "format = 'txt': txt is not one of {csv,"),
                (lambda: hjt.sweep("no_plan.yaml", "data"), "no_plan.yaml"),
                (lambda: hjt.sweep("no_plan.yaml", "data", jobs=0), "jobs = 0"),
                (lambda: hjt.sweep("no_plan.yaml", "data", shard=(2, 2)), "'2/2' must be I/N with"),
                (lambda: hjt.identify("none.csv", joint="elbow", overlays=[{"mesh.stifness": 1.0}]),
                 "did you mean mesh.stiffness", hjt.ParameterError),
                (lambda: hjt.identify("none.csv", joint="elbow", folds=1), "folds = 1"),
                (lambda: hjt.follow("a.csv", joint="elbow", time_scale=0), "time_scale = 0: '0.0' is not"),
                (lambda: hjt.follow("a.csv", joint="elbow", load="target_moment"), "load requires arm"),
                (lambda: hjt.compare("a.csv", arm="ur5", identified="none"), "does not exist: none"),
                (lambda: hjt.indicators("a.csv", carry=True), "carry requires baseline"),
                (lambda: hjt.remaining("a.csv", lost_motion_limit=0.01), "requires baseline"),
                (lambda: hjt.sweep("no_plan.yaml", "data", jobs=2.5), "jobs = 2.5 must be a whole number")):
            with self.assertRaises(*error or [hjt.InputError]) as caught:
                call()
            self.assertIn(words, str(caught.exception))
            self.assertNotIn("joint_twin:", str(caught.exception))

    def test_what_the_tool_remarks_is_a_warning(self):
        times, angles = motion(5.0)
        write_csv("silent.csv", times, angles, np.zeros_like(angles))
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            hjt.identify("silent.csv", joint="elbow", overlays=ELBOW[:1])
        texts = [str(warning.message) for warning in caught]
        self.assertTrue(any("holds no load of the joint" in text for text in texts), texts)
        self.assertEqual({warning.filename for warning in caught}, {__file__})

    def test_a_load_that_is_left_out_is_a_warning_of_arrays_too(self):
        times, angles = motion(5.0)
        columns = {"time": times, "position": angles[:, 2], "current": np.ones_like(times)}
        without = hjt.follow(columns, joint="elbow")
        with self.assertWarnsRegex(RuntimeWarning, r"holds a load \(load\)"):
            found = hjt.follow({**columns, "load": np.ones_like(times)}, joint="elbow")
        self.assertEqual(found["current_residual_rms"], without["current_residual_rms"])

    def test_an_existing_file_is_kept(self):
        hjt.checkup("ur5", "a.csv", joint="base")
        with self.assertRaisesRegex(hjt.InputError, "a.csv"):
            hjt.checkup("ur5", "a.csv", joint="base")
        hjt.checkup("ur5", "a.csv", joint="base", force=True)


class Interrupts(Recordings):
    def plan(self):
        with open("plan.yaml", "w", encoding="utf-8") as file:
            file.write(PLAN.replace("duration: 0.3", "duration: 200.0"))

    def test_ctrl_c_gets_through_and_python_has_its_threads_and_its_handler(self):
        self.plan()
        before = signal.getsignal(signal.SIGINT)
        ticks, stop = [], threading.Event()

        def tick():
            while not stop.wait(0.01):
                hjt.checkup("ur5", "motion.csv", joint="base", force=True)
                ticks.append(1)

        thread = threading.Thread(target=tick)
        thread.start()
        threading.Timer(2.0, os.kill, (os.getpid(), signal.SIGINT)).start()
        start = time.monotonic()
        with self.assertRaises(KeyboardInterrupt):
            hjt.sweep("plan.yaml", "data", overlays=[{"solver.scene": "full_ring"}])
        self.assertLess(time.monotonic() - start, 60.0)
        stop.set()
        thread.join()
        self.assertGreater(len(ticks), 20)
        self.assertIs(signal.getsignal(signal.SIGINT), before)
        with self.assertRaises(KeyboardInterrupt):
            os.kill(os.getpid(), signal.SIGINT)
            time.sleep(1.0)

    def test_an_error_of_progress_ends_a_sweep(self):
        self.plan()

        def fail(step, done):
            raise ZeroDivisionError

        with self.assertRaises(ZeroDivisionError):
            hjt.sweep("plan.yaml", "data", overlays=[{"solver.scene": "full_ring"}], progress=fail)

    def test_ctrl_c_ends_a_reading(self):
        times, angles = motion(2000.0)
        columns = {"time": times, "position": angles, "current": np.zeros_like(angles)}
        for function in (lambda: hjt.follow(columns, arm="ur5"), lambda: hjt.check(columns)):
            threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT)).start()
            with self.assertRaises(KeyboardInterrupt):
                for _ in range(100):
                    function()


class Names(unittest.TestCase):
    def test_have_types_and_docstrings(self):
        from harmonic_joint_twin import _commands
        for name in _commands.__all__:
            function = getattr(hjt, name)
            self.assertIn("Returns" if name != "lives" else "result", inspect.getdoc(function), name)
            for parameter in inspect.signature(function).parameters.values():
                self.assertIsNot(parameter.annotation, inspect.Parameter.empty, name)


if __name__ == "__main__":
    unittest.main(verbosity=2)
