#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""The README's first commands, scripts/demo and scripts/demo --arm, in the built checkout: they end well and leave what they
say.

Argument: the package's build directory, everything built.
"""
import os
import subprocess
import sys
import tempfile
import unittest

DEMO = os.path.join(os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))), "scripts", "demo")
BUILD = os.path.abspath(sys.argv.pop(1))


class Demo(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.out = folder.name

    def demo(self, *arguments):
        done = subprocess.run([DEMO, *arguments, "--out", self.out], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              text=True, check=False, env=dict(os.environ, HJT_BUILD_DIR=BUILD))
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
