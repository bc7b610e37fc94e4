# SPDX-License-Identifier: BSD-3-Clause
"""The command line: its name, kinds of options, what of it is refused, help, interrupts, what cannot be printed."""
import glob
import math
import os
import re
import signal
import subprocess
import sys
import time
import unittest

import tool

sys.path.append(os.path.join(tool.CHECKOUT, "test", "support"))
from processes import processor_time  # noqa: E402

PAIR = ["identify", "none.bag", "--joint", "1", "--train"]
PARTS = ("actual_q", "actual_qd", "actual_current", "target_moment")


def swings(rows):
    """PARTS of six joints that swing in a whole number of periods."""
    for row in range(rows):
        phases = [2.0 * math.pi * (joint + 2) * row / rows for joint in range(6)]
        yield ([0.4 * math.sin(phase) for phase in phases] +
               [0.4 * 2.0 * math.pi * (joint + 2) / (0.008 * rows) * math.cos(phase)
                for joint, phase in enumerate(phases)] +
               [math.copysign(0.5, math.cos(phase)) + 0.3 * math.sin(phase) for phase in phases] +
               [3.0 * math.sin(phase) for phase in phases])


class Options(tool.ToolTest):
    def torques(self, *arguments):
        return [row["torque"] for row in self.succeed_json("stiffness", *arguments)["rows"]]

    def test_values_follow_the_name_or_an_equals_sign(self):
        for arguments in [["--torques", "-5,6e0"], ["--torques=-5,6"], ["--torques", "-5", "6"],
                          ["--torques", "-5", "--torques", "6"]]:
            with self.subTest(arguments):
                self.assertEqual(self.torques(*arguments), [-5.0, 6.0])
        found = self.succeed_json("stiffness", "--torques", "5", "--angle", "-.5", "--json")
        self.assertEqual(found["wave_generator_angle"], -0.5)

    def test_a_repeated_option_takes_one_value_each_time(self):
        found = self.succeed_json("parameters", "--set", "solver.rate=20000.0", "--set", "gear.wave_amplitude=0.31e-3")
        self.assertEqual((found["solver"]["rate"], found["gear"]["wave_amplitude"]), (20000.0, 0.31e-3))
        self.fail_with(2, ["not expected: solver.rate=2000"], "insert", "--set", "solver.rate=1000", "solver.rate=2000")

    def test_arguments_may_stand_anywhere(self):
        self.write("-duty.csv", "")
        for arguments in [["none.bag", "--joint", "1", "--train", "1,2"],
                          ["--joint", "1", "--train", "1,2", "none.bag"],
                          ["--joint", "1", "--train", "1", "2", "none.bag"], ["--joint=1", "--", "none.bag"]]:
            with self.subTest(arguments):
                self.fail_with(1, ["none.bag cannot be read"], "identify", *arguments)
        self.fail_with(1, ["-duty.csv"], "life", "age", "--hours", "10", "--", "-duty.csv")

    def refuse(self, reason, *arguments):
        done = self.fail_with(2, [], *arguments)
        self.assertEqual(done.stderr, reason + "\nRun with --help for more information.\n")

    def test_wrong_values_are_refused(self):
        self.write("duty.csv", "")
        age = ["life", "age", "duty.csv"]
        stiffness = ["stiffness", "--torques"]
        for reason, arguments in [
                ("--torques: 1 required FLOAT missing", stiffness),
                ("--torques: '' is not a finite number", [*stiffness, "5,,6"]),
                ("--torques: '' is not a finite number", [*stiffness, "5,"]),
                ("--torques: 'many' is not a finite number", [*stiffness, "5,many"]),
                ("--angle: 'nan' is not a finite number", [*stiffness, "5", "--angle", "nan"]),
                ("--angle: '1e400' is not a finite number", [*stiffness, "5", "--angle", "1e400"]),
                ("--angle: 1 required FLOAT missing", [*stiffness, "5", "--angle", "--json"]),
                ("--angle: the number of values must be at most 1, but is 2",
                 [*stiffness, "5", "--angle", "1", "--angle", "2"]),
                ("--json does not take a value", [*stiffness, "5", "--json=no"]),
                ("--hours: '0' is not within 0.001 ... 1e+09", [*age, "--hours", "0"]),
                ("--positions: '1.5' is not a whole number within -2147483648 ... 2147483647",
                 [*age, "--positions", "1.5"]),
                ("--seed: '-1' is not a whole number within 0 ... 4294967295",
                 ["life", "trials", "duty.csv", "--seed", "-1"]),
                ("DUTY: File does not exist: none.csv", ["life", "age", "none.csv"]),
                ("DUTY: File is actually a directory: .", ["life", "age", "."]),
                ("--duration: '-1' is not more than 0", ["simulate", "--duration", "-1"]),
                ("--steps: '0' is not within 1 ... 1e+08",
                 ["turn", "--load", "1", "--angle-range", "1", "--steps", "0"]),
                ("--out: 'a.txt' must end in .bag or .csv", ["simulate", "--torque", "1", "--out", "a.txt"]),
                ("--joint: '6' is not a joint; the joints are base, shoulder, elbow, wrist_1, wrist_2, wrist_3, or 0 "
                 "to 5",
                 ["import", "a.csv", "--joint", "6", "--out", "a.bag"]),
                ("--format: foo is not one of {urdf,sdf,mjcf,fmu,fmu2}", ["export", "--format", "foo"]),
                ("--train: the number of values must be at least 2, but is 1", [*PAIR, "1"]),
                ("--train: the number of values must be at most 2, but is 3", [*PAIR, "1,2,3"]),
                ("--identified: Directory does not exist: none", ["identify", "a.bag", "--identified", "none"]),
                ("--shard: 'x' must be I/N with 0 <= I < N", ["sweep", "plan.yaml", "--shard", "x"])]:
            with self.subTest(arguments):
                self.refuse(reason, *arguments)

    def test_values_out_of_range_are_refused_by_every_command(self):
        self.write("duty.csv", "")
        for line in ("losses --speeds 10", "losses --loads 1", "losses --speeds nan --loads 1",
                     "losses --speeds 1 --loads 1 --positions 0", "hysteresis --amplitude -1 --lost-motion-torque 2",
                     "hysteresis --amplitude 1 --lost-motion-torque 2", "ratchet --lobe-stiffness 0",
                     "ratchet --lobe-stiffness nan", "ratchet --angle-step 0", "ratchet --torque-limit -5",
                     "ratchet --angle inf", "life trials duty.csv --lives 0", "transient --method euler",
                     "transient --step 0", "transient --step nan", "transient --duration -1", "dynamics --speed fast",
                     "dynamics --settle -1", "dynamics --every 0", "dynamics --load inf", "export --format dae",
                     "gear --size 1000 --out gear.yaml", "gear --ratio 7 --out gear.yaml"):
            with self.subTest(line):
                self.fail_with(2, [], *line.split())

    def test_wrong_combinations_are_refused(self):
        simulate = ["simulate", "--out", "a.bag"]
        for reason, arguments in [
                ("A subcommand is required", []),
                ("A subcommand is required", ["life"]),
                ("--torques is required", ["stiffness"]),
                ("recording is required", ["check"]),
                ("--teeth requires --json", ["stiffness", "--torques", "5", "--teeth"]),
                ("Exactly 1 option from [--torque,--profile] is required", simulate),
                ("Exactly 1 option from [--torque,--profile] is required and 2 were given",
                 [*simulate, "--duration", "1", "--torque", "1", "--profile", "a.csv"]),
                ("The following argument was not expected: --wing", ["--wing"]),
                ("The following argument was not expected: -x", ["insert", "-x"]),
                ("The following argument was not expected: --forc", ["insert", "--forc"]),
                ("The following argument was not expected: --wing=1", ["insert", "--wing=1"]),
                ("The following arguments were not expected: --wing b", ["insert", "--wing", "--", "b"])]:
            with self.subTest(arguments):
                self.refuse(reason, *arguments)

    def test_an_unknown_subcommand_is_refused(self):
        for arguments, reason in [(["xylophone"], "unknown subcommand 'xylophone'; `joint_twin --help` lists all"),
                                  (["stifness"], "unknown subcommand 'stifness', did you mean stiffness? "
                                                 "`joint_twin --help` lists all"),
                                  (["life", "agee"], "unknown subcommand 'agee', did you mean age? "
                                                     "`joint_twin life --help` lists all")]:
            self.assertEqual(self.fail_with(2, [], *arguments).stderr, f"joint_twin: {reason}\n")

    def test_help_shows_types_limits_and_defaults(self):
        column = "\n" + 30 * " "
        for arguments, parts in [
                (["stiffness"], ["torsion under load with the wave generator locked\n"
                                 "Usage: joint_twin stiffness [OPTIONS]\n",
                                 "\nOptions:\n  -h,--help                   Print this help message and exit\n",
                                 f"\n  --torques FLOAT ... REQUIRED{column}loads on",
                                 "\n  --angle FLOAT=0             wave generator angle [rad]\n",
                                 "\n  --teeth Needs: --json       with --json, add every tooth's",
                                 "\nCommon options:\n  --config FILE ...           YAML file"]),
                (["life", "trials"], ["Usage: joint_twin life trials [OPTIONS] DUTY\n",
                                      "\nPositionals:\n  DUTY TEXT:FILE REQUIRED     CSV file",
                                      "\n  --hours FLOAT=1e+06         longest duration of use [h]\n"]),
                (["remaining"], ["Usage: joint_twin remaining [OPTIONS] recordings...\n"]),
                (["identify"], ["\n  --train FLOAT x 2           from,to: part to identify from",
                                f"\n  --load TEXT:{{arm,target_moment}}=arm Needs: --arm{column}load of",
                                "\nExactly one of these options is required:\n  --joint TEXT                base"]),
                (["life"], ["Usage: joint_twin life [OPTIONS] SUBCOMMAND\n",
                            "\nStudies of the model:\n  age                         life of the nominal drive"])]:
            text = self.succeed(*arguments, "--help").stdout
            for part in parts:
                self.assertIn(part, text)
        self.assertEqual(self.succeed("insert", "--wings", "-h").stdout, self.succeed("insert", "--help").stdout)


