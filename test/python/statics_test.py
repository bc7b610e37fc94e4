#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""The static analyses from Python give the tool's numbers. Argument: the tool."""
import gc
import json
import math
import os
import subprocess
import sys
import tempfile
import unittest

import numpy as np

import harmonic_joint_twin as hjt

TOOL = sys.argv.pop(1)
PLACES = ("tooth space", "transition", "flange")


def tool(*arguments):
    done = subprocess.run([TOOL, *map(str, arguments), "--json"], stdout=subprocess.PIPE, check=True)
    return json.loads(done.stdout)


class Statics(unittest.TestCase):
    def setUp(self):
        self.parameters = hjt.Parameters()

    def test_insertion(self):
        expected = tool("insert")
        result = hjt.analyse_insertion(self.parameters)
        for name in ("wave_generator_force_max", "wave_generator_force_sum", "teeth_in_contact", "tension_min",
                     "radius_major_axis", "radius_minor_axis", "bending_force_max"):
            self.assertEqual(getattr(result, name), expected[name], name)
        radius = result.teeth.radius
        self.assertEqual(radius[0], result.radius_major_axis)
        self.assertFalse(radius.flags.owndata or radius.flags.writeable)
        del result
        gc.collect()
        self.assertEqual(radius[0], expected["radius_major_axis"])

    def test_stiffness_and_stress(self):
        expected = tool("stiffness", "--torques", "5,48", "--angle", "0.1", "--teeth")["rows"]
        rows = hjt.analyse_stiffness(self.parameters, [5.0, 48.0], angle=0.1)
        for row, wanted in zip(rows, expected):
            for name in ("torque", "output_angle", "wave_generator_torque", "housing_torque", "cup_rotation",
                         "teeth_loaded", "mesh_force_max", "residual"):
                self.assertEqual(getattr(row, name), wanted[name], name)
            for name, values in wanted["teeth"].items():
                np.testing.assert_array_equal(getattr(row.teeth, name), values, name)
            for place in PLACES:
                cycle = row.stress.cycle(place)
                self.assertEqual(cycle.highest, wanted["stress"][place]["highest"])
                self.assertEqual(hjt.endurance_share(self.parameters, place, cycle),
                                 wanted["stress"][place]["endurance_share"])
        self.assertEqual(rows[0].ball_force.shape, (0,))
        single = hjt.Parameters({"contact.support": "single_balls"})
        ball_force = hjt.analyse_stiffness(single, [5.0])[0].ball_force
        self.assertEqual(ball_force.shape, (single["bearing.balls"],))

    def test_a_gear_is_designed_as_the_tool_does(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "gear.yaml")
            tool("gear", "--size", 20, "--ratio", 80, "--rim-thickness", "0.8e-3", "--out", path)
            expected = hjt.Parameters(path)
        before = dict(self.parameters)
        designed, rules = hjt.design_gear(self.parameters, 20, 80, rim_thickness=0.8e-3)
        self.assertEqual(dict(self.parameters), before)
        for key, value in dict(expected).items():
            if isinstance(value, (float, tuple)):
                np.testing.assert_allclose(designed[key], value, rtol=1e-5, err_msg=key)
            else:
                self.assertEqual(designed[key], value, key)
        self.assertEqual(rules["gear.rim_thickness"], "given")
        self.assertEqual(set(rules), {key for key in rules if key in designed})
        self.assertEqual(hjt.gear_warnings(designed), [])
        for bad in ({"size": 1000}, {"size": 20, "ratio": 7}, {"size": float("nan")}, {"size": 20, "face_width": -1.0}):
            with self.assertRaises(hjt.ParameterError):
                hjt.design_gear(self.parameters, **bad)

    def test_what_does_not_go_together_is_told(self):
        [warning] = hjt.gear_warnings(hjt.Parameters({"ring.bending_stiffness": 20.0}))
        self.assertIn("ring.bending_stiffness = 20 [N.m/rad] should be near 258", warning)

    def test_turning(self):
        expected = tool("turn", "--load", "20", "--angle-range", "0.2", "--steps", "10")["rows"]
        rows = hjt.analyse_turn(self.parameters, load=20.0, angle_range=0.2, steps=10)
        self.assertEqual(rows.shape, (len(expected),))
        for name in rows.dtype.names:
            np.testing.assert_array_equal(rows[name], [row[name] for row in expected], name)

    def test_losses(self):
        expected = tool("losses", "--speeds", "50,200", "--loads", "0,20,60", "--positions", "4")["rows"]
        rows = hjt.analyse_losses(self.parameters, [50.0, 200.0], [0.0, 20.0, 60.0], positions=4)
        self.assertEqual(rows.shape, (3, 2))
        for name in rows.dtype.names:
            np.testing.assert_array_equal(rows[name].ravel(), [row[name] for row in expected], name)

    def test_breakaway(self):
        expected = tool("breakaway", "--positions", "4")
        result = hjt.analyse_breakaway(self.parameters, positions=4)
        self.assertEqual((result.starting, result.back_driving),
                         (expected["starting_torque"], expected["back_driving_torque"]))

    def test_torsion_loop(self):
        expected = tool("hysteresis", "--amplitude", "20", "--lost-motion-torque", "2", "--steps", "20")
        loop = hjt.analyse_torsion_loop(self.parameters, 20.0, 2.0, steps=20)
        self.assertEqual((loop.hysteresis, loop.lost_motion), (expected["hysteresis"], expected["lost_motion"]))
        np.testing.assert_array_equal(loop.torque, [point["torque"] for point in expected["points"]])
        np.testing.assert_array_equal(loop.output_angle, [point["output_angle"] for point in expected["points"]])

    def test_a_jammed_gear_is_seen(self):
        self.assertFalse(hjt.check_fit(self.parameters).jams)
        jammed = hjt.check_fit(hjt.Parameters({"mesh.flank_clearance": -50e-6}))
        self.assertTrue(jammed.jams)
        self.assertGreater(jammed.wave_generator_force, 2.0 * jammed.wave_generator_force_insertion)

    def test_bad_arguments_are_named(self):
        nan = float("nan")
        for call, words in (
                (lambda: hjt.analyse_stiffness(self.parameters, [5.0, nan]), "torques = .* is not a finite number"),
                (lambda: hjt.analyse_turn(self.parameters, 5.0, 1.0, 0), r"steps = 0 \[-\] is out of range"),
                (lambda: hjt.analyse_turn(self.parameters, nan, 1.0, 1), "load = .* is not a finite number"),
                (lambda: hjt.analyse_losses(self.parameters, [5.0], [1.0], 0), "positions = 0"),
                (lambda: hjt.analyse_breakaway(self.parameters, 0), "positions = 0"),
                (lambda: hjt.analyse_torsion_loop(self.parameters, 60.0, 2.0, 1), "steps = 1"),
                (lambda: hjt.analyse_torsion_loop(self.parameters, 0.0, 0.0), "amplitude = 0"),
                (lambda: hjt.analyse_torsion_loop(self.parameters, 1.0, 2.0), "lost_motion_torque = 2.0"),
                (lambda: hjt.analyse_torsion_loop(self.parameters, -1.0, 2.0), "amplitude = -1.0"),
                (lambda: hjt.analyse_torsion_loop(self.parameters, math.inf, 2.0), "amplitude = .*inf")):
            with self.assertRaisesRegex(hjt.InputError, words):
                call()

    def test_no_equilibrium_is_an_error_with_the_words_of_the_tool(self):
        options = ["--torques", "100000"]
        done = subprocess.run([TOOL, "stiffness", *options], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                              text=True, check=False)
        with self.assertRaises(hjt.NotConverged) as caught:
            hjt.analyse_stiffness(self.parameters, [100000.0])
        self.assertIsInstance(caught.exception, RuntimeError)
        text = str(caught.exception)
        reason = text[text.index(": "):]
        self.assertIn(reason, done.stderr)


if __name__ == "__main__":
    unittest.main(verbosity=2)
