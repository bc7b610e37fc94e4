#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""The static analyses from Python: the tool's numbers; every kind of fault changes the result of each or is refused
with the reason. Argument: the tool."""
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


# Each with the tool's command of the same name.
ANALYSES = {
    "insert": lambda given: numbers(hjt.analyse_insertion(given), "solve_time"),
    "stiffness": lambda given: [numbers(row) for row in hjt.analyse_stiffness(given, [40.0, -40.0], angle=0.3)],
    "turn": lambda given: hjt.analyse_turn(given, load=40.0, angle_range=0.05, steps=2),
    "losses": lambda given: hjt.analyse_losses(given, [1.0, 100.0], [0.0, 40.0], positions=2),
    "breakaway": lambda given: numbers(hjt.analyse_breakaway(given, positions=2)),
    "hysteresis": lambda given: numbers(hjt.analyse_torsion_loop(given, 60.0, 2.7, steps=8)),
    "endurance share": lambda given: hjt.endurance_share(
        given, "tooth space", hjt.analyse_stiffness(given, [60.0])[0].stress.cycle("tooth space")),
}


def numbers(result, *without):
    """Every number of a result, those of its parts too."""
    found = []
    for name in dir(result):
        if name.startswith("_") or name in without or callable(getattr(result, name)):
            continue
        value = getattr(result, name)
        if isinstance(value, (int, float, np.ndarray)):
            found.append(np.asarray(value, dtype=float).ravel())
        else:
            found.append(numbers(value))
    return np.concatenate([np.zeros(0), *found])


def bits(result):
    if isinstance(result, list):
        return b"".join(part.tobytes() for part in result)
    return np.asarray(result).tobytes()


def outcome(analysis, given):
    """Bits of the result; or why there is none."""
    try:
        return bits(ANALYSES[analysis](given))
    except (hjt.InputError, hjt.NotConverged) as error:
        return str(error).encode()


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


class Analyses(unittest.TestCase):
    def test_every_fault_acts_or_is_refused(self):
        given = hjt.Parameters()
        for analysis in list(ANALYSES)[:-1]:
            sound = outcome(analysis, given)
            for name, kind in hjt.fault_kinds().items():
                with self.subTest(analysis=analysis, fault=name):
                    other = given.copy()
                    other.faults = [f"{name}:1" + ("" if kind.whole else ":0")]
                    try:
                        result = bits(ANALYSES[analysis](other))
                    except hjt.NotConverged:
                        continue
                    except hjt.ParameterError as error:
                        self.assertRegex(str(error), f"faults: {name} cannot act in this analysis, which does not ")
                        continue
                    self.assertNotEqual(result, sound)

    def test_refused_are_those_of_parts_left_out(self):
        refused = {analysis: set() for analysis in ANALYSES}
        for analysis in ANALYSES:
            for name, kind in hjt.fault_kinds().items():
                other = hjt.Parameters()
                other.faults = [f"{name}:0.5" + ("" if kind.whole else ":0")]
                if b"cannot act in this analysis" in outcome(analysis, other):
                    refused[analysis].add(name)
        self.assertEqual(refused["losses"] | refused["breakaway"] | refused["hysteresis"], set())
        self.assertEqual(refused["stiffness"], {"lubricant_degradation"})
        self.assertEqual(refused["turn"], {"lubricant_degradation"})
        self.assertEqual(refused["insert"], {"lubricant_degradation", "tooth_wear", "tooth_root_crack",
                                             "tooth_tip_crack", "pitting", "ratcheting", "rear_section_crack",
                                             "flange_crack"})

    def test_a_fault_that_sets_in_later_is_refused(self):
        given = hjt.Parameters()
        given.faults = ["tooth_wear:0.5:-1:2.5"]
        for analysis in ANALYSES:
            self.assertIn("tooth_wear sets in at 2.5 s, but this analysis has no time",
                          outcome(analysis, given).decode())

    def test_the_tool_says_the_same(self):
        command = [TOOL, "stiffness", "--torques", "40", "--json", "--fault"]
        done = subprocess.run([*command, "lubricant_degradation:0.5"], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                              universal_newlines=True, check=False)
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("lubricant_degradation cannot act in this analysis, which does not contain friction", done.stderr)
        given = hjt.Parameters()
        given.faults = ["tooth_wear:1"]
        worn = subprocess.run([*command, "tooth_wear:1"], stdout=subprocess.PIPE, universal_newlines=True, check=True)
        self.assertIn(repr(hjt.analyse_stiffness(given, [40.0])[0].output_angle), worn.stdout)


if __name__ == "__main__":
    unittest.main(verbosity=2)
