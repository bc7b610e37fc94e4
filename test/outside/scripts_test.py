#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""The scripts in the built checkout: each has a help that starts and writes nothing; the README's first commands,
scripts/demo and scripts/demo --arm, end well and leave what they say.

Argument: the package's build directory, everything built.
"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

CHECKOUT = pathlib.Path(__file__).resolve().parents[2]
SCRIPTS = CHECKOUT / "scripts"
BUILD = os.path.abspath(sys.argv.pop(1))
SETUP = os.path.join(BUILD, "devel", "setup.bash")


class Scripts(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.out = folder.name

    def test_each_has_a_help(self):
        commands = [str(path) for folder in (SCRIPTS, CHECKOUT / "lab") for path in folder.rglob("*")
                    if path.is_file() and os.access(path, os.X_OK)]
        listed = re.findall(r"^  (\w+) {2,}\S", self.run_script(CHECKOUT / "lab" / "run", "--help").stdout, re.M)
        self.assertGreater(len(listed), 15)
        commands += [f"{CHECKOUT}/lab/run {name}" for name in listed]
        self.assertGreater(len(commands), 30)
        for command in commands:
            done = self.run_script("bash", "-c", f"source {SETUP} >&2; {command} --help", cwd=self.out, timeout=60)
            self.assertEqual(done.returncode, 0, f"{command}\n{done.stdout[-4000:]}")
            self.assertIn("usage", done.stdout.lower(), command)
            self.assertNotIn("Built target", done.stdout, command)
            self.assertEqual(os.listdir(self.out), [], command)

    def test_the_package_takes_no_files_beside_the_tracked_ones(self):
        tracked = ["CHANGELOG.rst", "CITATION.cff", "CONTRIBUTING.md", "LICENSE", "README.md", "docs/page.md",
                   "examples/a.cpp"]
        checkout = pathlib.Path(self.out) / "checkout"
        for name in [*tracked, "docs/own notes.md", "examples/build/own.o"]:
            (checkout / name).parent.mkdir(parents=True, exist_ok=True)
            (checkout / name).write_text(name)
        subprocess.run(["git", "init", "-q"], cwd=checkout, check=True)
        subprocess.run(["git", "add", *tracked], cwd=checkout, check=True)
        script = (SCRIPTS / "package").read_text()
        function = re.search(r"^install_documents\(\)\n\{.*?^\}", script, re.M | re.S).group()
        command = f"PACKAGE=name ROOT=$1 PROJECT_DIR=$2\n{function}\ninstall_documents"
        done = self.run_script("bash", "-ec", command, "-", os.path.join(self.out, "root"), str(checkout))
        self.assertEqual(done.returncode, 0, done.stdout)
        folder = pathlib.Path(self.out) / "root" / "usr" / "share" / "doc" / "name"
        self.assertEqual({str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file()},
                         {*tracked, "copyright"})

    @staticmethod
    def run_script(*command, **options):
        return subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False,
                              env=dict(os.environ, HJT_BUILD_DIR=BUILD), **options)

    def demo(self, *arguments):
        done = self.run_script(SCRIPTS / "demo", *arguments, "--out", self.out)
        self.assertEqual(done.returncode, 0, done.stdout[-4000:])
        return done.stdout

    def assert_left(self, *names):
        for name in names:
            self.assertGreater(os.path.getsize(os.path.join(self.out, name)), 10000, name)

    def test_a_drive_live(self):
        printed = self.demo()
        for line in ["simulated", "mesh force on a tooth, most", "on the response surface", "solver failures"]:
            self.assertIn(f"\n  {line}", printed)
        self.assert_left("demo_twin.bag", "demo_twin.png")

    def test_an_arm_sound_and_worn(self):
        self.demo("--arm")
        self.assert_left("arm_sound.csv", "arm_worn.csv", "arm.png")


if __name__ == "__main__":
    unittest.main(verbosity=2)
