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

import clang_tidy
import config_files
import descriptions
import doc_tables
import layering
import limits
import pages
import project
import sources

LONG = "  f();\n" * (limits.FUNCTION_LINES + 1)
PYTHON = "class A:\n    def g():\n%s" % LONG.replace("  f();", "        f()")
CITATION = "version: 0.1.0\nlicense: MIT\nauthors:\n  - name: a\ndate-released: 2020-02-01\n"
NODE = '<launch><node name="twin"{}><param name="arm" value="ur5"/></node></launch>'
TEETH = "gear:\n  # Length{}.\n  length: {}\n"
MEMBER = "class A\n{{\n  {}  // of the drive\n}};\n"
GEAR, ROS_IO = "src/gear/one.cpp", "src/ros_io/one.cpp"
STAGE = '<rosparam command="load" file="$(arg config)/{}.yaml"/>'
STAGES = {"config/a.yaml": TEETH.format(" [m]", "1.0"), "config/stages": "# Files.\na.yaml\nb.yaml\n"}


def includes(*headers):
    return "#include <vector>\n" + "".join(f"#include {header}\n" for header in headers)


# Check, files that lie beside the one that changes, its path, faultless texts, other texts with words of their fault.
CASES = [
    (sources.number_locale, {}, GEAR, ['printf("%.0f %% friction, %s", x, y);\n'],
     [(f"\n{line}\n", f"{GEAR}:2") for line in ("x = strtod(text, nullptr);", 'printf("%6.2f N", x);',
                                                "std::ostringstream text;", "node.as<double>();")]),
    (limits.check, {}, "src/one.cpp", ["namespace a\n{\nint f(int a,\n  int b)\n{\n%s}\n}\n" % LONG[7:], "\n" * 700],
     [("namespace a\n{\nint f(int a,\n  int b)\n{\n%s}\n}\n" % LONG, "src/one.cpp:5: function of 61 lines"),
      ("\n" * 701, "src/one.cpp:1: 701 lines")]),
    (limits.check, {}, "src/one.hpp", ["class B : public C\n{\n%s};\n" % LONG.replace("f()", "int a")],
     [("struct A\n{\n  void f()\n  {\n%s  }\n};\n" % LONG, "src/one.hpp:4: function of 61 lines")]),
    (limits.check, {}, "scripts/one.py", [PYTHON[:-12]], [(PYTHON, "scripts/one.py:2: function of 61 lines")]),
    (limits.check, {}, "scripts/one", ["\n" * 701], [("#!/usr/bin/env bash\n" + "\n" * 700, "scripts/one:1: 701")]),
    (sources.kept_parameters, {path: "Parameters values_;\n" for path in sources.HOLDERS}, "src/one.hpp",
     ["struct A\n{\n  explicit A(const Parameters& of) : life_(of.life) {}\n  double of(const Parameters& of) const "
      "{ return a_; }\n  // Parameters all_;\n  LifeParameters life_;\n  Parameters all;\n};\n"],
     [(MEMBER.format(member), "all_") for member in (
         "Parameters all_;", "const Parameters& all_;", "std::optional<Parameters> all_{};",
         "std::map<int, const Parameters*> all_;", "std::vector<\n      Parameters>\n      all_;")]),
    (sources.kept_parameters, {path: "Parameters values_;\n" for path in sources.HOLDERS}, "src/twin/one.hpp",
     [MEMBER.format("Parameters all_;")], []),
    (sources.kept_parameters, {path: "Parameters values_;\n" for path in sources.HOLDERS}, "src/fmu/arm_unit.cpp",
     [MEMBER.format("Parameters all_;")], [("\n", "src/fmu/arm_unit.cpp:1")]),
    (layering.check, {}, GEAR,
     [includes('"harmonic_joint_twin/params/parameters.hpp"', "<Eigen/Core>", '"base/number_text.hpp"')],
     [(includes(header), f"{GEAR}:2: ") for header in (
         '"solver/newton.hpp"', "<ros/time.h>", '"harmonic_joint_twin/Health.h"', "<sensor_msgs/JointState.h>",
         '"ellipse.hpp"', '"stray/a.hpp"', "<kdl/frames.hpp>")] + [("std::ofstream out(path);\n", "for writing")]),
    (layering.check, {}, ROS_IO,
     [includes('"harmonic_joint_twin/twin/twin.hpp"', "<ros/ros.h>", '"harmonic_joint_twin/Health.h"')],
     [(includes('"studies/life_trials.hpp"'), f"{ROS_IO}:2: ")]),
    (layering.check, {}, "src/arm/one.cpp", [includes("<kdl/frames.hpp>")], []),
    (layering.check, {}, "src/apps/common/one.cpp", [includes('"output/progress.hpp"')],
     [(includes('"apps/tool/commands.hpp"'), "apps/tool/commands.hpp")]),
    (layering.check, {}, "test/ros/one.cpp", [""], [('#include "apps/tool/commands.hpp"\n', "test/ros/one.cpp:1")]),
    (layering.check, {}, "include/harmonic_joint_twin/gear/angle.hpp", [""],
     [("#include <ros/ros.h>\n", "angle.hpp:1"), ('#include "gear/ellipse.hpp"\n', "no public header")]),
    (layering.check, {}, "src/output/one.cpp", ["#include <fstream>\nstd::ifstream in(path);\n"],
     [(line + "\n", "src/output/one.cpp:1: opens a file for writing") for line in (
         "std::ofstream out(path);", 'FILE* file = std::fopen(path, "r");', "open(name, O_RDWR | O_CREAT);",
         "bag.open(path, rosbag::bagmode::Write);", "H5Fcreate(name, H5F_ACC_TRUNC, 0, 0);")]),
    (layering.check, {}, "src/output/output_file.cpp", ["std::ofstream out(path);\n"], []),
    (layering.check, {}, "src/misc/one.cpp", [], [("", "src/misc/one.cpp")]),
    (layering.check, {}, "docs/a.md", [], [("", "no sources")]),
    (sources.type_names, {"include/harmonic_joint_twin/twin/one.hpp": "struct Forces\n{\n};\n"}, "src/two.hpp",
     ["struct Forces;\nstruct Forces::Part\n{\n};\nnamespace\n{\nstruct Forces\n{\n};\n}  // namespace\n"],
     [("class Forces\n{\n};\n", "one.hpp:1")]),
    *((descriptions.spdx, {"README.md": "text\n", "build/generated.cpp": "int i;\n"}, path,
       [f"// {descriptions.LICENCE}\n", f"#!/bin/sh\n# {descriptions.LICENCE}\n"],
       [("\n\n\n" + descriptions.LICENCE, path)])
      for path in ("src/one.cpp", "scripts/run", "msg/A.msg", "launch/a.launch", "config/a.yaml", "CMakeLists.txt")),
    (config_files.check, {}, "config/a.yaml",
     [TEETH.format(" [m]", value) for value in ("1.0e-3", "5", "0.25", "[31.0e+3, 50.0e+3]", "name", '"1e-3"', "true")],
     [(TEETH.format("", "0.25"), "unit")] + [(TEETH.format(" [m]", value), "config/a.yaml:3: gear.length: ")
                                             for value in ("1e-3", "1e3", "1.0e4", "[31.0e+3, 5e4]")]),
    (config_files.check, STAGES, "launch/twin.launch", [STAGE.format("a") + STAGE.format("b")],
     [(STAGE.format("b") + STAGE.format("a"), "stages")]),
    (descriptions.message_comments, {}, "msg/A.msg",
     ["# Of one instant.\nuint8 OK=0  # all is well\nfloat64[] force  # per tooth [N]\n"],
     [(line + "\n", "msg/A.msg:1") for line in ("float64 force", "float64 force  # per tooth", "uint8 OK=0",
                                                "float64[2] a  # []")]),
    (descriptions.launch_docs, {}, "launch/a.launch",
     ['<launch><arg name="bag" doc="Recording."/><arg name="folder" value="config"/><include file="b.launch">'
      '<arg name="bag" value="$(arg bag)"/></include></launch>', NODE.format(' clear_params="true"')],
     [('<launch><arg name="bag" default=""/></launch>', "'bag'"), (NODE.format(""), "parameters and no clear_params")]),
    (pages.check_links, {"docs/b.md": "# Two words, `code`\n\n## Same\n\n## Same\n", "docs/images/a.png": "",
                         "src/gear/angle.hpp": ""}, "README.md",
     ["[b](docs/b.md), [head](docs/b.md#two-words-code), [again](docs/b.md#same-1), [own](#own) mnt/tmp/x\n"
      "[![a](docs/images/a.png)](docs/b.md) [web](https://example.org/x) <img src='docs/images/a.png'>\n"
      "# Own\n\n```\n[none](none.md)\n```\nand `[none](none.md)`\n"],
     [(f"\n{text}\n", f"README.md:2: {word}") for text, word in (
         ("[b](b.md)", "no such file: b.md"), ("![a](docs/a.png)", "no such file: docs/a.png"),
         ("[b](docs/b.md#tail)", "no such heading: docs/b.md#tail"), ("[own](#tail)", "no such heading: #tail"),
         ("[![a](docs/a.png)](docs/b.md)", "no such file: docs/a.png"), ('<img src="a.png">', "no such file: a.png"),
         ("[root](/etc/hostname)", "no such file: /etc/hostname"), ("[up](../README.md)", "no such file: ../README.md"),
         ("`gear/angel`", "no such source: gear/angel"), ("insert --csv /tmp/validate.x/a.csv", "a temporary path"))]),
    (descriptions.citation,
     {"package.xml": "<package><version>0.1.0</version><license>MIT</license><author>a</author></package>",
      "CHANGELOG.rst": "0.1.0 (2020-02-01)\n------------------\n"}, "CITATION.cff", [CITATION],
     [(CITATION.replace(value, value + "1"), key) for value, key in (
         ("0.1.0", "version"), ("MIT", "license"), ("name: a", "authors"), ("2020-02-01", "date-released"))]),
    (pages.check_values, {"docs/validation.csv": "row,value,unit,expected,holds,class\na.b,0.156,%,,no,fit\n"},
     "README.md",
     ["0.16<!-- value: a.b --> and 156<!-- value: a.b * 1000 --> | 0.2<!-- value: a.b --> |\n1<!-- value: rows --> "
      "1<!-- value: rows.fail --> 1<!-- value: rows.fit --> 0<!-- value: rows.fit.hold -->\n"],
     [(f"0.156<!-- value: a.b -->\n{text}\n", "README.md:2") for text in (
         "0.15<!-- value: a.b -->", "0.156<!-- value: a.b * 100 -->", "0.16<!-- value: a.c -->",
         "so<!-- value: a.b -->")]),
]


