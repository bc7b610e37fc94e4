# SPDX-License-Identifier: BSD-3-Clause
"""What the tests of the offline tool share: running it, and small recordings to feed it."""
import csv
import json
import math
import os
import resource
import shutil
import subprocess
import sys
import tempfile
import time
import unittest

import genpy
import numpy as np
import rosbag
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64

CHECKOUT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
JOINT_NAMES = ["shoulder_pan_joint", "shoulder_lift_joint", "elbow_joint",
               "wrist_1_joint", "wrist_2_joint", "wrist_3_joint"]
SIMULATED_TOPICS = {"/joint_twin/joint_states", "/joint_twin/encoders", "/joint_twin/contact_forces",
                    "/joint_twin/health", "/joint_twin/stress", "/joint_twin/indicators", "/joint_twin/assessment"}
START = 1000000000  # [s] ROS time at which the recordings made here begin
# With it `--report` writes its data and another program's page is not drawn, which takes seconds for each joint.
NO_PAGE = {"PYTHONPATH": os.path.join(CHECKOUT, "test", "support", "no_page")}
SLOWER = float(os.environ.get("HJT_PATIENCE", "1"))  # factor on every time limit; above 1 under a sanitizer


class ToolTest(unittest.TestCase):
    """A test in an empty directory of its own."""
    executable = None

    def setUp(self):
        self.directory = tempfile.mkdtemp(prefix="joint_twin_test_")
        self.addCleanup(shutil.rmtree, self.directory)

    def path(self, name):
        return os.path.join(self.directory, name)

    def run_tool(self, *arguments, environment=None):
        return subprocess.run([self.executable, *map(str, arguments)], cwd=self.directory, stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, universal_newlines=True, timeout=900 * SLOWER, check=False,
                              env=dict(os.environ, **(environment or {})))

    def run_with_file_limit(self, limit, *arguments):
        """No file may grow beyond `limit` [byte]: writing fails as on a full disk."""
        return subprocess.run([self.executable, *map(str, arguments)], cwd=self.directory, stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, universal_newlines=True, timeout=900 * SLOWER, check=False,
                              preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit)))

    def succeed(self, *arguments, environment=None):
        done = self.run_tool(*arguments, environment=environment)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done

    def succeed_json(self, *arguments, environment=None):
        """The one JSON document on stdout; json.loads refuses anything beside it."""
        return json.loads(self.succeed(*arguments, "--json", environment=environment).stdout)

    def fail_with(self, exit_code, parts, *arguments):
        """The tool must end with this code and say each of these parts on stderr, and nothing on stdout."""
        done = self.run_tool(*arguments)
        self.assertEqual(done.returncode, exit_code, done.stdout + done.stderr)
        self.assertEqual(done.stdout, "")
        for part in parts:
            self.assertIn(part, done.stderr)
        return done

    def measure(self, *arguments, environment=None):
        """Exit code, processor time and peak memory of the tool itself [s, byte]. Under a sanitizer the test is
        skipped."""
        if SLOWER != 1.0:
            self.skipTest("time and memory are the sanitizer's")
        process = subprocess.Popen([self.executable, *map(str, arguments)], cwd=self.directory,
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                                   env=dict(os.environ, **(environment or {})))
        # Not the most that the usage holds at the end: it counts what this process had when it started the other.
        peak, ended = 0, 0
        while not ended:
            time.sleep(0.01)
            peak = max(peak, peak_memory(process.pid))
            ended, status, usage = os.wait4(process.pid, os.WNOHANG)
        process.returncode = os.waitstatus_to_exitcode(status)
        return process.returncode, usage.ru_utime + usage.ru_stime, peak

    def interrupt_while_writing(self, name, number, *arguments):
        """Starts the tool, sends it a signal once the bag `name` has content; exit code and stderr."""
        process = subprocess.Popen([self.executable, *map(str, arguments)], cwd=self.directory, stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE)
        self.addCleanup(process.kill)
        active = self.path(name + ".active")
        deadline = time.monotonic() + 30.0 * SLOWER
        while not os.path.exists(active) or os.path.getsize(active) < 100000:
            self.assertLess(time.monotonic(), deadline, "nothing written")
            time.sleep(0.01)
        process.send_signal(number)
        _, errors = process.communicate(timeout=30 * SLOWER)
        return process.returncode, errors

    def rows(self, name):
        """Of a table of numbers: by column."""
        with open(self.path(name), encoding="utf-8", newline="") as file:
            return [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]

    def write(self, name, text):
        with open(self.path(name), "w") as file:
            file.write(text)
        return self.path(name)


def peak_memory(process):
    """Of its own since it was started [byte]; 0: it is gone."""
    try:
        with open(f"/proc/{process}/status", encoding="ascii") as status:
            return next((1024 * int(line.split()[1]) for line in status if line.startswith("VmHWM")), 0)
    except OSError:
        return 0


def read_columns(path):
    """The numbers of a table, by column."""
    with open(path, encoding="ascii") as file:
        names, *rows = csv.reader(file)
    return dict(zip(names, np.array(rows, dtype=float).T))


def read_bytes(path):
    with open(path, "rb") as file:
        return file.read()


def raw_messages(path, topics=None):
    """(topic, time, type, checksum, bytes) of each message, in the order of the bag."""
    with rosbag.Bag(path) as bag:
        return [(topic, time, raw[0], raw[2], raw[1])
                for topic, raw, time in bag.read_messages(topics=topics, raw=True)]


def series(path, topic):
    """(time [s] since START, message) of one topic."""
    with rosbag.Bag(path) as bag:
        return [((time - genpy.Time(START)).to_sec(), message)
                for _, message, time in bag.read_messages(topics=[topic])]


def stamped_torque(joint, torque, seconds):
    message = JointState(name=[joint], effort=[torque])
    message.header.stamp = genpy.Time(START) + genpy.Duration.from_sec(seconds)
    return message


def write_recording(path, duration=0.2, joint="elbow_joint", torque=0.4, load=5.0):
    """A bag as a live recording leaves it: stamped command and load, recorded a little later, and foreign topics."""
    with rosbag.Bag(path, "w") as bag:
        for step in range(int(duration * 125) + 1):
            seconds = step * 0.008
            recorded = genpy.Time(START) + genpy.Duration.from_sec(seconds + 0.001)
            command = stamped_torque(joint, torque * math.sin(20.0 * seconds), seconds)
            bag.write("/joint_twin/command", command, recorded)
            bag.write("/joint_twin/load", stamped_torque(joint, load, seconds), recorded)
            bag.write("/foreign", Float64(step), recorded)


def telemetry_csv(rows=25, period=0.008):
    """A UR controller's recording of this length, as lines with the header first; columns in an order of their own."""
    names = ["timestamp"]
    for quantity in ["target_moment", "actual_q", "actual_qd", "target_q", "actual_current"]:
        names += [f"{quantity}_{joint}" for joint in range(6)]
    lines = [",".join(names)]
    for row in range(rows):
        values = [row * period]
        values += [float(joint) for joint in range(6)]                             # target_moment
        values += [0.1 * joint + 0.001 * row for joint in range(6)]                # actual_q
        values += [0.125] * 6                                                      # actual_qd
        values += [0.0] * 6                                                        # target_q
        values += [0.5 + joint for joint in range(6)]                              # actual_current
        lines.append(",".join(f"{value:.6f}" for value in values))
    return lines


def main():
    """First argument: the tool."""
    ToolTest.executable = sys.argv.pop(1)
    unittest.main(verbosity=2)
