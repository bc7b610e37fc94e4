#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""scripts/run_ctest.py on a project of a few small tests."""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

CTEST_OPTIONS = subprocess.run(["ctest", "--help"], stdout=subprocess.PIPE, universal_newlines=True, check=True).stdout
RUN_CTEST = pathlib.Path(__file__).resolve().parents[2] / "scripts" / "run_ctest.py"
SKIPPING = """import unittest
class Part(unittest.TestCase):
    def test_here(self): pass
    @unittest.skip("no robot")
    def test_beside_a_robot(self): pass
unittest.main({})
"""
FLAKY = """import os, sys
if not os.path.exists("ran"):
    open("ran", "w").close()
    sys.exit(1)
"""


@unittest.skipUnless("until-pass" in CTEST_OPTIONS, "this ctest does not repeat tests (before 3.17)")
class RunCtest(unittest.TestCase):
    def ctest(self, programs, options=("--repeat", "until-pass:2"), timed=()):
        """Runs the Python programs {name: text} as tests; returns exit code and lines of output."""
        with tempfile.TemporaryDirectory() as folder:
            lines = ["cmake_minimum_required(VERSION 3.16)", "project(small NONE)", "enable_testing()"]
            for name, text in programs.items():
                pathlib.Path(folder, f"{name}.py").write_text(text, encoding="utf-8")
                lines += [f"add_test(NAME {name} COMMAND {sys.executable} {folder}/{name}.py)",
                          f"set_tests_properties({name} PROPERTIES SKIP_RETURN_CODE 77 LABELS"
                          f' "{"unit;timed" if name in timed else "unit"}")']
            pathlib.Path(folder, "CMakeLists.txt").write_text("\n".join(lines), encoding="utf-8")
            subprocess.run(["cmake", "-S", folder, "-B", folder], check=True, stdout=subprocess.DEVNULL)
            done = subprocess.run([RUN_CTEST, *options], cwd=folder, stdout=subprocess.PIPE,
                                  stderr=subprocess.STDOUT, universal_newlines=True, check=False)
        return done.returncode, done.stdout.splitlines()

    def test_skipped_and_repeated_tests_are_named_before_the_closing_lines(self):
        code, lines = self.ctest({"good": "", "flaky": FLAKY, "part": SKIPPING.format("verbosity=2"),
                                  "whole": "print('skipped: no valgrind'); exit(77)"})
        self.assertEqual(code, 0, lines)
        closing = lines.index("100% tests passed, 0 tests failed out of 4")
        named = [line for line in lines[:closing - 1] if not line.startswith((" ", "Test "))][-5:]
        self.assertEqual(named[:3],
                         ["passed when repeated: flaky", "skipped: part: no robot", "skipped: whole: no valgrind"])
        for line, label in zip(named[3:], ("unit", "all")):
            self.assertRegex(line, rf"^\d+ s in 4 tests: {label}$")
        self.assertTrue([line for line in lines[closing:] if line.startswith("Total Test time")], lines)

    def test_a_skip_without_a_reason_fails(self):
        for program in (SKIPPING.format(""), "exit(77)"):
            code, lines = self.ctest({"silent": program})
            self.assertEqual(code, 1, lines)
            self.assertIn("skipped: silent: NO REASON GIVEN", lines)

    def test_a_test_that_judges_time_has_a_second_try(self):
        code, lines = self.ctest({"flaky": FLAKY, "good": ""}, [], ["flaky"])
        self.assertEqual(code, 0, lines)
        for line in ("passed when repeated: flaky", "100% tests passed, 0 tests failed out of 2"):
            self.assertIn(line, lines)
        self.assertTrue([line for line in lines if line.endswith(" s in 1 tests: timed")], lines)
        self.assertFalse([line for line in lines if "FAILED" in line], lines)

    def test_no_other_test_has(self):
        code, lines = self.ctest({"flaky": FLAKY, "late": "exit(1)", "good": ""}, [], ["late"])
        self.assertEqual(code, 8, lines)
        self.assertIn("33% tests passed, 2 tests failed out of 3", lines)
        self.assertFalse([line for line in lines if line.startswith("passed when repeated")], lines)

    def test_a_failure_beside_one_that_passes_late_is_left(self):
        code, lines = self.ctest({"flaky": FLAKY, "bad": "exit(1)"}, [], ["flaky"])
        self.assertEqual(code, 8, lines)
        self.assertIn("50% tests passed, 1 tests failed out of 2", lines)
        closing = lines[lines.index("50% tests passed, 1 tests failed out of 2"):]
        self.assertTrue([line for line in closing if " - bad (" in line], lines)
        self.assertFalse([line for line in closing if "flaky" in line], lines)

    def test_a_failure_keeps_the_exit_code_of_ctest(self):
        code, lines = self.ctest({"bad": "exit(1)"})
        self.assertEqual(code, 8, lines)
        self.assertIn("0% tests passed, 1 tests failed out of 1", lines)


if __name__ == "__main__":
    os.environ.pop("CTEST_OUTPUT_ON_FAILURE", None)
    unittest.main(verbosity=2)
