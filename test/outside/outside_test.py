#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""A user of the installed package: every public header compiles alone, programs in C++ and Python make and step a twin,
the examples build and run; where libraries are missing, the package is configured without what needs them.

Argument: the package's build directory, everything built.
"""
import os
import subprocess
import sys
import tempfile
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))
EXAMPLES = os.path.join(os.path.dirname(os.path.dirname(HERE)), "examples")
BUILD = os.path.abspath(sys.argv.pop(1))


def run(*command, **options):
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False, **options)
    if done.returncode != 0:
        raise AssertionError(f"{' '.join(command)}\n{done.stdout[-4000:]}")
    return done.stdout


class OutsideUser(unittest.TestCase):
    def test_what_needs_a_missing_library_is_left_out_by_name(self):
        missing = ["HDF5", "pybind11"]
        with tempfile.TemporaryDirectory() as folder:
            environment = dict(os.environ, PATH=f"/usr/bin:/bin:{os.environ.get('PATH', '')}")
            configured = run("cmake", "-S", os.path.dirname(os.path.dirname(HERE)), "-B", folder,
                             *(f"-DCMAKE_DISABLE_FIND_PACKAGE_{name}=ON" for name in missing), env=environment)
            said = [line for line in configured.splitlines() if line.startswith("-- Left out: ")]
            self.assertEqual(len(said), 1, configured)
            for name in ["HDF5", "the Python module", *missing]:
                self.assertIn(name, said[0])
            targets = run("cmake", "--build", folder, "--target", "help")
            for target in ["joint_twin_node", "joint_twin", "joint_twin_complete"]:
                self.assertIn(f"... {target}\n", targets)
            self.assertNotIn("... _hjt\n", targets)

    def test_a_program_finds_the_package_and_steps_a_twin(self):
        with tempfile.TemporaryDirectory() as folder:
            prefix = os.path.join(folder, "prefix")
            build = os.path.join(folder, "build")
            run("cmake", "--install", BUILD, "--prefix", prefix)
            # Neither the checkout nor the development space may help.
            environment = {key: value for key, value in os.environ.items()
                           if key not in ("CMAKE_PREFIX_PATH", "CPATH", "LD_LIBRARY_PATH")}
            others = [path for path in os.environ.get("CMAKE_PREFIX_PATH", "").split(":")
                      if path and not path.startswith(BUILD)]
            environment["PATH"] = f"/usr/bin:/bin:{os.environ.get('PATH', '')}"  # Debian's Python, as in scripts/lib.sh
            environment["CMAKE_PREFIX_PATH"] = ":".join([prefix, *others])
            configured = run("cmake", "-S", HERE, "-B", build, "-DCMAKE_BUILD_TYPE=Release",
                             "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON", env=environment)
            self.assertIn("public headers", configured)
            with open(os.path.join(build, "compile_commands.json"), encoding="utf-8") as file:
                self.assertNotIn(f"-I{os.path.dirname(os.path.dirname(HERE))}", file.read())
            run("cmake", "--build", build, "--parallel", "2", env=environment)
            environment["LD_LIBRARY_PATH"] = os.path.join(prefix, "lib")
            output = run(os.path.join(build, "outside_user"),
                         os.path.join(prefix, "share", "harmonic_joint_twin", "config"), env=environment)
            self.assertIn("tooth forces 1", output)
            tool = os.path.join(prefix, "lib", "harmonic_joint_twin", "joint_twin")
            for words in ["--out", "drive.fmu"], ["--out", "arm.fmu", "--arm", "ur5"]:
                run(tool, "export", "--format", "fmu", *words, cwd=folder, env=environment)
            self.run_examples(folder, os.path.join(prefix, "share", "harmonic_joint_twin", "config"), environment)
            python = os.path.join(prefix, "lib", "python3", "dist-packages")
            environment["PYTHONPATH"] = os.pathsep.join(
                [python, *(path for path in os.environ.get("PYTHONPATH", "").split(os.pathsep)
                           if path and not path.startswith(BUILD))])
            output = run(sys.executable, os.path.join(HERE, "main.py"), cwd=folder, env=environment)
            self.assertIn(f"from {python}/harmonic_joint_twin, configuration of {prefix}", output)
            self.assertIn("teeth loaded 14", output)

    def run_examples(self, folder, configuration, environment):
        build = os.path.join(folder, "examples")
        run("cmake", "-S", EXAMPLES, "-B", build, "-DCMAKE_BUILD_TYPE=Release", env=environment)
        run("cmake", "--build", build, "--parallel", "2", env=environment)
        output = run(os.path.join(build, "step_twin"), configuration, env=environment)
        self.assertEqual(len(output.splitlines()), 5, output)
        output = run(os.path.join(build, "stiffness"), configuration, "5", "48", env=environment)
        self.assertRegex(output, "5 N.m: torsion -0.1615.*\n48 N.m: torsion -1.132.*32 teeth")
        recording = os.path.join(folder, "recording.csv")
        with open(recording, "w", encoding="utf-8") as file:
            file.write("time,motor_torque,load_torque,output_angle\n0.1,0.5,0,0\n0.2,0.5,10,0\n0.3,0,10,0.1\n")
        output = run(os.path.join(build, "follow_recording"), configuration, recording, env=environment)
        self.assertIn("3 rows, output angle off by", output)


if __name__ == "__main__":
    unittest.main(argv=sys.argv)
