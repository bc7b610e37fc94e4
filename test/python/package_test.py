#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""One package of the messages and the module, and the examples of its page. Argument: the tool."""
import os
import re
import subprocess
import sys
import tempfile
import unittest

TOOL = sys.argv.pop(1)
PAGE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "docs", "python.md")


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


if __name__ == "__main__":
    unittest.main(verbosity=2)
