#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""`joint_twin` gives the same bytes on processors with and without AVX2 and FMA, which qemu-x86_64 emulates.

Argument: joint_twin_complete itself, because what an emulated program starts is not emulated.
"""
import os
import platform
import shutil
import subprocess
import sys

import arm_twin_test
import sweep_test
import tool

PLAN = sweep_test.PLAN.replace("duration: 0.06", "duration: 0.03").replace("repeats: 3", "repeats: 1")
# A table of a small range, which is built as any other.
NARROW = ["--set", "output.load_torque_limit=20.0", "--set", "motor.torque_limit=0.19"]
# Of the C library the functions for processors without FMA, whose last digits are others.
WITHOUT_FMA = {"GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX2,-AVX2_Usable,-FMA,-FMA_Usable,-FMA4,-FMA4_Usable"}


class SameBytes(tool.ToolTest):
    def run_on(self, processor, *arguments, environment=None):
        """None: natively."""
        command = ["qemu-x86_64", "-cpu", processor] if processor else []
        done = subprocess.run([*command, self.executable, *arguments], cwd=self.directory, stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, universal_newlines=True, timeout=300 * tool.SLOWER, check=False,
                              env=dict(os.environ, **(environment or {})))
        self.assertEqual(done.returncode, 0, done.stderr)

    def assert_same(self, out, *arguments, own_cache=False):
        """`own_cache`: the tables that are built are compared as well."""
        for processor, environment in (("Haswell", {}), ("Nehalem", WITHOUT_FMA)):
            results = []
            for place in (None, processor):
                folder = f"{processor}_{place}"
                cache = {"XDG_CACHE_HOME": self.path(folder)} if own_cache else {}
                os.mkdir(self.path(folder))
                self.run_on(place, *arguments, "--out", os.path.join(folder, out),
                            environment={**cache, **(environment if place is None else {})})
                results.append(sweep_test.tree(self.path(folder)))
            self.assertTrue(any(name.startswith(out) for name in results[0]))
            self.assertEqual(any(name.endswith(".bin") for name in results[0]), own_cache)
            self.assertEqual(results[0].keys(), results[1].keys())
            for name, content in results[0].items():
                self.assertEqual(content, results[1][name], f"{processor}: {name}")

    def test_ring(self):
        self.assert_same("run.csv", "simulate", "--torque", "0.5", "--load", "5", "--duration", "0.02",
                         "--set", "solver.scene=full_ring")

    def test_table_built_and_read(self):
        self.assert_same("run.csv", "simulate", "--torque", "0.15", "--load", "5", "--duration", "0.5", "--set",
                         "solver.scene=auto", *NARROW, own_cache=True)

    def test_arm(self):
        arm_twin_test.write_motion(self.path("motion.csv"), duration=0.04)
        # The run lasts 0.7 s longer than the motion; the wrists need 3.9 kHz.
        self.assert_same("run.csv", "arm", "motion.csv", "--arm", "ur5", "--set", "solver.scene=full_ring", "--set",
                         "solver.rate=4000")

    def test_sweep(self):
        self.write("plan.yaml", PLAN)
        self.assert_same("set", "sweep", "plan.yaml", "--jobs", "1")


if __name__ == "__main__":
    if platform.machine() != "x86_64" or shutil.which("qemu-x86_64") is None:
        print("skipped: needs an x86-64 processor and qemu-x86_64")
        sys.exit(77)
    tool.main()
