#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""What other programs can do to the node and to the recorder: messages that are huge or forge log lines, a flood,
signals, a second recorder."""
import io
import os
import re
import signal
import subprocess
import sys
import tempfile
import time
import unittest
import warnings

import rosbag
import rospy
import rostest
from sensor_msgs.msg import JointState
from std_msgs.msg import String, UInt8MultiArray

from harmonic_joint_twin.msg import Fault
from ros_support import (PACKAGE, WARN, Diagnostics, Node, configuration_files, executable, load_parameters, wait_until)

NODE = "/twin_under_test"
NAMES = 100_000         # in one message
HUGE_MESSAGES = 300     # of 3.9 MB each
BAD_FAULTS = 300
MOST_MEMORY = 250e6     # of the node's, at the most it ever had [bytes]
MEGABYTE = 2**20


def most_memory(process):
    """The most memory that a process has had [bytes]."""
    with open(f"/proc/{process.pid}/status") as status:
        return 1024 * int(re.search(r"VmHWM:\s*(\d+) kB", status.read()).group(1))


class Frozen(JointState):
    """A message that is serialized once, so that it can be sent faster than a node can read it."""

    def __init__(self, message):
        super().__init__()
        buffer = io.BytesIO()
        message.serialize(buffer)
        self._bytes = buffer.getvalue()

    def serialize(self, buff):
        buff.write(self._bytes)


class AbusedNode:
    def start(self, mode):
        load_parameters(NODE, configuration_files(), {"input/mode": mode})
        self.node = Node(NODE.lstrip("/"))
        self.addCleanup(self.node.kill)
        self.diagnostics = Diagnostics(NODE)
        wait_until(lambda: self.diagnostics.values("Input"), "diagnostics", 60.0)

    def publisher(self, topic, kind):
        publisher = rospy.Publisher(f"{NODE}/{topic}", kind, queue_size=None)  # sends at once
        self.addCleanup(publisher.unregister)
        wait_until(lambda: publisher.get_num_connections() > 0, f"a subscriber of {topic}")
        return publisher

    def test_messages_of_a_hundred_thousand_joints_take_no_memory(self):
        for mode, topic in (("commands", "command"), ("motion", "joint_states_measured")):
            with self.subTest(mode=mode):
                self.start(mode)
                publisher = self.publisher(topic, JointState)
                huge = Frozen(JointState(name=[f"joint_{number}" for number in range(NAMES)], position=[0.0] * NAMES,
                                         velocity=[0.0] * NAMES, effort=[0.0] * NAMES))
                for _ in range(HUGE_MESSAGES):
                    publisher.publish(huge)
                self.diagnostics.wait_for("Input", "Too large, refused", HUGE_MESSAGES)
                self.assertEqual(self.diagnostics.level("Input"), WARN)
                if "ASAN_OPTIONS" not in os.environ:  # which keeps what is freed
                    self.assertLess(most_memory(self.node.process), MOST_MEMORY)
                self.node.kill()

    def test_a_kind_of_fault_makes_no_line_of_the_log(self):
        self.start("commands")
        fault = self.publisher("inject_fault", Fault)
        fault.publish(Fault(kind="tooth_wear\n[FATAL] [0.0]: forged" + "x" * 10000, severity=0.5, place=-1))
        self.diagnostics.wait_for("Input", "Faults, refused", 1)
        wait_until(lambda: "Refused a message" in self.node.output(), "the warning")
        lines = self.node.output().splitlines()
        self.assertEqual([line for line in lines if line.startswith("[FATAL]")], [])
        self.assertLess(max(len(line) for line in lines if "Refused a message" in line), 1000)

    def test_a_storm_of_bad_faults_is_told_once_a_second(self):
        self.start("commands")
        fault = self.publisher("inject_fault", Fault)
        begin = time.monotonic()
        for _ in range(BAD_FAULTS):
            fault.publish(Fault(kind="rust", severity=0.5, place=-1))
        self.diagnostics.wait_for("Input", "Faults, refused", BAD_FAULTS)
        seconds = time.monotonic() - begin
        self.assertLessEqual(self.node.output().count("Refused a message"), 1 + seconds)

    def test_a_hangup_ends_it_cleanly(self):
        self.start("commands")
        code, _ = self.node.stop(signal.SIGHUP)
        self.assertEqual(code, 0)


class AbusedRecorder:
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.played = os.path.join(folder.name, "played.bag")
        self.out = os.path.join(folder.name, "out.bag")
        with rosbag.Bag(self.played, "w") as bag:
            bag.write("/text", String("text"), rospy.Time(1))
            bag.write("/data", UInt8MultiArray(), rospy.Time(1))
        self.text = rospy.Publisher("/text", String, queue_size=1000)
        self.data = rospy.Publisher("/data", UInt8MultiArray, queue_size=1000)
        self.addCleanup(self.text.unregister)
        self.addCleanup(self.data.unregister)

    def record(self, *options):
        command = [executable("replay_recorder"), self.played, "--output", self.out, *options,
                   f"__name:=recorder_{time.monotonic_ns()}"]
        process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self.addCleanup(lambda: process.poll() is None and process.kill())
        return process

    def recorded(self):
        with rosbag.Bag(self.out) as bag:
            return [message.data for _, message, _ in bag.read_messages(["/text"])]

    def wait_for_recorder(self):
        wait_until(lambda: min(p.get_num_connections() for p in (self.text, self.data)) > 0, "the recorder")

    def test_a_hangup_closes_the_bag(self):
        process = self.record()
        self.wait_for_recorder()
        self.text.publish("kept")
        time.sleep(0.5)
        process.send_signal(signal.SIGHUP)
        output, _ = process.communicate(timeout=30)
        self.assertEqual(process.returncode, 0, output)
        self.assertEqual(self.recorded(), ["kept"])

    def test_a_second_recorder_of_the_same_output_fails_at_once(self):
        first = self.record()
        self.wait_for_recorder()
        self.text.publish("of the first")
        time.sleep(0.5)
        second = self.record()
        output, _ = second.communicate(timeout=30)
        self.assertEqual(second.returncode, 1)
        self.assertIn("is being written by another program", output)
        first.send_signal(signal.SIGINT)
        output, _ = first.communicate(timeout=30)
        self.assertEqual(first.returncode, 0, output)
        self.assertEqual(self.recorded(), ["of the first"])

    def test_messages_beyond_the_buffer_are_lost_counted_and_told(self):
        process = self.record("--buffer", "1")
        self.wait_for_recorder()
        for number in range(20):
            self.data.publish(UInt8MultiArray(data=bytes(2 * MEGABYTE)))
            self.text.publish(str(number))
            time.sleep(0.05)
        time.sleep(1.0)
        process.send_signal(signal.SIGTERM)
        output, _ = process.communicate(timeout=30)
        self.assertEqual(process.returncode, 1)
        self.assertIn("lost messages: 20 of /data", output)
        self.assertEqual(self.recorded(), [str(number) for number in range(20)])


class Abuse(AbusedNode, AbusedRecorder, unittest.TestCase):
    """Both programs."""


if __name__ == "__main__":
    warnings.filterwarnings("ignore", message="The publisher should be created with an explicit")
    rospy.init_node("abuse_test")
    rostest.rosrun(PACKAGE, "abuse", Abuse, sys.argv)