class Tree(unittest.TestCase):
    """A package of a few files in a temporary folder."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = self.folder = folder.name

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


class Checks(Tree):
    def test_speak_up_on_faults_alone(self):
        for number, (check, beside, path, sound, faulty) in enumerate(CASES):
            self.root = os.path.join(self.folder, str(number))
            for name, text in beside.items():
                self.write(name, text)
            for text in sound:
                with self.subTest(number=number, path=path, text=text):
                    self.write(path, text)
                    self.assert_clean(check)
            for text, words in faulty:
                with self.subTest(number=number, path=path, text=text):
                    self.write(path, text)
                    self.assert_fault(check, words)

    def test_a_header_of_another_page_is_named(self):
        files = {file: project.text(project.ROOT, file) for file in ("docs/health.md", "docs/health_kinds.csv")}
        header = descriptions.assessment_counts.header(*files.values())
        for file, text in files.items():
            self.write(file, text)
        self.write("src/life/assessment_counts.hpp", header)
        self.assert_clean(descriptions.life_counts)
        self.write("src/life/assessment_counts.hpp", header.replace("SOUND_RUNS = 1", "SOUND_RUNS = 2"))
        self.assert_fault(descriptions.life_counts, "src/life/assessment_counts.hpp")


class DocTables(Tree):
    TABLE = [["parameter", "unit"], ["gear.teeth", "-"], ["motor.torque_limit", "N.m"]]

    def test_rows_of_the_tool(self):
        printed = ["| parameter | unit |", "|---|---|", "| `gear.teeth` | - |", "| `motor.torque_limit` | N.m |"]
        self.assertEqual(doc_tables.parameter_rows(printed), self.TABLE)
        self.write(doc_tables.PARAMETERS, "")
        for rows, words in ((self.TABLE, None), (self.TABLE[:2], "missing: motor.torque_limit"),
                            (self.TABLE + [["motor.colour", "-"]], "motor.colour"),
                            (self.TABLE[:1] + self.TABLE[:0:-1], "order")):
            doc_tables.write_parameters(self.root, rows)
            found = doc_tables.check_parameters(self.root, self.TABLE)
            self.assertEqual(len(found), 1 if words else 0, found)
            self.assertIn(words or "", "".join(found))

    def test_names_and_types(self):
        page = ("### Services\n\n| service | type |\n|---|---|\n| `~reset` | std_srvs/Trigger | x |\n\n"
                "## Next\n| `~a` | b/C |")
        self.assertEqual(doc_tables.names_and_types(page, "Services"), {"~reset": "std_srvs/Trigger"})
        with self.assertRaises(ValueError):
            doc_tables.names_and_types(page, "Topics")


class ClangTidy(Tree):
    def setUp(self):
        super().setUp()
        self.root = os.path.realpath(self.root)
        environment = unittest.mock.patch.dict(os.environ, XDG_CACHE_HOME=os.path.join(self.root, "cache"))
        environment.start()
        self.addCleanup(environment.stop)
        shutil.copy(os.path.join(project.ROOT, ".clang-tidy"), self.root)

    def problems_of(self, file, options):
        """Of a build that compiles the file with these options."""
        command = ["c++", "-std=c++17", *options, "-o", "one.o", "-c", file]
        self.write("build/compile_commands.json",
                   json.dumps([{"directory": self.root, "file": file, "arguments": command}]))
        self.printed = io.StringIO()
        try:
            with contextlib.redirect_stdout(self.printed):
                return clang_tidy.check(os.path.join(self.root, "build"), self.root)
        except SystemExit:  # by project.skip
            self.skipTest(self.printed.getvalue().split("skipped: ")[-1].strip())

    def problems(self, content, options=()):
        return self.problems_of(self.write("src/one.cpp", content), options)

    def assert_checked(self, checked, *arguments):
        """The file is clean; `checked`: the tool had to run to find that out."""
        self.assertEqual(self.problems(*arguments), [])
        self.assertEqual(self.printed.getvalue(), f"src/one.cpp: {'clean' if checked else 'known to be clean'}\n")

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
        return self.problems_of(
            self.write("build/Unity/unity_0_cxx.cxx", f'#include "{one}"\n#include "{two}"\n'), ())

    def test_source_of_a_unity_build_is_checked_alone(self):
        problems = self.problems_of_a_unity_build("#include <vector>\nstd::vector<int> one();\n",
                                                  "std::vector<int> two();\n")
        self.assertEqual(self.printed.getvalue(), "src/one.cpp: clean\nsrc/two.cpp: FAULTS\n")
        self.assertIn("vector", "".join(problems))

    def test_sources_of_a_unity_build_are_checked_at_once_in_their_turn(self):
        for is_turn, said, fault in ((True, "src/one.cpp and what is compiled with it: FAULTS\n", "Read"),
                                     (False, "src/two.cpp: clean\nUnchanged files are left to other commits\n", "")):
            turn = {"src/two.cpp"}, lambda path, answer=is_turn: answer
            with unittest.mock.patch.object(clang_tidy, "turn", lambda root, found=turn: found):
                problems = self.problems_of_a_unity_build("int Read();\n", "int two();\n")
            self.assertEqual(self.printed.getvalue(), said)
            self.assertEqual((len(problems), fault in "".join(problems)), (int(is_turn), True))

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


class Run(Tree):
    def test_exit_codes(self):
        for problems, code in [([], 0), (["a.cpp:1: wrong"], 1)]:
            with self.assertRaises(SystemExit) as ended, contextlib.redirect_stdout(io.StringIO()) as note:
                project.run(lambda root, found=problems: found, self.root)
            self.assertEqual(ended.exception.code, code)
            self.assertEqual(note.getvalue().splitlines()[:-1], problems)


if __name__ == "__main__":
    unittest.main(verbosity=2)
