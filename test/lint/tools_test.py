# SPDX-License-Identifier: BSD-3-Clause
"""The checks that a tool makes pass on a faultless file and speak up on a faulty one."""
import contextlib
import io
import json
import os
import shutil
import subprocess
import unittest
import unittest.mock

import catkin_lint
import clang_tidy
import project
import python
from tree import Tree


def skip_as(test, output):
    """Skips a test because the check that it runs is skipped, for the reason in the check's output."""
    test.skipTest(output.split("skipped: ")[-1].strip())


class Format(Tree):
    def result(self, content):
        path = self.write("one.cpp", content)
        os.symlink(os.path.join(project.ROOT, ".clang-format"), os.path.join(self.root, ".clang-format"))
        command = [os.path.join(project.ROOT, "scripts", "format"), "--check", path]
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, universal_newlines=True,
                              check=False)
        if done.returncode == project.SKIPPED:
            skip_as(self, done.stdout)
        return done.returncode

    def test_house_style(self):
        self.assertEqual(self.result("int f()\n{\n  return 1;\n}\n"), 0)

    def test_another_style(self):
        self.assertNotEqual(self.result("int f() {\n    return 1;\n}\n"), 0)


class ClangTidy(Tree):
    def setUp(self):
        super().setUp()
        self.root = os.path.realpath(self.root)
        self.printed = io.StringIO()
        environment = unittest.mock.patch.dict(os.environ, XDG_CACHE_HOME=os.path.join(self.root, "cache"))
        environment.start()
        self.addCleanup(environment.stop)
        shutil.copy(os.path.join(project.ROOT, ".clang-tidy"), self.root)

    def problems(self, content, options=()):
        path = self.write("src/one.cpp", content)
        entry = {"directory": self.root, "file": path,
                 "arguments": ["c++", "-std=c++17", *options, "-o", "one.o", "-c", path]}
        self.write("build/compile_commands.json", json.dumps([entry]))
        self.printed = io.StringIO()
        try:
            with contextlib.redirect_stdout(self.printed):
                return clang_tidy.check(os.path.join(self.root, "build"), self.root)
        except SystemExit:  # by project.skip
            skip_as(self, self.printed.getvalue())

    def assert_checked(self, checked, *arguments):
        """The file is clean; `checked`: the tool had to run to find that out."""
        self.assertEqual(self.problems(*arguments), [])
        self.assertEqual(self.printed.getvalue(), f"src/one.cpp: {'clean' if checked else 'known to be clean'}\n")

    def test_house_names(self):
        self.assertEqual(self.problems("class RimTension\n{\n  int value_ = 0;\n\npublic:\n  int readValue() const "
                                       "{ return value_; }\n};\nconstexpr int TEETH = 200;\n"), [])

    def test_other_names(self):
        for content in ["class rim_tension\n{\n};\n", "class A\n{\n  int value = 0;\n};\n", "int Read();\n",
                        "constexpr int kTeeth = 200;\n"]:
            with self.subTest(content=content):
                self.assertIn("naming", "".join(self.problems(content)))

    def test_clean_file_is_checked_once(self):
        content = '#include "one.hpp"\nint readValue();\n'
        self.write("src/one.hpp", "constexpr int TEETH = 200;\n")
        self.assert_checked(True, content)
        self.assert_checked(False, content)
        changes = {
            "header": lambda: self.write("src/one.hpp", "constexpr int TEETH = 160;  // NOLINT\n"),
            "rules": lambda: self.write(".clang-tidy", project.text(self.root, ".clang-tidy") + "# another\n"),
        }
        for name, change in changes.items():
            with self.subTest(changed=name):
                change()
                self.assert_checked(True, content)
                self.assert_checked(False, content)
        self.assert_checked(True, content + "// longer\n")
        self.assertFalse(os.path.exists(os.path.join(self.root, "one.o")))  # the build's own files stay as they are
        self.assert_checked(True, content, ["-DANOTHER=1"])

    def test_finding_is_never_remembered(self):
        for _ in range(2):
            self.assertIn("naming", "".join(self.problems("int Read();\n")))
        self.assertEqual(os.listdir(os.path.join(self.root, "cache", "harmonic_joint_twin", "clang_tidy")), [])

    def problems_of_a_unity_build(self, *contents):
        """Of the sources one and two, compiled at once."""
        one, two = (self.write(f"src/{name}.cpp", content) for name, content in zip(("one", "two"), contents))
        unity = self.write("build/Unity/unity_0_cxx.cxx", f'#include "{one}"\n#include "{two}"\n')
        command = ["c++", "-std=c++17", "-o", "unity.o", "-c", unity]
        self.write("build/compile_commands.json",
                   json.dumps([{"directory": self.root, "file": unity, "arguments": command}]))
        try:
            with contextlib.redirect_stdout(self.printed):
                return clang_tidy.check(os.path.join(self.root, "build"), self.root)
        except SystemExit:
            skip_as(self, self.printed.getvalue())

    def test_source_of_a_unity_build_is_checked_alone(self):
        problems = self.problems_of_a_unity_build("#include <vector>\nstd::vector<int> one();\n",
                                                  "std::vector<int> two();\n")
        self.assertEqual(self.printed.getvalue(), "src/one.cpp: clean\nsrc/two.cpp: FAULTS\n")
        self.assertIn("vector", "".join(problems))

    def test_sources_of_a_unity_build_are_checked_at_once_in_their_turn(self):
        turn = {"src/two.cpp"}, lambda path: True
        with unittest.mock.patch.object(clang_tidy, "turn", lambda root: turn):
            problems = self.problems_of_a_unity_build("int Read();\n", "int two();\n")
        self.assertEqual(self.printed.getvalue(), "src/one.cpp and what is compiled with it: FAULTS\n")
        self.assertIn("Read", "".join(problems))

    def test_a_few_changed_sources_of_a_unity_build_are_checked_alone(self):
        turn = {"src/two.cpp"}, lambda path: False
        with unittest.mock.patch.object(clang_tidy, "turn", lambda root: turn):
            problems = self.problems_of_a_unity_build("int Read();\n", "int two();\n")
        self.assertEqual(self.printed.getvalue(), "src/two.cpp: clean\nUnchanged files are left to other commits\n")
        self.assertEqual(problems, [])

    def test_a_commit_has_its_changes_and_a_part_of_the_rest_checked(self):
        def commit(days):
            stamp = f"{1700000000 + 86400 * days} +0000"
            names = {f"GIT_{who}_{what}": "a" for who in ("AUTHOR", "COMMITTER") for what in ("NAME", "EMAIL")}
            with unittest.mock.patch.dict(os.environ, GIT_AUTHOR_DATE=stamp, GIT_COMMITTER_DATE=stamp, **names):
                for command in (["add", "src"], ["commit", "-qm", "change"]):
                    subprocess.run(["git", "-C", self.root, *command], check=True, stdout=subprocess.DEVNULL)

        names = [f"src/file_{number}.cpp" for number in range(30)]
        self.assertIsNone(clang_tidy.turn(self.root))
        subprocess.run(["git", "init", "-q", self.root], check=True)
        for name in names:
            self.write(name, "int first();\n")
        commit(0)
        self.assertLessEqual(set(names), clang_tidy.turn(self.root)[0])  # all are new
        seen = []
        for day in range(2, 2 * clang_tidy.PARTS + 1, 2):
            self.write("src/file_7.cpp", f"int second{day}();\n")
            self.write("src/file_8.cpp", f"int first();  // of {day}\n")
            commit(day)
            fresh, is_turn = clang_tidy.turn(self.root)
            self.assertEqual(fresh - {".clang-tidy"}, {"src/file_7.cpp"})
            seen.append(set(filter(is_turn, names)))
        self.assertEqual(set.union(*seen), set(names))
        self.assertEqual(set.intersection(*seen), set())
        self.write("src/file_8.cpp", "int third();\n")
        self.assertIn("src/file_8.cpp", clang_tidy.turn(self.root)[0])

    def test_precompiled_header_hides_nothing(self):
        prefix = self.write("build/cmake_pch.hxx", "#include <vector>\n")
        options = ["-Winvalid-pch", "-include", prefix]
        self.assertIn("vector", "".join(self.problems("std::vector<int> teeth();\n", options)))
        self.assert_checked(True, "#include <vector>\nstd::vector<int> teeth();\n", options)


class Python(Tree):
    def test_clean(self):
        self.write("scripts/one.py", "import sys\n\nsys.exit(0)\n")
        self.assert_clean(python.check)

    def test_faults(self):
        for content, word in [("import os\n", "F401"), ("x = 1" + " + 1" * 40 + "\n", "E501"), ("x = y\n", "F821")]:
            with self.subTest(content=content):
                self.write("scripts/one.py", content)
                self.assert_fault(python.check, "scripts/one.py:1", word)


class CatkinLint(Tree):
    def test_fault(self):
        self.write("package.xml", "<package format='3'><name>harmonic_joint_twin</name><version>0.1.0</version>"
                                  "<description>d</description><maintainer email='a@b.cc'>a</maintainer>"
                                  "<license>BSD</license></package>")
        self.write("CMakeLists.txt", "cmake_minimum_required(VERSION 3.16)\nproject(another)\n")
        code, note = catkin_lint.lint(self.root)
        self.assertNotEqual(code, 0)
        self.assertIn("error", note)


if __name__ == "__main__":
    unittest.main(verbosity=2)
