# SPDX-License-Identifier: BSD-3-Clause
"""Each check of this folder passes on a faultless file and speaks up on a faulty one."""
import contextlib
import io
import json
import os
import shutil
import subprocess
import tempfile
import unittest
import unittest.mock

import catkin_lint
import citation
import clang_tidy
import config_files
import doc_tables
import doc_values
import examples
import launch_docs
import layering
import links
import message_comments
import number_locale
import project
import python
import spdx
import type_names


class Tree(unittest.TestCase):
    """A package of a few files in a temporary folder."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = folder.name

    def write(self, path, content):
        full = os.path.join(self.root, path)
        os.makedirs(os.path.dirname(full), exist_ok=True)
        with open(full, "w", encoding="utf-8") as file:
            file.write(content)
        return full

    def assert_fault(self, check, *words):
        """Exactly one problem, that names all `words`."""
        problems = check(self.root)
        self.assertEqual(len(problems), 1, problems)
        for word in words:
            self.assertIn(word, problems[0])

    def assert_clean(self, check):
        self.assertEqual(check(self.root), [])


class NumberLocale(Tree):
    def test_what_depends_on_the_locale_is_named(self):
        for line in ("x = strtod(text, nullptr);", 'printf("%6.2f N", x);', "std::ostringstream text;",
                     "node.as<double>();"):
            with self.subTest(line):
                self.write("src/gear/one.cpp", f"\n{line}\n")
                self.assert_fault(number_locale.check, "src/gear/one.cpp:2")
        self.write("src/gear/one.cpp", 'printf("%.0f %% friction, %s", x, y);\n')
        self.assert_clean(number_locale.check)


class Layering(Tree):
    def source(self, folder, header):
        self.write(f"src/{folder}/one.cpp", f"#include <vector>\n#include {header}\n")

    def test_what_a_folder_sees_is_allowed(self):
        for folder, header in [("gear", '"harmonic_joint_twin/params/parameters.hpp"'), ("gear", "<Eigen/Core>"),
                               ("gear", '"base/number_text.hpp"'), ("ros_io", '"harmonic_joint_twin/twin/twin.hpp"'),
                               ("ros_io", "<ros/ros.h>"), ("ros_io", '"harmonic_joint_twin/Health.h"'),
                               ("identification", "<ceres/ceres.h>"), ("apps/tool", '"output/progress.hpp"')]:
            with self.subTest(folder=folder, header=header):
                self.source(folder, header)
                self.assert_clean(layering.check)

    def test_all_else_is_not(self):
        for folder, header in [("params", '"gear/angle.hpp"'), ("twin", "<ros/time.h>"),
                               ("sensors", '"health/health_monitor.hpp"'), ("ros_io", '"studies/trial.hpp"'),
                               ("apps/common", '"apps/tool/commands.hpp"'), ("twin", '"harmonic_joint_twin/Health.h"'),
                               ("model", "<sensor_msgs/JointState.h>"), ("solver", '"newton.hpp"'),
                               ("solver", '"stray/a.hpp"'), ("twin", "<ceres/ceres.h>")]:
            with self.subTest(folder=folder, header=header):
                self.source(folder, header)
                self.assert_fault(layering.check, f"src/{folder}/one.cpp:2", header)
                os.remove(os.path.join(self.root, f"src/{folder}/one.cpp"))

    def test_tests_are_read_too(self):
        self.write("test/ros/one.cpp", '#include "apps/tool/commands.hpp"\n')
        self.assert_fault(layering.check, "test/ros/one.cpp:1")

    def test_public_headers_stand_without_the_others(self):
        self.write("include/harmonic_joint_twin/gear/angle.hpp", "#include <ros/ros.h>\n")
        self.assert_fault(layering.check, "angle.hpp:1")
        self.write("include/harmonic_joint_twin/gear/angle.hpp", '#include "gear/ellipse.hpp"\n')
        self.assert_fault(layering.check, "angle.hpp:1", "public")

    def test_unknown_folder(self):
        self.write("src/misc/one.cpp", "")
        self.assert_fault(layering.check, "src/misc/one.cpp")

    def test_nothing_to_check(self):
        self.assert_fault(layering.check, "no sources")


class Examples(Tree):
    PATCH = "Run: nothing\n\n--- a/src/one.cpp\n+++ b/src/one.cpp\n@@ -1 +1,2 @@\n int one;\n+int two;\n"

    def test_a_patch_that_applies(self):
        self.write("src/one.cpp", "int one;\n")
        self.write("test/extending/one.patch", self.PATCH)
        self.assert_clean(examples.check)
        self.assertEqual(project.text(self.root, "src/one.cpp"), "int one;\n")

    def test_a_patch_that_does_not(self):
        self.write("src/one.cpp", "int uno;\n")
        self.write("test/extending/one.patch", self.PATCH)
        self.assert_fault(examples.check, "one.patch:1", "does not apply")


class TypeNames(Tree):
    def test_two_types_of_one_name(self):
        self.write("include/harmonic_joint_twin/twin/one.hpp", "struct Forces\n{\n};\n")
        self.write("src/studies/two.hpp", "class Forces\n{\n};\n")
        self.assert_fault(type_names.check, "src/studies/two.hpp:1", "one.hpp:1")

    def test_declarations_members_and_local_types_may_share_a_name(self):
        self.write("src/one.hpp", "struct Forces\n{\n};\n")
        self.write("src/two.cpp", "struct Forces;\nstruct Forces::Part\n{\n};\n"
                                  "namespace\n{\nstruct Forces\n{\n};\n}  // namespace\n")
        self.assert_clean(type_names.check)


class Spdx(Tree):
    def test_present(self):
        self.write("src/one.cpp", f"// {spdx.LICENCE}\n")
        self.write("scripts/run", f"#!/bin/sh\n# {spdx.LICENCE}\n")
        self.write("README.md", "text\n")
        self.write("build/generated.cpp", "int i;\n")
        self.assert_clean(spdx.check)

    def test_missing(self):
        for path in ["src/one.cpp", "scripts/run", "msg/A.msg", "launch/a.launch", "config/a.yaml", "CMakeLists.txt"]:
            with self.subTest(path=path):
                full = self.write(path, "\n\n\n" + spdx.LICENCE)
                self.assert_fault(spdx.check, path)
                os.remove(full)


class ConfigFiles(Tree):
    def yaml(self, value, comment="# Length [m]."):
        self.write("config/a.yaml", f"gear:\n  {comment}\n  length: {value}\n")

    def test_numbers_and_texts(self):
        for value in ["1.0e-3", "5", "0.25", "[31.0e+3, 50.0e+3]", "name", '"1e-3"', "true"]:
            with self.subTest(value=value):
                self.yaml(value)
                self.assert_clean(config_files.check)

    def test_numbers_that_are_texts_to_rosparam(self):
        for value in ["1e-3", "1e3", "1.0e4", "[31.0e+3, 5e4]"]:
            with self.subTest(value=value):
                self.yaml(value)
                self.assert_fault(config_files.check, "config/a.yaml:3", "gear.length")

    def test_key_without_unit(self):
        self.yaml("0.25", comment="# Length.")
        self.assert_fault(config_files.check, "config/a.yaml:3", "unit")

    def test_launch_file_with_other_stages(self):
        self.yaml("0.25")
        self.write("config/stages", "# Files.\na.yaml\nb.yaml\n")
        load = '<rosparam command="load" file="$(arg config)/{}.yaml"/>'
        self.write("launch/twin.launch", load.format("a") + load.format("b"))
        self.assert_clean(config_files.check)
        self.write("launch/twin.launch", load.format("b") + load.format("a"))
        self.assert_fault(config_files.check, "launch/twin.launch", "stages")


class MessageComments(Tree):
    def test_units(self):
        self.write("msg/A.msg", "# Of one instant.\nuint8 OK=0  # all is well\nfloat64[] force  # per tooth [N]\n")
        self.assert_clean(message_comments.check)

    def test_missing_unit_or_comment(self):
        for line in ["float64 force", "float64 force  # per tooth", "uint8 OK=0", "float64[2] a  # []"]:
            with self.subTest(line=line):
                self.write("msg/A.msg", line + "\n")
                self.assert_fault(message_comments.check, "msg/A.msg:1")


class LaunchDocs(Tree):
    def test_doc(self):
        self.write("launch/a.launch", '<launch><arg name="bag" doc="Recording."/>'
                                      '<arg name="folder" value="config"/><include file="b.launch">'
                                      '<arg name="bag" value="$(arg bag)"/></include></launch>')
        self.assert_clean(launch_docs.check)

    def test_no_doc(self):
        self.write("launch/a.launch", '<launch><arg name="bag" default=""/></launch>')
        self.assert_fault(launch_docs.check, "'bag'")

    def test_parameters_of_an_earlier_launch(self):
        node = '<launch><node name="twin"{}><param name="arm" value="ur5"/></node></launch>'
        self.write("launch/a.launch", node.format(' clear_params="true"'))
        self.assert_clean(launch_docs.check)
        self.write("launch/a.launch", node.format(""))
        self.assert_fault(launch_docs.check, "'twin'", "clear_params")


class DocTables(Tree):
    TABLE = ["| parameter | unit |", "|---|---|", "| `gear.teeth` | - |", "| `motor.torque_limit` | N.m |"]

    def check(self, root):
        return doc_tables.check_parameters(root, self.TABLE)

    def page(self, rows):
        self.write(doc_tables.PARAMETERS,
                   "\n".join(["# A", doc_tables.PARAMETERS_BEGIN, *rows, doc_tables.PARAMETERS_END]))

    def test_same_table(self):
        self.page(self.TABLE)
        self.assert_clean(self.check)

    def test_missing_surplus_and_order(self):
        self.page(self.TABLE[:3])
        self.assert_fault(self.check, "missing", "motor.torque_limit")
        self.page(self.TABLE + ["| `motor.colour` | - |"])
        self.assert_fault(self.check, "motor.colour")
        self.page(self.TABLE[:2] + self.TABLE[:1:-1])
        self.assert_fault(self.check, "order")

    def test_write(self):
        self.page([])
        doc_tables.write_parameters(self.root, self.TABLE)
        self.assert_clean(self.check)

    def test_names_and_types(self):
        page = ("### Services\n\n| service | type |\n|---|---|\n| `~reset` | std_srvs/Trigger | x |\n\n"
                "## Next\n| `~a` | b/C |")
        self.assertEqual(doc_tables.names_and_types(page, "Services"), {"~reset": "std_srvs/Trigger"})
        with self.assertRaises(ValueError):
            doc_tables.names_and_types(page, "Topics")


class DocValues(Tree):
    def setUp(self):
        super().setUp()
        self.write("docs/validation.csv", "row,value,unit,expected,holds\na.b,0.156,%,,\n")

    def test_numbers_as_the_validation_has_them(self):
        self.write("README.md",
                   "0.16<!-- value: a.b --> and 156<!-- value: a.b * 1000 --> | 0.2<!-- value: a.b --> |\n")
        self.assert_clean(doc_values.check)

    def test_other_numbers_and_unknown_rows(self):
        for text in ["0.15<!-- value: a.b -->", "0.156<!-- value: a.b * 100 -->", "0.16<!-- value: a.c -->",
                     "so<!-- value: a.b -->", "0.16<!-- value a.b -->"]:
            with self.subTest(text=text):
                self.write("README.md", f"\n{text}\n")
                self.assertTrue(doc_values.check(self.root))


class Links(Tree):
    def test_targets_that_exist(self):
        self.write("docs/b.md", "# Two words, `code`\n\n## Same\n\n## Same\n")
        self.write("docs/images/a.png", "")
        self.write("README.md",
                   "[b](docs/b.md), [head](docs/b.md#two-words-code), [again](docs/b.md#same-1), [own](#own)\n"
                   "[![a](docs/images/a.png)](docs/b.md) [web](https://example.org/x) <img "
                   "src='docs/images/a.png'>\n"
                   "# Own\n\n```\n[none](none.md)\n```\nand `[none](none.md)`\n")
        self.assert_clean(links.check)

    def test_targets_that_do_not(self):
        self.write("docs/b.md", "# Head\n")
        for text, word in [("[b](b.md)", "b.md"), ("![a](docs/a.png)", "docs/a.png"), ("[b](docs/b.md#tail)", "#tail"),
                           ("[own](#tail)", "#tail"), ("[![a](docs/a.png)](docs/b.md)", "docs/a.png"),
                           ('<img src="a.png">', "a.png"), ("[root](/etc/hostname)", "/etc/hostname"),
                           ("[up](../README.md)", "../README.md")]:
            with self.subTest(text=text):
                self.write("README.md", f"\n{text}\n")
                self.assert_fault(links.check, "README.md:2", word)


class TemporaryPaths(Tree):
    def test_pages_hold_none(self):
        self.write("docs/a.md", "joint_twin insert --csv insertion.csv, mnt/tmp/x\n")
        self.assert_clean(links.check)
        self.write("docs/a.md", "# A\njoint_twin insert --csv /tmp/validate.x/insertion.csv\n")
        self.assert_fault(links.check, "docs/a.md:2", "/tmp/")


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


class Citation(Tree):
    def test_each_value_is_compared(self):
        self.write("package.xml", "<package><version>0.1.0</version><license>MIT</license><author>a</author></package>")
        self.write("CHANGELOG.rst", "0.1.0 (2020-02-01)\n------------------\n")
        text = "version: 0.1.0\nlicense: MIT\nauthors:\n  - name: a\ndate-released: 2020-02-01\n"
        self.write("CITATION.cff", text)
        self.assert_clean(citation.check)
        for value, key in [("0.1.0", "version"), ("MIT", "license"), ("name: a", "authors"),
                           ("2020-02-01", "date-released")]:
            with self.subTest(key):
                self.write("CITATION.cff", text.replace(value, value + "1"))
                self.assert_fault(citation.check, key)


class Run(Tree):
    def test_exit_codes(self):
        for problems, code in [([], 0), (["a.cpp:1: wrong"], 1)]:
            with self.assertRaises(SystemExit) as ended, contextlib.redirect_stdout(io.StringIO()) as note:
                project.run(lambda root, found=problems: found, self.root)
            self.assertEqual(ended.exception.code, code)
            self.assertEqual(note.getvalue().splitlines()[:-1], problems)


if __name__ == "__main__":
    unittest.main(verbosity=2)
