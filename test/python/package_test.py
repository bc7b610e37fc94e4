#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""One package of the messages and the module, the examples of its page, and type stubs that tell what the module has:
every name, every argument and its default. Argument: the tool."""
import ast
import importlib.util
import inspect
import os
import re
import subprocess
import sys
import tempfile
import unittest

import harmonic_joint_twin
from harmonic_joint_twin import _hjt, _recordings

TOOL = sys.argv.pop(1)
PAGE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "docs", "python.md")
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


class Package(unittest.TestCase):
    def run_python(self, *lines):
        done = subprocess.run([sys.executable, "-c", "\n".join(lines)], stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stdout)
        return done.stdout

    def test_messages_come_without_the_module(self):
        loaded = self.run_python("import sys", "from harmonic_joint_twin.msg import Health",
                                 "import harmonic_joint_twin", "print(Health().torsion)",
                                 "print('harmonic_joint_twin._hjt' in sys.modules)")
        self.assertEqual(loaded.split(), ["0.0", "False"])

    def test_the_module_comes_with_the_messages(self):
        printed = self.run_python("import harmonic_joint_twin as hjt", "from harmonic_joint_twin.msg import Health",
                                  "from harmonic_joint_twin import Twin", "assert hjt.Twin is Twin",
                                  "print(len(hjt.Parameters()) > 200, Health().torsion, 'Twin' in dir(hjt))")
        self.assertEqual(printed.split(), ["True", "0.0", "True"])

    def test_the_examples_of_the_page_run_one_after_another(self):
        with open(PAGE, encoding="utf-8") as file:
            page = file.read()
        examples = re.findall(r"```python\n(.*?)```", page, flags=re.DOTALL)
        self.assertGreaterEqual(len(examples), 4)
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run([sys.executable, "-c", "\n".join(examples)], cwd=folder, stdout=subprocess.PIPE,
                                  stderr=subprocess.STDOUT, text=True, check=False,
                                  env=dict(os.environ, MPLBACKEND="agg"))
            self.assertEqual(done.returncode, 0, done.stdout)
            self.assertGreater(os.path.getsize(os.path.join(folder, "run.png")), 5000)
        # The errors that the page quotes are those that come.
        for key, words in re.findall(r">>> parameters\[\"([\w.]+)\"\] = .*\nharmonic_joint_twin._hjt.(.*)", page):
            value = "-1" if key == "mesh.stiffness" else "1e8"
            raised = self.run_python("import harmonic_joint_twin as hjt", "try:",
                                     f"    hjt.Parameters()['{key}'] = {value}", "except hjt.ParameterError as e:",
                                     "    print('ParameterError:', e)")
            self.assertEqual(raised.strip(), words)

    def test_a_star_brings_every_public_name(self):
        found = {}
        exec("from harmonic_joint_twin import *", found)  # pylint: disable=exec-used  (only a module may import so)
        self.assertLessEqual({"Twin", "Parameters", "compare", "load", "Arm"}, set(found))
        self.assertNotIn("importlib", found)

    def test_unknown_names_are_named(self):
        printed = self.run_python("import harmonic_joint_twin as hjt", "try:", "    hjt.Twn",
                                  "except AttributeError as e:", "    print(e)")
        self.assertIn("has no attribute 'Twn'", printed)


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
