#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Batches of twins: numbers of single twins, faults and failures of each, threads, interrupts. Argument: the tool."""
import copy
import math
import os
import pickle
import signal
import sys
import threading
import time
import unittest

import numpy as np

import harmonic_joint_twin as hjt
from interrupted import interrupted

del sys.argv[1]
STEPS = 300


def torques(count, steps=STEPS):
    """Another course for each twin [N.m]."""
    phase = np.arange(steps) / 100.0 + np.arange(count)[:, None] / 3.0
    return 0.4 * np.sin(2.0 * math.pi * phase)


def several():
    """Parameters that differ in gear, faults, options and scene."""
    worn = hjt.Parameters({"thermal.model": "two_nodes"})
    worn.faults = ["tooth_wear:0.3:20"]
    return [hjt.Parameters({"solver.scene": "auto"}), worn, hjt.Parameters({"sensors.motor_noise": 1e-4}),
            hjt.Parameters("joints/elbow.yaml"), hjt.Parameters({"solver.scene": "auto", "output.load_inertia": 2.0})]


class Numbers(unittest.TestCase):
    def test_are_those_of_single_twins(self):
        parameters = several()
        loads = np.linspace(0.0, 20.0, len(parameters))[:, None]
        course = torques(len(parameters))
        alone = [hjt.Twin(each).run(motor_torque=torque, load_torque=load[0], brake=np.arange(STEPS) > 250, every=7)
                 for each, torque, load in zip(parameters, course, loads)]
        for threads in 1, 2, 3:
            batch = hjt.TwinBatch(parameters, threads=threads)
            self.assertEqual(batch.threads, threads)
            self.assertEqual(len(batch), len(parameters))
            rows = batch.run(motor_torque=course, load_torque=loads, brake=np.arange(STEPS) > 250, every=7)
            self.assertEqual(rows.shape, (len(parameters), STEPS // 7))
            np.testing.assert_array_equal(rows, np.stack(alone))
            np.testing.assert_array_equal(batch.counters["steps"], np.full(len(parameters), STEPS))

    def test_of_a_loop_are_those_of_a_run(self):
        parameters = hjt.Parameters({"solver.scene": "auto", "brake.delay": 0.005})
        loop, run = hjt.TwinBatch(parameters, 5), hjt.TwinBatch(parameters, 5)
        course = torques(5)
        brake = np.arange(5) < 2
        rows = loop.outputs
        for place in range(0, STEPS, 10):
            self.assertIs(loop.step(course[:, place], 3.0, brake, steps=10, out=rows), rows)
            np.testing.assert_array_equal(rows, run.run(10, motor_torque=course[:, place:place + 1], load_torque=3.0,
                                                        brake=brake[:, None])[:, -1])
        np.testing.assert_array_equal(loop.outputs, rows)
        self.assertTrue(rows["on_surface"].all())
        # Told again every millisecond, the brake engages after its delay.
        np.testing.assert_array_equal(rows["brake"], brake)
        np.testing.assert_array_equal(loop.step(), [loop[i].outputs for i in range(5)])

    def test_one_course_and_one_number_are_for_all(self):
        batch, other = (hjt.TwinBatch(hjt.Parameters(), 3) for _ in range(2))
        course = torques(1)[0]
        np.testing.assert_array_equal(batch.run(motor_torque=course, load_torque=2.0),
                                      other.run(motor_torque=np.tile(course, (3, 1)), load_torque=np.full((3, 1), 2.0)))


class Making(unittest.TestCase):
    def test_copies_of_a_twin_go_on_from_its_instant(self):
        twin = hjt.Twin(hjt.Parameters())
        twin.run(100, motor_torque=0.3)
        batch = hjt.TwinBatch(twin, 3)
        rows = batch.run(50, motor_torque=0.2)
        self.assertEqual(twin.counters["steps"], 100)
        expected = twin.run(50, motor_torque=0.2)
        for row in rows:
            np.testing.assert_array_equal(row, expected)

    def test_twins_are_taken_as_they_are(self):
        twins = [hjt.Twin(hjt.Parameters()) for _ in range(2)]
        batch = hjt.TwinBatch(twins + [hjt.Parameters()])
        batch.step(0.1)
        self.assertIs(batch[1], twins[1])
        self.assertIs(batch[-3], twins[0])
        self.assertEqual([each.counters["steps"] for each in batch], [1, 1, 1])
        self.assertEqual(twins[0].counters["steps"], 1)
        saved = hjt.TwinBatch([copy.copy(each) for each in batch])
        np.testing.assert_array_equal(saved.step(0.2), batch.step(0.2))
        for made in copy.copy, pickle.dumps:
            with self.assertRaisesRegex(TypeError, r"TwinBatch\(\[copy\.copy\(twin\) for twin in batch\]\)"):
                made(batch)
        for place in 3, -4:
            with self.assertRaises(IndexError):
                batch[place]

    def test_equal_surfaces_are_built_once(self):
        told = []
        parameters = [hjt.Parameters({"solver.scene": "auto", "output.load_inertia": value}) for value in (1.0, 2.0)]
        batch = hjt.TwinBatch(parameters, cache="", progress=told.append)
        self.assertEqual(told, sorted(told))
        self.assertGreater(sum(share < 0.5 for share in told), 2)
        self.assertEqual([share for share in told if share > 0.5], [1.0])
        self.assertTrue(batch.step()["on_surface"].all())

    def test_mistakes_are_named(self):
        shipped, twin = hjt.Parameters(), hjt.Twin(hjt.Parameters())
        for error, arguments, words in (
                (hjt.InputError, {"twins": shipped}, "n, the number of twins, is missing"),
                (hjt.InputError, {"twins": [shipped], "n": 1}, "n is only allowed with one Parameters or one Twin"),
                (hjt.InputError, {"twins": shipped, "n": 0}, r"n = 0 \[-\] is out of range"),
                (hjt.InputError, {"twins": []}, "twins has no items"),
                (hjt.InputError, {"twins": [shipped], "threads": 0}, r"threads = 0 \[-\] is out of range"),
                (hjt.InputError, {"twins": [twin, shipped, twin]}, r"twins\[2\] is the same Twin as twins\[0\]"),
                (hjt.InputError, {"twins": [shipped, hjt.Parameters({"solver.rate": 20e3})]},
                 r"twins\[1\] steps by 50000 ns, twins\[0\] by 100000 ns \(solver.rate\)"),
                (hjt.ParameterError, {"twins": [shipped, hjt.Parameters({"contact.law": "polar"})]},
                 r"twins\[1\]: contact.law = polar"),
                (TypeError, {"twins": [shipped, "elbow"]}, r"twins\[1\] is a str, expected: Parameters or Twin"),
                (TypeError, {"twins": 5}, "not iterable")):
            with self.assertRaisesRegex(error, words):
                hjt.TwinBatch(**arguments)
        with self.assertRaises(ZeroDivisionError):
            hjt.TwinBatch(shipped, 2, progress=lambda share: 1 / 0)


class Inputs(unittest.TestCase):
    def test_bad_ones_are_refused_before_the_first_step(self):
        batch = hjt.TwinBatch(hjt.Parameters(), 3)
        nan = float("nan")
        for call, arguments, words in (
                (batch.step, {"motor_torque": np.zeros(4)}, "motor_torque has 4 values for 3 twins"),
                (batch.step, {"motor_torque": np.zeros((3, 1))},
                 r"motor_torque has 2 dimensions, allowed: a number, or an array of shape \(twins,\)"),
                (batch.step, {"load_torque": [0.0, nan, 0.0]}, r"load_torque\[1\] = \.nan is not a finite number"),
                (batch.step, {"brake": "on"}, "brake must be a number or an array"),
                (batch.step, {"steps": 0}, r"steps = 0 \[-\] is out of range"),
                (batch.step, {"out": np.zeros(4, hjt.STEP_DTYPE)},
                 r"out has shape \(4,\), expected: \(3,\), writeable"),
                (batch.run, {"motor_torque": 0.1}, "steps is missing"),
                (batch.run, {"motor_torque": np.zeros((3, 1))}, "steps is missing"),
                (batch.run, {"motor_torque": np.zeros(3), "steps": 5}, "motor_torque has 3 values for 5 steps"),
                (batch.run, {"motor_torque": np.zeros((2, 5))}, "motor_torque has 2 values for 3 twins"),
                (batch.run, {"motor_torque": np.zeros((3, 5)), "load_torque": np.zeros((3, 4))},
                 "load_torque has 4 values for 5 steps"),
                (batch.run, {"temperature": [[20.0, 20.0], [20.0, nan], [20.0, 20.0]]},
                 r"temperature\[1, 1\] = \.nan is not a finite number"),
                (batch.run, {"motor_torque": np.zeros((1, 3, 5))}, "motor_torque has 3 dimensions"),
                (batch.run, {"steps": 6, "out": np.zeros((6, 3), hjt.STEP_DTYPE).T}, "out must be contiguous")):
            with self.assertRaisesRegex(hjt.InputError, words):
                call(**arguments)
        np.testing.assert_array_equal(batch.counters["steps"], [0, 0, 0])


class Each(unittest.TestCase):
    def test_has_its_own_faults(self):
        parameters = hjt.Parameters()
        batch = hjt.TwinBatch(parameters, 3)
        batch[1].inject_fault("tooth_wear:0.5:20:0.01")
        rows = batch.run(STEPS, motor_torque=0.35)
        self.assertEqual([len(twin.active_faults) for twin in batch], [0, 1, 0])
        alone = hjt.Twin(parameters)
        np.testing.assert_array_equal(rows[0], alone.run(STEPS, motor_torque=0.35))
        alone.reset()
        alone.inject_fault("tooth_wear:0.5:20:0.01")
        np.testing.assert_array_equal(rows[1], alone.run(STEPS, motor_torque=0.35))
        self.assertFalse(np.array_equal(rows[0], rows[1]))
        np.testing.assert_array_equal(rows[0], rows[2])

    def test_restarts_alone(self):
        batch = hjt.TwinBatch(hjt.Parameters(), 2)
        first = batch.step(0.3, steps=20)
        batch[0].reset()
        again = batch.step(0.3, steps=20)
        self.assertEqual(again[0], first[0])
        self.assertEqual(again["stamp"][1], 2 * first["stamp"][1])

    def test_that_fails_is_named_and_the_others_go_on(self):
        # A tooth of this soft gear jumps; one iteration and no shorter path leave no way across.
        soft = hjt.Parameters("golden.yaml", {
            "contact.stiffness": 1e6, "ring.tension_stiffness": 5e7, "mesh.flank_angle": 1.0,
            "mesh.engagement_depth": 200e-6, "output.load_torque_limit": 1000.0, "solver.max_iterations": 1,
            "solver.max_step_cuts": 0})
        shipped = hjt.Parameters()
        batch = hjt.TwinBatch([shipped, soft, shipped])
        rows = batch.run(500, motor_torque=0.2, load_torque=[[10.0], [600.0], [10.0]])
        np.testing.assert_array_equal(rows["converged"].all(axis=1), [True, False, True])
        np.testing.assert_array_equal(batch.counters["solver_failures"], (~rows["converged"]).sum(axis=1))
        self.assertEqual([twin.health().solver_state for twin in batch], ["OK", "FAILED", "OK"])
        np.testing.assert_array_equal(rows[2], hjt.Twin(shipped).run(500, motor_torque=0.2, load_torque=10.0))


class Threads(unittest.TestCase):
    def test_share_the_work(self):
        batch = hjt.TwinBatch(hjt.Parameters(), 16, threads=2)
        own, all_threads = time.thread_time(), time.process_time()
        batch.step(0.3, steps=1000)
        own, all_threads = time.thread_time() - own, time.process_time() - all_threads
        print(f"share of the other thread: {1.0 - own / all_threads:.2f}")
        # On a busy machine less than half, but not a third of it.
        self.assertGreater(1.0 - own / all_threads, 0.17)

    def test_of_others_get_on_and_are_refused(self):
        batch = hjt.TwinBatch(hjt.Parameters(), 4)
        thread = threading.Thread(target=lambda: batch.step(0.3, steps=8000))
        thread.start()
        refused, rounds = set(), 0
        while thread.is_alive():
            rounds += 1
            for name, call in (("batch", lambda: batch.step(0.1)), ("twin", lambda: batch[3].run(1))):
                try:
                    call()
                except RuntimeError as error:
                    self.assertIn("this twin is being run by another thread", str(error))
                    refused.add(name)
        thread.join()
        self.assertEqual(refused, {"batch", "twin"})
        self.assertGreater(rounds, 30)
        batch.step(0.1)

    def test_stay_behind_in_a_fork(self):
        batch = hjt.TwinBatch(hjt.Parameters(), 4, threads=2)
        batch.step(0.1, steps=20)
        child = os.fork()
        if child == 0:
            rows = batch.step(0.2, steps=20)
            del batch
            os._exit(0 if rows["converged"].all() else 1)
        end = time.monotonic() + 60.0
        found, status = os.waitpid(child, os.WNOHANG)
        while found == 0 and time.monotonic() < end:
            time.sleep(0.01)
            found, status = os.waitpid(child, os.WNOHANG)
        if found == 0:
            os.kill(child, signal.SIGKILL)
            os.waitpid(child, 0)
        self.assertEqual((found, status), (child, 0))
        batch.step(0.2, steps=20)

    def test_an_interrupt_leaves_all_at_the_same_step(self):
        program = ("import harmonic_joint_twin as hjt\n"
                   "batch = hjt.TwinBatch(hjt.Parameters(), 5)\n"
                   "print('ready', flush=True)\n"
                   "try:\n"
                   "    batch.step(0.1, steps=10**9)\n"
                   "except KeyboardInterrupt:\n"
                   "    steps = set(batch.counters['steps'])\n"
                   "    batch.step(steps=10)\n"
                   "    print('interrupted', len(steps), steps.pop(), set(batch.counters['steps']).pop())\n")
        words = interrupted(self, program)
        self.assertEqual(words[:2], ["interrupted", "1"])
        self.assertGreater(int(words[2]), 0)
        self.assertEqual(int(words[3]) - int(words[2]), 10)


class Progress(unittest.TestCase):
    def test_of_a_run_is_told_and_may_end_it(self):
        for made in hjt.Twin(hjt.Parameters()), hjt.TwinBatch(hjt.Parameters(), 2):
            told = []
            made.run(20000, motor_torque=0.3, every=20000, progress=told.append)
            self.assertEqual(told, sorted(told))
            self.assertGreater(len(told), 1)
            self.assertGreater(told[0], 0.0)
            self.assertEqual(told[-1], 1.0)
            with self.assertRaises(ZeroDivisionError):
                made.run(10**8, every=10**8, progress=lambda share: 1 / 0)


if __name__ == "__main__":
    unittest.main(verbosity=2)