class Process(tool.ToolTest):
    def test_a_signal_ends_a_long_computation_at_once(self):
        for number in [signal.SIGINT, signal.SIGTERM]:
            process = subprocess.Popen([self.executable, "turn", "--load", "20", "--angle-range", "100", "--steps",
                                        "1000000"], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                       preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))
            self.addCleanup(process.kill)
            self.assertIn(b"turning", process.stderr.readline())  # it is at work
            process.send_signal(number)
            process.communicate(timeout=20.0 * tool.SLOWER)
            self.assertEqual(process.returncode, -number)

    def long_recording(self, name):
        """Half an hour of an arm that swings."""
        block = [",".join(f"{value:.5f}" for value in row) for row in swings(1000)]
        with open(self.path(name), "w", encoding="ascii") as file:
            file.write(",".join(["timestamp"] + [f"{part}_{joint}" for part in PARTS
                                                 for joint in range(6)]) + "\n")
            file.writelines(f"{0.008 * row:.3f},{block[row % 1000]}\n" for row in range(225000))

    def test_the_first_signal_ends_each_reader_of_recordings_within_a_second(self):
        self.long_recording("long.csv")
        for arguments in (["check"], ["compare", "--arm", "ur5"], ["follow", "--arm", "ur5", "--out", "out.csv"],
                          ["identify", "--arm", "ur5", "--out", "out"],
                          ["trend", "long.csv", "--arm", "ur5"], ["import", "--joint", "2", "--out", "out.bag"]):
            with self.subTest(arguments):
                process = subprocess.Popen([self.executable, arguments[0], "long.csv", *arguments[1:]],
                                           cwd=self.directory, stdout=subprocess.DEVNULL)
                self.addCleanup(process.kill)
                while processor_time(process.pid) < 0.25 * tool.SLOWER:  # it reads
                    self.assertIsNone(process.poll())
                    time.sleep(0.01)
                self.end_within_a_second(process)

    def end_within_a_second(self, process):
        before = processor_time(process.pid)
        process.send_signal(signal.SIGINT)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        self.assertIn(process.returncode, (128 + signal.SIGINT, -signal.SIGINT))
        self.assertLess(usage.ru_utime + usage.ru_stime - before, 1.0 * tool.SLOWER)

    def test_identify_says_beforehand_how_long_it_takes_and_ends_within_a_fit(self):
        self.long_recording("long.csv")
        process = subprocess.Popen([self.executable, "identify", "long.csv", "--arm", "ur5", "--out", "out"],
                                   cwd=self.directory, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        self.addCleanup(process.kill)
        self.addCleanup(process.stderr.close)
        line = b""
        while b"identifying" not in line:
            line = process.stderr.readline()
            self.assertTrue(line, "nothing said")
        done, left = re.fullmatch(r"identifying: (\d+) %, (\d+) s left\n", line.decode()).groups()
        self.assertLess(int(done), 50)
        self.assertGreater(int(left), 0)
        self.end_within_a_second(process)
        self.assertEqual(os.listdir(self.path("out")), [])

    def test_output_that_cannot_be_written_is_a_failure(self):
        for arguments in [["stiffness", "--torques", "5", "--json"], ["faults"], ["--help"], ["check", "--help"],
                          ["export", "--format", "urdf"], ["parameters"]]:
            with self.subTest(arguments), open("/dev/full", "w", encoding="ascii") as full:
                done = subprocess.run([self.executable, *arguments], stdout=full, stderr=subprocess.PIPE,
                                      universal_newlines=True, check=False)
                self.assertEqual(done.returncode, 1, done.stderr)
                self.assertIn("joint_twin: standard output cannot be written", done.stderr)


class InputFiles(tool.ToolTest):
    def test_pipes_and_files_without_end_are_refused(self):
        os.mkfifo(self.path("pipe"))
        with open(self.path("sparse"), "wb") as file:
            file.truncate(3 << 30)
        arms = os.path.join(tool.CHECKOUT, "config", "arms")
        with open(os.path.join(arms, "ur5.yaml"), encoding="utf-8") as file:
            arm = file.read().replace("ur5.urdf", os.path.join(arms, "ur5.urdf"))
        self.write("rows.csv", "time\n0\n")
        for name, reason in (("pipe", "cannot be read: it is a directory, a device or a pipe"),
                             ("sparse", "cannot be read: it is larger than 10000000 bytes")):
            path = self.path(name)
            self.write("arm.yaml", arm.replace("[joints/base.yaml, ", f"[{path}, "))
            for arguments in (["parameters", "--config", path],
                              ["simulate", "--torque", "0", "--duration", "0.01", "--out", "a.csv", "--set",
                               "indicators.signatures=" + path],
                              ["check", "rows.csv", "--arm", "arm.yaml"]):
                with self.subTest(arguments):
                    self.fail_with(1, [path, reason], *arguments)


class OutputFiles(tool.ToolTest):
    SIMULATE = ["simulate", "--torque", "0.2", "--out", "out.csv", "--force", "--duration"]

    def test_a_failure_keeps_the_earlier_file(self):
        self.write("out.csv", "precious")
        self.fail_with(1, ["out.csv would be empty"], *self.SIMULATE, "0.02", "--set", "publish.joint_states_rate=10")
        self.assertEqual(os.listdir(self.directory), ["out.csv"])
        self.assertEqual(tool.read_bytes(self.path("out.csv")), b"precious")

    def test_what_was_recorded_before_a_kill_stands_beside_the_earlier_file(self):
        self.write("out.csv", "precious")
        process = subprocess.Popen([self.executable, *self.SIMULATE, "1000"], cwd=self.directory,
                                   stderr=subprocess.DEVNULL)
        self.addCleanup(process.kill)
        self.write("out.csv.part", "precious too")
        deadline = time.monotonic() + 30.0 * tool.SLOWER
        parts = []
        while not parts or os.path.getsize(parts[0]) < 20000:
            self.assertLess(time.monotonic(), deadline, "nothing written")
            time.sleep(0.01)
            parts = glob.glob(self.path("out.csv.*.part"))
        part = parts[0]
        self.assertEqual(tool.read_bytes(self.path("out.csv.part")), b"precious too")
        process.kill()
        process.communicate()
        self.assertEqual(tool.read_bytes(self.path("out.csv")), b"precious")
        self.assertTrue(tool.read_bytes(part).startswith(b"time,"))

    def test_links_and_pipes_are_written_through(self):
        self.write("there.csv", "old")
        os.symlink("there.csv", self.path("link.csv"))
        insert = ["insert", "--force", "--csv"]
        self.succeed(*insert, "link.csv")
        self.assertTrue(os.path.islink(self.path("link.csv")))
        self.assertTrue(tool.read_bytes(self.path("there.csv")).startswith(b"tooth,"))
        self.assertIn(tool.read_bytes(self.path("there.csv")).decode(), self.succeed(*insert, "/dev/stdout").stdout)
        self.assertEqual(sorted(os.listdir(self.directory)), ["link.csv", "there.csv"])

    def test_a_link_or_a_pipe_at_the_name_of_a_bag_in_work_is_refused(self):
        self.write("victim", "precious")
        os.symlink("victim", self.path("link.bag.active"))
        os.mkfifo(self.path("pipe.bag.active"))
        for name, reason in (("link", ""), ("pipe", ", because it is not a regular file")):
            self.fail_with(1, [f"{name}.bag.active cannot be written{reason}"], "simulate", "--torque", "0.2",
                           "--duration", "0.02", "--out", f"{name}.bag")
        self.assertEqual(tool.read_bytes(self.path("victim")), b"precious")

    def test_a_full_disk_is_named_and_leaves_no_empty_file(self):
        self.fail_with(1, ["/dev/full cannot be written: No space left on device\n"], "insert", "--csv", "/dev/full",
                       "--force")
        done = self.run_with_file_limit(0, "gear", "--size", "14", "--ratio", "80", "--out", "gear.yaml")
        self.assertEqual(done.returncode, 1)
        self.assertIn("gear.yaml cannot be written", done.stderr)
        done = self.run_with_file_limit(1000, "insert", "--csv", "ring.csv")
        self.assertIn("ring.csv cannot be written: File too large", done.stderr)
        self.assertNotIn("gear.yaml", os.listdir(self.directory))
        self.assertNotIn("ring.csv", os.listdir(self.directory))


class Path(tool.ToolTest):
    def source_and_run(self, command):
        setup = os.path.join(os.path.dirname(self.executable), "..", "..", "setup.bash")
        environment = {name: os.environ[name] for name in ("HOME", "PATH") if name in os.environ}
        return subprocess.run(["bash", "-c", f"source '{setup}' && {command}"], stdin=subprocess.DEVNULL, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, env=environment, check=False)

    def assert_runs(self, command):
        done = self.source_and_run(command)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertEqual(done.stdout, self.succeed("--help").stdout)

    def test_shell(self):
        self.assert_runs("joint_twin --help")

    @unittest.skipIf(os.path.isdir(os.path.join(tool.CHECKOUT, "build-sanitize")), "two builds: rosrun would ask which")
    def test_rosrun(self):
        self.assert_runs("rosrun harmonic_joint_twin joint_twin --help")


if __name__ == "__main__":
    tool.main()
