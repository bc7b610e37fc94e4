# SPDX-License-Identifier: BSD-3-Clause
"""Each check of this folder passes on a faultless file and speaks up on a faulty one."""
import contextlib
import io
import os
import unittest

import citation
import config_files
import doc_tables
import doc_values
import examples
import kept_parameters
import launch_docs
import layering
import life_counts
import limits
import links
import message_comments
import number_locale
import project
import spdx
import type_names
from tree import Tree


class NumberLocale(Tree):
    def test_what_depends_on_the_locale_is_named(self):
        for line in ("x = strtod(text, nullptr);", 'printf("%6.2f N", x);', "std::ostringstream text;",
                     "node.as<double>();"):
            with self.subTest(line):
                self.write("src/gear/one.cpp", f"\n{line}\n")
                self.assert_fault(number_locale.check, "src/gear/one.cpp:2")
        self.write("src/gear/one.cpp", 'printf("%.0f %% friction, %s", x, y);\n')
        self.assert_clean(number_locale.check)


class LifeCounts(Tree):
    def test_a_header_of_another_page_is_named(self):
        files = {file: project.text(project.ROOT, file) for file in ("docs/health.md", "docs/health_kinds.csv")}
        header = life_counts.script.header(*files.values())
        for file, text in files.items():
            self.write(file, text)
        self.write("src/life/assessment_counts.hpp", header)
        self.assert_clean(life_counts.check)
        self.write("src/life/assessment_counts.hpp", header.replace("SOUND_RUNS = 1", "SOUND_RUNS = 2"))
        self.assert_fault(life_counts.check, "src/life/assessment_counts.hpp")


class Limits(Tree):
    LONG = "  f();\n" * (limits.FUNCTION_LINES + 1)

    def test_long_functions_are_named(self):
        for path, text, line in [
                ("src/one.cpp", "namespace a\n{\nint f(int a,\n  int b)\n{\n%s}\n}  // namespace a\n" % self.LONG, 5),
                ("src/one.hpp", "struct A\n{\n  void f()\n  {\n%s  }\n};\n" % self.LONG, 4),
                ("scripts/one.py", "class A:\n    def g():\n%s" % self.LONG.replace("  f();", "        f()"), 2)]:
            with self.subTest(path):
                full = self.write(path, text)
                self.assert_fault(limits.check, f"{path}:{line}:", "function of 61 lines")
                self.write(path, text.replace(text.split("\n")[line] + "\n", "", 1))
                self.assert_clean(limits.check)
                os.remove(full)

    def test_long_types_and_namespaces_are_not(self):
        rows = "  int a;\n" * (limits.FUNCTION_LINES + 1)
        self.write("src/one.hpp", f"namespace a\n{{\nclass B : public C\n{{\n{rows}}};\n}}  // namespace a\n")
        self.assert_clean(limits.check)

    def test_long_files_are_named(self):
        for path, first in [("src/one.cpp", "\n"), ("scripts/one", "#!/usr/bin/env bash\n"), ("test/one.py", "\n")]:
            with self.subTest(path):
                full = self.write(path, first + "\n" * limits.FILE_LINES)
                self.assert_fault(limits.check, f"{path}:1: {limits.FILE_LINES + 1} lines")
                os.remove(full)
        self.write("docs/one.md", "\n" * (limits.FILE_LINES + 1))
        self.assert_clean(limits.check)


class KeptParameters(Tree):
    def setUp(self):
        super().setUp()
        for path in kept_parameters.HOLDERS:
            self.write(path, "class A\n{\n  Parameters values_;\n};\n")

    def test_members_that_hold_all_are_named(self):
        for member in ["Parameters all_;", "const Parameters& all_;", "std::optional<Parameters> all_{};",
                       "std::map<int, const Parameters*> all_;", "std::vector<\n      Parameters>\n      all_;"]:
            with self.subTest(member):
                self.write("src/one.hpp", f"class A\n{{\n  {member}  // of the drive\n}};\n")
                self.assert_fault(kept_parameters.check, "src/one.hpp:", "all_")
                self.write("src/twin/one.hpp", project.text(self.root, "src/one.hpp"))
                os.remove(os.path.join(self.root, "src/one.hpp"))
                self.assert_clean(kept_parameters.check)

    def test_groups_arguments_and_plain_structs_are_not(self):
        self.write("src/one.hpp", "struct A\n{\n  explicit A(const Parameters& of) : life_(of.life) {}\n"
                                  "  double of(const Parameters& of) const { return a_; }\n"
                                  "  // Parameters all_;\n  LifeParameters life_;\n  Parameters all;\n};\n")
        self.assert_clean(kept_parameters.check)

    def test_a_reason_without_its_class_is_named(self):
        self.write("src/fmu/arm_unit.cpp", "\n")
        self.assert_fault(kept_parameters.check, "src/fmu/arm_unit.cpp:1")


