#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""The twin from Python: the tool's numbers, blocks, views, threads, interrupts. Argument: the tool."""
import copy
import gc
import math
import os
import pickle
import subprocess
import sys
import tempfile
import threading
import unittest
import warnings

import genpy
import numpy as np
import rosbag
from sensor_msgs.msg import JointState

import harmonic_joint_twin as hjt
from interrupted import interrupted

TOOL = sys.argv.pop(1)
STEPS = 400
START = 1000000000  # [s] ROS time of the first row
JOINT = "elbow_joint"
PERIOD = 8        # of the rows [ms]
ROWS = 40
NAMES = {"motor_angle_true": "motor_angle", "output_angle_true": "output_angle"}  # of ~encoders, of the outputs


def course(steps=STEPS):
    return 0.4 * np.sin(2.0 * math.pi * np.arange(steps) / 200.0)


def rows():
    """Motor torque and load of each row [N.m]: both change in every one, and the motor turns round."""
    row = np.arange(ROWS)
    return 0.6 * np.sin(2.0 * np.pi * row / 25.0), 20.0 + 15.0 * np.cos(2.0 * np.pi * row / 17.0)


class Run(unittest.TestCase):
    def test_gives_the_numbers_of_the_tool(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "run.csv")
            subprocess.run([TOOL, "simulate", "--torque", "0.35", "--load", "20", "--duration", "0.1", "--fault",
                            "tooth_wear:0.3:20", "--set", "thermal.model=two_nodes", "--out", path],
                           stdout=subprocess.DEVNULL, check=True)
            simulated = np.genfromtxt(path, delimiter=",", names=True)
        parameters = hjt.Parameters({"thermal.model": "two_nodes"})
        parameters.faults = ["tooth_wear:0.3:20"]
        twin = hjt.Twin(parameters)
        # As the tool: some times depend on the stamp, such as those of the heat.
        twin.reset(1000000000000000000)
        rows = twin.run(1000, motor_torque=0.35, load_torque=20.0, every=10)
        self.assertEqual(len(rows), len(simulated))
        self.assertEqual(len(rows), 100)
        for name in simulated.dtype.names:
            if name != "time":
                np.testing.assert_array_equal(rows[name], simulated[name], name)
        np.testing.assert_allclose(rows["stamp"] - 10**18, 1e9 * simulated["time"], atol=0.5)

    def test_in_blocks_is_the_same_as_in_steps(self):
        blocks = hjt.Twin(hjt.Parameters())
        rows = np.concatenate([blocks.run(motor_torque=part, load_torque=5.0) for part in np.split(course(), 4)])
        steps = hjt.Twin(hjt.Parameters())
        steps.command_load_torque(5.0)
        for row, torque in zip(rows, course()):
            steps.command_motor_torque(torque)
            steps.step()
            self.assertEqual(steps.outputs, row)
        self.assertEqual(steps.stamp, blocks.stamp)

    def test_goes_on_in_a_copy(self):
        twin = hjt.Twin(hjt.Parameters({"thermal.model": "two_nodes", "sensors.motor_noise": 1e-4}))
        twin.watch_signals = True
        twin.inject_fault("tooth_wear:0.3:20:0.02")
        twin.run(100, motor_torque=0.35)
        copies = copy.copy(twin), copy.deepcopy(twin)
        rows = twin.run(motor_torque=course(), load_torque=5.0)
        del twin
        for each in copies:
            np.testing.assert_array_equal(each.run(motor_torque=course(), load_torque=5.0), rows)
            self.assertEqual([(fault.severity, fault.place) for fault in each.active_faults], [(0.3, 20)])

    def test_that_is_pickled_is_an_error_with_a_way_out(self):
        with self.assertRaisesRegex(TypeError, r"copy\.copy\(twin\) copies its state within this process"):
            pickle.dumps(hjt.Twin(hjt.Parameters()))

    def test_to_a_time_ends_at_the_last_instant_before(self):
        twin = hjt.Twin(hjt.Parameters())
        rows = twin.run_to(0.01005, motor_torque=0.1, every=10)
        self.assertEqual(len(rows), 10)
        self.assertEqual(twin.stamp, 10000000)
        self.assertEqual(twin.time, 0.01)
        self.assertEqual(len(twin.run_to(0.01)), 0)
        with self.assertRaisesRegex(hjt.InputError, r"time = 0.005 \[s\] is out of range"):
            twin.run_to(0.005)

    def test_rows_are_plain_numpy(self):
        twin = hjt.Twin(hjt.Parameters())
        rows = twin.run(10, motor_torque=0.2)
        self.assertEqual(rows.dtype, hjt.STEP_DTYPE)
        self.assertTrue(rows.flags.owndata and rows.flags.writeable)
        self.assertEqual(rows.shape, (10,))
        np.testing.assert_array_equal(rows["stamp"], 100000 * np.arange(1, 11))
        self.assertTrue(rows["converged"].all() and not rows["brake"].any())
        self.assertEqual(twin.run(10, every=20).shape, (0,))

    def test_rows_are_written_where_the_user_wants(self):
        twin, other = hjt.Twin(hjt.Parameters()), hjt.Twin(hjt.Parameters())
        rows = np.zeros(10, hjt.STEP_DTYPE)
        self.assertIs(twin.run(10, motor_torque=0.2, out=rows), rows)
        np.testing.assert_array_equal(rows, other.run(10, motor_torque=0.2))
        for bad in np.zeros(9, hjt.STEP_DTYPE), np.zeros(10), np.zeros(20, hjt.STEP_DTYPE)[::2]:
            with self.assertRaisesRegex(hjt.InputError, "^out "):
                twin.run(10, out=bad)

    def test_the_brake_acts_after_its_delay(self):
        twin = hjt.Twin(hjt.Parameters({"brake.delay": 0.001}))
        rows = twin.run(30, brake=1)
        self.assertEqual(list(np.flatnonzero(rows["brake"])), list(range(10, 30)))

    def test_inputs_act(self):
        twin = hjt.Twin(hjt.Parameters())
        rows = twin.run(20, motor_torque=0.2, load_torque=np.linspace(0.0, 19.0, 20),
                        brake=np.arange(20) >= 10, temperature=40)
        np.testing.assert_array_equal(rows["load_torque"], np.arange(20.0))
        self.assertTrue((rows["temperature"] == 40.0).all())
        self.assertEqual(rows["brake"].sum(), 10)
        # Without a torque the last command holds until it times out.
        late = twin.run(3000)
        self.assertEqual(late["motor_torque"][0], 0.2)
        self.assertEqual(late["motor_torque"][-1], 0.0)
        self.assertEqual(twin.counters["command_timeouts"], 1)

    def test_bad_inputs_are_refused_before_the_first_step(self):
        twin = hjt.Twin(hjt.Parameters())
        for arguments, words in (
                ({"motor_torque": [0.1, float("nan")]}, r"motor_torque\[1\] = \.nan is not a finite number"),
                ({"load_torque": float("inf"), "steps": 3}, r"load_torque = \.inf is not a finite number"),
                ({"motor_torque": np.zeros(5), "steps": 6}, "motor_torque has 5 values for 6 steps"),
                ({"motor_torque": np.zeros(5), "load_torque": np.zeros(4)}, "load_torque has 4 values for 5 steps"),
                ({"motor_torque": np.zeros((5, 2))}, r"motor_torque has 2 dimensions"),
                ({"motor_torque": "much", "steps": 3}, "motor_torque must be a number or an array"),
                ({"motor_torque": np.array([1j])}, "motor_torque must be a number or an array"),
                ({"motor_torque": np.array([0], "M8[s]")}, "motor_torque must be a number or an array"),
                ({"motor_torque": 0.1}, "steps is missing"),
                ({"temperature": -300.0, "steps": 3}, r"temperature = -300\.0 \[degC\] is out of range, allowed: -40"),
                ({"load_torque": [0.0, 1e7]}, r"load_torque\[1\] = .* \[N.m\] is out of range, allowed: -284"),
                ({"brake": 2, "steps": 3}, r"brake = 2\.0 \[-\] is out of range, allowed: 0"),
                ({"steps": -1}, "steps = -1"), ({"steps": 5, "every": 0}, "every = 0")):
            with self.assertRaisesRegex(hjt.InputError, words):
                twin.run(**arguments)
        with self.assertRaisesRegex(hjt.InputError, r"torque = \.nan is not a finite number"):
            twin.command_motor_torque(float("nan"))
        for call, value in (twin.command_load_torque, 1e7), (twin.set_temperature, -300.0):
            with self.assertRaisesRegex(hjt.InputError, "is out of range, allowed: -"):
                call(value)
        with self.assertRaisesRegex(hjt.ParameterError, "severity = 3"):
            twin.inject_fault("tooth_wear:3:1")
        for stamp in (2**63 - 1, -2**63):
            with self.assertRaisesRegex(hjt.InputError, rf"stamp = {stamp} \[ns\] is out of range"):
                twin.inject_fault("tooth_wear:1:1:2", stamp=stamp)
            with self.assertRaisesRegex(hjt.InputError, rf"stamp = {stamp} \[ns\] is out of range"):
                twin.reset(stamp)
        self.assertEqual(twin.active_faults, [])
        self.assertEqual(twin.stamp, 0)
        self.assertEqual(twin.counters["steps"], 0)

    def test_faults_set_in(self):
        twin = hjt.Twin(hjt.Parameters())
        twin.inject_fault(hjt.Fault("tooth_wear", 1.0, 20, onset=0.001))
        twin.run(9)
        self.assertEqual(twin.active_faults, [])
        twin.run(1)
        self.assertEqual([fault.kind for fault in twin.active_faults], ["tooth_wear"])
        twin.reset()
        self.assertEqual(twin.active_faults, [])
        self.assertEqual(twin.stamp, 0)


