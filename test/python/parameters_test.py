#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Parameters from Python: the tool's values, checks and words. Argument: the tool."""
import copy
import json
import locale
import os
import pickle
import subprocess
import sys
import tempfile
import unittest
import unittest.mock

import numpy as np

import harmonic_joint_twin as hjt

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "support"))
import comma_locale  # noqa: E402

TOOL = sys.argv.pop(1)


class Values(unittest.TestCase):
    def test_are_those_of_the_tool(self):
        printed = subprocess.run([TOOL, "parameters", "--json", "--config", "joints/elbow.yaml", "--set",
                                  "output.load_inertia=1.5"], stdout=subprocess.PIPE, check=True)
        parameters = hjt.Parameters("joints/elbow.yaml", {"output.load_inertia": 1.5})
        expected = {f"{section}.{name}": value for section, values in json.loads(printed.stdout).items()
                    for name, value in values.items()}
        self.assertEqual(json.loads(json.dumps(dict(parameters))), expected)  # JSON knows no tuples

    def test_later_overlays_win_and_files_are_found_by_path_too(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "own.yaml")
            with open(path, "w", encoding="utf-8") as file:
                file.write("output:\n  load_inertia: 2.5\n")
            self.assertEqual(hjt.Parameters({"output.load_inertia": 1.0}, path)["output.load_inertia"], 2.5)
            self.assertEqual(hjt.Parameters(path, {"output.load_inertia": 1.0})["output.load_inertia"], 1.0)

    def test_do_not_depend_on_the_locale(self):
        plain = dict(hjt.Parameters("config/joints/elbow.yaml"))
        with tempfile.TemporaryDirectory() as folder, unittest.mock.patch.dict(os.environ, LOCPATH=folder):
            comma_locale.make(folder)
            self.addCleanup(locale.setlocale, locale.LC_NUMERIC, locale.setlocale(locale.LC_NUMERIC))
            locale.setlocale(locale.LC_NUMERIC, "comma")
            self.assertEqual(locale.localeconv()["decimal_point"], ",")
            self.assertEqual(dict(hjt.Parameters("config/joints/elbow.yaml")), plain)
            self.assertEqual(hjt.Parameters({"output.load_inertia": "1.5e-1"})["output.load_inertia"], 0.15)
            with self.assertRaisesRegex(hjt.ParameterError, r"mesh.stiffness = -1\.5 "):
                hjt.Parameters({"mesh.stiffness": -1.5})

    def test_numbers_of_numpy_are_numbers(self):
        parameters = hjt.Parameters()
        parameters["output.load_inertia"] = np.float64(2.0)
        parameters["solver.max_iterations"] = np.int64(30)
        parameters["cup.torsion_stiffness"] = np.array([30e3, 50e3, 60e3])
        parameters["brake.engaged_at_start"] = np.bool_(True)
        self.assertEqual(parameters["output.load_inertia"], 2.0)
        self.assertEqual(parameters["solver.max_iterations"], 30)
        self.assertEqual(parameters["cup.torsion_stiffness"], (30e3, 50e3, 60e3))
        self.assertIs(parameters["brake.engaged_at_start"], True)

    def test_copies_are_independent(self):
        first = hjt.Parameters()
        inertia = first["output.load_inertia"]
        pickled = [pickle.loads(pickle.dumps(first, protocol)) for protocol in range(pickle.HIGHEST_PROTOCOL + 1)]
        for other in [first.copy(), copy.copy(first), copy.deepcopy(first)] + pickled:
            self.assertEqual(dict(other), dict(first))
            self.assertEqual(other, first)
            other["output.load_inertia"] = inertia + 1.0
            self.assertEqual(first["output.load_inertia"], inertia)
            self.assertNotEqual(other, first)
            self.assertEqual(dict(other.items()), dict(other))
        self.assertNotEqual(first, 3)

    def test_of_a_twin_are_kept(self):
        twin = hjt.Twin(hjt.Parameters())
        for change in (lambda: twin.parameters.update({"output.load_inertia": 2.0}),
                       lambda: twin.parameters.__setitem__("output.load_inertia", 2.0),
                       lambda: setattr(twin.parameters, "faults", "pitting:0.5")):
            with self.assertRaisesRegex(TypeError, r"parameters\.copy\(\)"):
                change()
        other = twin.parameters.copy()
        other["output.load_inertia"] = 2.0
        self.assertEqual(hjt.Twin(other).parameters["output.load_inertia"], 2.0)

    def test_each_has_unit_range_and_meaning(self):
        parameters = hjt.Parameters()
        fields = hjt.parameter_fields()
        self.assertEqual([field.key for field in fields], list(parameters))
        self.assertEqual(len(fields), len(parameters))
        for field in fields:
            self.assertTrue(field.unit and field.meaning, field.key)
            value = parameters[field.key]
            if field.minimum is not None:
                for number in value if isinstance(value, tuple) else [value]:
                    self.assertTrue(field.minimum <= number <= field.maximum, field.key)
            if field.choices:
                self.assertIn(value, field.choices)
        self.assertEqual(hjt.Parameters.field("mesh.stiffness").unit, "N/m")
        self.assertIn("mesh.stiffness", parameters)
        self.assertNotIn("mesh.stifness", parameters)
        self.assertIn("mesh.stiffness: ", parameters.describe())