class Layering(Tree):
    def source(self, folder, header):
        self.write(f"src/{folder}/one.cpp", f"#include <vector>\n#include {header}\n")

    def test_what_a_folder_sees_is_allowed(self):
        for folder, header in [("gear", '"harmonic_joint_twin/params/parameters.hpp"'), ("gear", "<Eigen/Core>"),
                               ("gear", '"base/number_text.hpp"'), ("ros_io", '"harmonic_joint_twin/twin/twin.hpp"'),
                               ("ros_io", "<ros/ros.h>"), ("ros_io", '"harmonic_joint_twin/Health.h"'),
                               ("arm", "<kdl/frames.hpp>"), ("apps/tool", '"output/progress.hpp"')]:
            with self.subTest(folder=folder, header=header):
                self.source(folder, header)
                self.assert_clean(layering.check)

    def test_all_else_is_not(self):
        for folder, header in [("params", '"gear/angle.hpp"'), ("twin", "<ros/time.h>"),
                               ("sensors", '"health/health_monitor.hpp"'), ("ros_io", '"studies/life_trials.hpp"'),
                               ("apps/common", '"apps/tool/commands.hpp"'), ("twin", '"harmonic_joint_twin/Health.h"'),
                               ("model", "<sensor_msgs/JointState.h>"), ("solver", '"newton.hpp"'),
                               ("solver", '"stray/a.hpp"'), ("twin", "<kdl/frames.hpp>")]:
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

    def test_files_are_opened_for_writing_by_few(self):
        for line in ["std::ofstream out(path);", 'FILE* file = std::fopen(path, "r");', "open(name, O_RDWR | O_CREAT);",
                     "bag.open(path, rosbag::bagmode::Write);", "H5Fcreate(name, H5F_ACC_TRUNC, 0, 0);"]:
            with self.subTest(line):
                self.write("src/output/one.cpp", line + "\n")
                self.assert_fault(layering.check, "src/output/one.cpp:1", "for writing")
                self.write("src/output/one.cpp", "#include <fstream>\nstd::ifstream in(path);\n")
                self.write("src/output/output_file.cpp", line + "\n")
                self.assert_clean(layering.check)

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
    TABLE = [["parameter", "unit"], ["gear.teeth", "-"], ["motor.torque_limit", "N.m"]]

    def check(self, root):
        return doc_tables.check_parameters(root, self.TABLE)

    def file(self, rows):
        doc_tables.write_parameters(self.root, rows)

    def test_rows_of_the_tool(self):
        printed = ["| parameter | unit |", "|---|---|", "| `gear.teeth` | - |", "| `motor.torque_limit` | N.m |"]
        self.assertEqual(doc_tables.parameter_rows(printed), self.TABLE)

    def test_same_table(self):
        self.write(doc_tables.PARAMETERS, "")
        self.file(self.TABLE)
        self.assert_clean(self.check)

    def test_missing_surplus_and_order(self):
        self.write(doc_tables.PARAMETERS, "")
        self.file(self.TABLE[:2])
        self.assert_fault(self.check, "missing", "motor.torque_limit")
        self.file(self.TABLE + [["motor.colour", "-"]])
        self.assert_fault(self.check, "motor.colour")
        self.file(self.TABLE[:1] + self.TABLE[:0:-1])
        self.assert_fault(self.check, "order")

    def test_names_and_types(self):
        page = ("### Services\n\n| service | type |\n|---|---|\n| `~reset` | std_srvs/Trigger | x |\n\n"
                "## Next\n| `~a` | b/C |")
        self.assertEqual(doc_tables.names_and_types(page, "Services"), {"~reset": "std_srvs/Trigger"})
        with self.assertRaises(ValueError):
            doc_tables.names_and_types(page, "Topics")


class DocValues(Tree):
    def setUp(self):
        super().setUp()
        self.write("docs/validation.csv", "row,value,unit,expected,holds,class\na.b,0.156,%,,no,fit\n")

    def test_numbers_as_the_validation_has_them(self):
        self.write("README.md",
                   "0.16<!-- value: a.b --> and 156<!-- value: a.b * 1000 --> | 0.2<!-- value: a.b --> |\n"
                   "1<!-- value: rows --> 1<!-- value: rows.fail --> 1<!-- value: rows.fit --> "
                   "0<!-- value: rows.fit.hold -->\n")
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
        self.write("src/gear/angle.hpp", "")
        for text, word in [("[b](b.md)", "b.md"), ("![a](docs/a.png)", "docs/a.png"), ("[b](docs/b.md#tail)", "#tail"),
                           ("[own](#tail)", "#tail"), ("[![a](docs/a.png)](docs/b.md)", "docs/a.png"),
                           ('<img src="a.png">', "a.png"), ("[root](/etc/hostname)", "/etc/hostname"),
                           ("[up](../README.md)", "../README.md"), ("`gear/angel`", "no such source: gear/angel")]:
            with self.subTest(text=text):
                self.write("README.md", f"\n{text}\n")
                self.assert_fault(links.check, "README.md:2", word)


class TemporaryPaths(Tree):
    def test_pages_hold_none(self):
        self.write("docs/a.md", "joint_twin insert --csv insertion.csv, mnt/tmp/x\n")
        self.assert_clean(links.check)
        self.write("docs/a.md", "# A\njoint_twin insert --csv /tmp/validate.x/insertion.csv\n")
        self.assert_fault(links.check, "docs/a.md:2", "/tmp/")


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