class InputTimes(unittest.TestCase):
    """One law for the time of an input: the same rows give the same bits as a profile of the tool, as arrays, as
    stamped commands and as a bag. (The co-simulation unit is compared with a profile in test/tool/fmu_test.py, the
    live node with a bag in test/ros/replay_test.py.)"""

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def run_tool(self, *arguments):
        subprocess.run([TOOL, *arguments], stdout=subprocess.DEVNULL, check=True)

    def profile(self, scene):
        """Columns of the tool's run of the rows, one a millisecond."""
        torque, load = rows()
        with open(self.path("profile.csv"), "w", encoding="ascii") as file:
            file.write("time,motor_torque,load_torque\n")
            for row in range(ROWS):
                file.write(f"{1e-3 * PERIOD * row!r},{float(torque[row])!r},{float(load[row])!r}\n")
        self.run_tool("simulate", "--profile", self.path("profile.csv"), "--set", f"solver.scene={scene}", "--out",
                      self.path("run.csv"), "--force")
        return np.genfromtxt(self.path("run.csv"), delimiter=",", names=True)

    @staticmethod
    def twin(scene):
        twin = hjt.Twin(hjt.Parameters({"solver.scene": scene}))
        twin.reset(START * 10**9)
        return twin

    def assert_same(self, found, expected):
        self.assertGreater(np.ptp(expected["motor_angle"]), 1.0)
        self.assertLess(np.min(np.diff(expected["motor_angle"])), 0.0)
        for name in NAMES.values():
            np.testing.assert_array_equal(found[name], expected[name][:len(found[name])], name)

    def test_arrays_are_the_rows_of_a_profile(self):
        for scene in "auto", "full_ring":
            expected = self.profile(scene)
            twin = self.twin(scene)
            held = PERIOD * 10**6 // twin.step_length  # steps
            torque, load = (np.repeat(each, held)[:held * (ROWS - 1)] for each in rows())
            self.assert_same(twin.run(motor_torque=torque, load_torque=load, every=held // PERIOD), expected)

    def test_stamped_commands_are_the_rows_of_a_profile(self):
        """Commands that come a row ahead, in the order load, torque."""
        expected = self.profile("auto")
        twin = self.twin("auto")
        found = []
        torque, load = rows()
        for row in range(ROWS - 1):
            stamp = START * 10**9 + PERIOD * 10**6 * row
            twin.command_load_torque(float(load[row]), stamp=stamp)
            twin.command_motor_torque(float(torque[row]), stamp=stamp)
            found.append(twin.run(PERIOD * 10**6 // twin.step_length, every=10**6 // twin.step_length))
        self.assert_same(np.concatenate(found), expected)

    def test_a_bag_is_the_rows_of_a_profile(self):
        """By the stamps of its messages; they are recorded later."""
        expected = self.profile("auto")
        torque, load = rows()
        with rosbag.Bag(self.path("in.bag"), "w") as bag:
            for row in range(ROWS):
                stamp = genpy.Time(START) + genpy.Duration(0, PERIOD * 10**6 * row)
                for topic, value in ("load", load[row]), ("command", torque[row]):
                    message = JointState(name=[JOINT], effort=[value])
                    message.header.stamp = stamp
                    bag.write(f"/joint_twin/{topic}", message, stamp + genpy.Duration(0, 3 * 10**6))
        self.run_tool("replay", self.path("in.bag"), "--out", self.path("out.bag"), "--set", f"joint.name={JOINT}",
                      "--set", "solver.scene=auto")
        with rosbag.Bag(self.path("out.bag")) as bag:
            encoders = [message for _, message, _ in bag.read_messages(["/joint_twin/encoders"])]
        self.assertGreater(len(encoders), PERIOD * (ROWS - 1) - 2)
        self.assertEqual(encoders[0].header.stamp, genpy.Time(START, 10**6))
        self.assert_same({name: np.array([getattr(message, field) for message in encoders[:PERIOD * (ROWS - 1)]])
                          for field, name in NAMES.items()}, expected)


class Teeth(unittest.TestCase):
    def test_forces_are_views_that_the_next_call_overwrites(self):
        twin = hjt.Twin(hjt.Parameters())
        twin.run(100, motor_torque=0.3, load_torque=30.0)
        forces = twin.tooth_forces()
        mesh = forces.mesh_force
        self.assertEqual(mesh.shape, (200,))
        self.assertFalse(mesh.flags.owndata or mesh.flags.writeable)
        kept = forces.copy()
        first = mesh.copy()
        twin.run(1000, motor_torque=0.3, load_torque=30.0)
        np.testing.assert_array_equal(mesh, first)
        self.assertIs(twin.tooth_forces(), forces)
        self.assertFalse(np.array_equal(mesh, first))
        np.testing.assert_array_equal(kept.mesh_force, first)
        # The memory lives as long as the array.
        last = mesh.copy()
        del twin, forces
        gc.collect()
        np.testing.assert_array_equal(mesh, last)
        self.assertEqual(np.count_nonzero(mesh), np.count_nonzero(last))

    def test_forces_carry_the_load(self):
        parameters = hjt.Parameters()
        twin = hjt.Twin(parameters)
        twin.run(2000, motor_torque=0.4, load_torque=30.0)
        self.assertEqual(twin.health().teeth_loaded, np.count_nonzero(twin.tooth_forces().mesh_force))
        stress = twin.tooth_stress()
        self.assertEqual(stress.flange.shape, (200,))
        cycle = stress.cycle("flange")
        self.assertEqual(cycle.highest, stress.flange.max())
        self.assertEqual(abs(stress.flange[stress.worst_tooth("flange")]), abs(stress.flange).max())
        with self.assertRaisesRegex(hjt.InputError, "must be one of 'tooth space', 'transition', 'flange'"):
            stress.cycle("bore")


class Health(unittest.TestCase):
    def test_indicators_and_assessment_come_with_the_windows(self):
        twin = hjt.Twin(hjt.Parameters({"solver.scene": "auto"}))
        self.assertFalse(twin.watch_signals)
        twin.watch_signals = True
        self.assertEqual(twin.assessment.state, "WAITING")
        twin.run(60000, motor_torque=0.45, load_torque=20.0, every=60000)
        self.assertTrue(twin.on_surface)
        indicators = twin.signal_indicators
        self.assertGreater(indicators.windows, 0)
        self.assertEqual(list(indicators.values), list(hjt.indicator_units()))
        self.assertTrue(math.isfinite(indicators.values["running_torque"]))
        self.assertEqual(twin.assessment.level, "OK")
        self.assertEqual(twin.assessment.windows, indicators.windows)
        self.assertAlmostEqual(twin.health().transmission_ratio, 101.0, delta=0.5)


class Threads(unittest.TestCase):
    def test_one_gets_on_while_another_is_within_its_block(self):
        busy, other = hjt.Twin(hjt.Parameters()), hjt.Twin(hjt.Parameters())
        thread = threading.Thread(target=lambda: busy.run(30000, motor_torque=0.3, every=30000))
        thread.start()
        blocks = 0
        while thread.is_alive():
            other.run(100, motor_torque=0.3, every=100)
            blocks += 1
        thread.join()
        # Alone the first takes as long as 300 blocks of the other.
        self.assertGreater(blocks, 30)

    def test_a_twin_that_runs_refuses_other_threads(self):
        twin = hjt.Twin(hjt.Parameters())
        thread = threading.Thread(target=lambda: twin.run(20000, motor_torque=0.3))
        thread.start()
        refused = False
        while thread.is_alive():
            try:
                twin.health()
            except RuntimeError as error:
                self.assertIn("is being run by another thread", str(error))
                refused = True
        thread.join()
        self.assertTrue(refused)
        self.assertEqual(twin.counters["steps"], 20000)

    def test_an_interrupt_gets_through(self):
        program = ("import harmonic_joint_twin as hjt\n"
                   "twin = hjt.Twin(hjt.Parameters())\n"
                   "print('ready', flush=True)\n"
                   "try:\n"
                   "    twin.run(10**9, motor_torque=0.1, every=10**9)\n"
                   "except KeyboardInterrupt:\n"
                   "    steps = twin.counters['steps']\n"
                   "    twin.run(10)\n"
                   "    print('interrupted', steps, twin.counters['steps'] - steps)\n")
        words = interrupted(self, program)
        self.assertEqual(words[0], "interrupted")
        self.assertGreater(int(words[1]), 0)
        self.assertEqual(int(words[2]), 10)


class Surface(unittest.TestCase):
    def test_progress_is_told_and_may_end_it(self):
        parameters = hjt.Parameters({"solver.scene": "auto"})
        with self.assertRaises(ZeroDivisionError):
            hjt.Twin(parameters, cache="", progress=lambda done: 1 / 0)

    def test_a_cache_that_cannot_be_written_is_a_warning(self):
        parameters = hjt.Parameters({"solver.scene": "auto"})
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            done = []
            hjt.Twin(parameters, cache="/proc/no/such/folder", progress=done.append)
        self.assertEqual(done, sorted(done))
        self.assertEqual(done[-1], 1.0)
        self.assertTrue(any("/proc/no/such/folder" in str(warning.message) for warning in caught),
                        [str(warning.message) for warning in caught])


if __name__ == "__main__":
    unittest.main(verbosity=2)