class Errors(unittest.TestCase):
    def refuse(self, changes, *parts):
        parameters = hjt.Parameters()
        before = dict(parameters)
        with self.assertRaises(hjt.ParameterError) as caught:
            parameters.update(changes)
        for part in parts:
            self.assertIn(part, str(caught.exception))
        self.assertEqual(dict(parameters), before)

    def test_have_the_words_of_the_tool(self):
        self.refuse({"mesh.stiffness": -1.0}, "mesh.stiffness = -1", "[N/m] is out of range, allowed: 0 ... 1.0e+12")
        self.refuse({"mesh.stifness": 1.0}, "unknown parameter mesh.stifness", "did you mean mesh.stiffness?")
        self.refuse({"solver.scene": "quick"}, "must be full_ring or auto")
        self.refuse({"cup.torsion_stiffness": [1.0, 2.0]}, "must be a list of 3 numbers [N.m/rad]")
        self.refuse({"gear.teeth_flexspline": 200.5}, "gear.teeth_flexspline = 200.5 must be a whole number")
        self.refuse({"mesh.stiffness": object()}, "mesh.stiffness = <object", "must be a number")
        self.refuse({"mesh.stiffness": float("nan")}, "not a finite number")
        self.refuse({1: 2.0}, "key 1 must be a text")
        # Each alone is in range.
        self.refuse({"gear.teeth_circular_spline": 206}, "gear.teeth_circular_spline")

    def test_are_input_and_value_errors(self):
        self.assertTrue(issubclass(hjt.ParameterError, hjt.InputError))
        self.assertTrue(issubclass(hjt.InputError, ValueError))
        with self.assertRaises(hjt.ParameterError):
            hjt.Parameters("no_such_file.yaml")
        with self.assertRaises(hjt.ParameterError):
            hjt.Parameters(config_dir="/no/such/directory")
        with self.assertRaises(KeyError):
            hjt.Parameters()["no.such_key"]
        with self.assertRaises(TypeError):
            hjt.Parameters(3)
        with self.assertRaises(TypeError):
            hjt.Parameters(conf_dir="")


class Faults(unittest.TestCase):
    def test_are_objects_or_the_texts_of_the_tool(self):
        parameters = hjt.Parameters()
        parameters.faults = ["tooth_root_crack:0.5:40:1.5", hjt.Fault("lubricant_degradation", 0.2)]
        found = {(fault.kind, fault.severity, fault.place, fault.onset) for fault in parameters.faults}
        self.assertEqual(found, {("tooth_root_crack", 0.5, 40, 1.5), ("lubricant_degradation", 0.2, -1, 0.0)})
        self.assertEqual(len(pickle.loads(pickle.dumps(parameters)).faults), 2)
        fault = hjt.Fault("tooth_root_crack", 0.5, 40, 1.5)
        for one in "tooth_root_crack:0.5:40:1.5", fault, pickle.loads(pickle.dumps(fault)):
            parameters.faults = one
            self.assertEqual(parameters.faults, [fault])
        parameters.faults = []
        self.assertEqual(parameters.faults, [])
        self.assertNotEqual(fault, hjt.Fault("tooth_root_crack", 0.5, 41, 1.5))

    def test_out_of_range_are_refused(self):
        parameters = hjt.Parameters()
        for bad, part in (("tooth_root_crack:2:40", "severity = 2"), ("tooth_root_crack:0.5:200", "tooth 0 ... 199"),
                          ("crack:0.5", "unknown kind 'crack'"), (hjt.Fault("pitting", 0.5, 400), "place = 400"),
                          ("crack", "fault crack: expected KIND:SEVERITY")):
            with self.assertRaises(hjt.ParameterError) as caught:
                parameters.faults = [bad]
            self.assertIn(part, str(caught.exception))
        with self.assertRaises(hjt.ParameterError):
            hjt.Fault("crack", 0.5)
        with self.assertRaisesRegex(hjt.ParameterError, r"^severity = 7\.0 \[-\] of pitting is out of range"):
            hjt.Fault("pitting", 7.0)

    def test_kinds_are_listed(self):
        kinds = hjt.fault_kinds()
        self.assertEqual(len(kinds), 16)
        self.assertEqual(kinds["bearing_ball"].place, "ball")
        self.assertIn("order", kinds["bearing_ball"].shows(hjt.Parameters()))


if __name__ == "__main__":
    unittest.main(verbosity=2)
