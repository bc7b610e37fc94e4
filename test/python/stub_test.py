#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""The type stubs tell what the module has: every name, every argument and its default. Argument: the tool."""
import ast
import importlib.util
import inspect
import os
import re
import sys
import unittest

import harmonic_joint_twin
from harmonic_joint_twin import _hjt, _recordings

TOOL = sys.argv.pop(1)
STUB = os.path.join(os.path.dirname(harmonic_joint_twin.__file__), "_hjt.pyi")
# Arguments of Python, and the options of the command line that they stand for.
INSTEAD = {"overlays": {"config", "set", "config_dir"}, "progress": set(),
           "columns": {"time", "motor_torque", "motor_angle", "output_angle", "motor_velocity", "load_torque",
                       "temperature", "target_angle"}}
TOOLS_ALONE = {"joint_namespace", "states_topic", "load_topic", "windows"}
TOOLS_OWN = {"check": {"force"}, "follow": {"out"}}  # it writes no file; Python gets the rows as arrays
SOURCES = [os.path.join(os.path.dirname(STUB), name) for name in ("_commands.py", "_data_sets.py")]


def stub_body(node):
    """Functions and names of a module or class of the stub: name to argument list, or to None."""
    found = {}
    for item in node.body:
        if isinstance(item, ast.FunctionDef):
            is_property = any(getattr(mark, "id", "") == "property" or getattr(mark, "attr", "") == "setter"
                              for mark in item.decorator_list)
            found[item.name] = None if is_property else item
        elif isinstance(item, ast.ClassDef):
            found[item.name] = item
        elif isinstance(item, ast.AnnAssign):
            found[item.target.id] = None
    return found


def arguments_of(text):
    """Names of a signature in a docstring, with = where there is a default."""
    depth, parts = 0, [""]
    for character in text:
        depth += {"[": 1, "(": 1, "{": 1, "]": -1, ")": -1, "}": -1}.get(character, 0)
        if character == "," and depth == 0:
            parts.append("")
        else:
            parts[-1] += character
    return [re.match(r"[*\w]+", part.strip()).group() + ("=" if "=" in part else "")
            for part in parts if part.strip()]


def stub_arguments(item):
    arguments = [argument.arg for argument in item.args.args]
    first = len(arguments) - len(item.args.defaults)
    return [name + ("=" if place >= first else "") for place, name in enumerate(arguments)]


def public(names):
    return {name for name in names if not name.startswith("_")}


class Stub(unittest.TestCase):
    def setUp(self):
        with open(STUB, encoding="utf-8") as file:
            self.stub = stub_body(ast.parse(file.read()))

    def compare(self, name, item, real):
        text = (real.__doc__ or "").splitlines()
        signature = re.match(r"\w+\((.*)\) ->", text[0]) if text else None
        if signature and isinstance(item, ast.FunctionDef) and "*args" not in signature.group(1):
            self.assertEqual(stub_arguments(item), arguments_of(signature.group(1)), name)
        self.assertTrue(any(len(line) > 20 for line in text[1:]), f"{name} has no docstring")

    def test_has_every_name_and_no_other(self):
        self.assertEqual(public(self.stub), public(dir(_hjt)))
        for name, item in self.stub.items():
            if isinstance(item, ast.ClassDef) and not issubclass(getattr(_hjt, name), Exception):
                self.assertEqual(public(stub_body(item)), public(dir(getattr(_hjt, name))), name)

    def test_has_the_arguments(self):
        for name, item in self.stub.items():
            real = getattr(_hjt, name)
            if isinstance(item, ast.FunctionDef):
                self.compare(name, item, real)
            elif isinstance(item, ast.ClassDef):
                for member, function in stub_body(item).items():
                    if isinstance(function, ast.FunctionDef) and not member.startswith("__"):
                        self.compare(f"{name}.{member}", function, getattr(real, member))

    def test_functions_take_the_options_of_their_tables(self):
        for function, options in _recordings.OPTIONS.items():
            taken = set(inspect.signature(getattr(harmonic_joint_twin, function)).parameters)
            self.assertEqual(taken - set(options), taken & set(INSTEAD), function)
            left = set().union(TOOLS_ALONE, TOOLS_OWN.get(function, set()), *INSTEAD.values())
            self.assertLessEqual(set(options) - taken, left, function)

    def test_everything_has_a_docstring(self):
        for name in public(dir(_hjt)):
            thing = getattr(_hjt, name)
            if isinstance(thing, type):
                self.assertTrue(thing.__doc__, name)
                for member in [] if issubclass(thing, Exception) else public(dir(thing)):
                    self.assertTrue(getattr(thing, member).__doc__, f"{name}.{member}")

    @unittest.skipUnless(importlib.util.find_spec("mypy"), "no mypy here")
    @unittest.skipUnless(importlib.util.find_spec("numpy.typing"), "this numpy has no types")
    def test_passes_the_type_checker(self):
        from mypy import api
        output, errors, code = api.run(["--strict", "--cache-dir", os.devnull, STUB, *SOURCES])
        self.assertEqual(code, 0, output + errors)


if __name__ == "__main__":
    unittest.main(verbosity=2)
