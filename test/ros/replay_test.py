#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""A bag through replay.launch and through the offline tool: the same messages, bit by bit, wherever both have one."""
import glob
import math
import os
import resource
import subprocess
import sys
import tempfile
import time
import unittest

import rosbag
import rospy
import rostest
from sensor_msgs.msg import JointState

from ros_support import LAUNCH_TIMEOUT, PACKAGE, PATIENCE, Launch, executable, package_path, wait_until

JOINT = "elbow_joint"
START = 1000.0      # first stamp [s]
DURATION = 2.0      # [s]
INPUT_RATE = 125.0  # [Hz]
INPUT_DELAY = 0.5     # [s]; long, so that no message is late on a busy machine: equality rests on that
RATE = 1.0 / float(os.environ.get("HJT_PATIENCE", "1"))  # of the replay: the twin must keep up
OUTPUTS = {"joint_states": 1000, "encoders": 1000, "contact_forces": 100, "health": 10}  # [Hz]


def write_bag(path):
    with rosbag.Bag(path, "w") as bag:
        for k in range(int(DURATION * INPUT_RATE)):
            stamp = rospy.Time.from_sec(START) + rospy.Duration.from_sec(k / INPUT_RATE)
            for topic, torque in (("command", 0.5 * math.sin(0.05 * k)), ("load", 10.0 if k > 100 else 0.0)):
                message = JointState(name=[JOINT], effort=[torque])
                message.header.stamp = stamp
                bag.write(f"/joint_twin/{topic}", message, stamp)
            telemetry = JointState(name=[JOINT], position=[0.001 * k])
            telemetry.header.stamp = stamp
            bag.write("/joint_states", telemetry, stamp)


def messages_by_stamp(path, topic):
    messages = {}
    with rosbag.Bag(path) as bag:
        for _, message, _ in bag.read_messages([topic]):
            message.header.seq = 0  # counts what a publisher sent, from another start live
            messages[message.header.stamp.to_nsec()] = message
    return messages


class Replay(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.recording = self.path("recording.bag")
        self.live = self.path("live.bag")
        write_bag(self.recording)

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def launch(self):
        launch = Launch(self.path("launch.log"), "replay.launch", f"bag:={self.recording}", f"out:={self.live}",
                        f"input_delay:={INPUT_DELAY}", f"rate:={RATE}")
        self.addCleanup(launch.interrupt)
        return launch

    def replay_offline(self):
        path = self.path("offline.bag")
        subprocess.run([executable("joint_twin"), "replay", self.recording, "--out", path, "--config",
                        package_path("config", "joints", "elbow.yaml")], check=True, stdout=subprocess.DEVNULL)
        return path

    def test_live_and_offline_replay_give_the_same_messages(self):
        launch = self.launch()
        self.assertEqual(launch.process.wait(timeout=LAUNCH_TIMEOUT), 0, launch.log())
        self.assertEqual(glob.glob(self.path("*.active")), [])
        self.check_inputs_were_in_time()
        offline = self.replay_offline()
        for topic, rate in OUTPUTS.items():
            with self.subTest(topic=topic):
                live = messages_by_stamp(self.live, f"/joint_twin/{topic}")
                expected = messages_by_stamp(offline, f"/joint_twin/{topic}")
                # To the end of the bag, where the clock ended too.
                length = DURATION - 1.0 / INPUT_RATE
                common = [stamp for stamp in expected if stamp <= (START + length) * 1e9]
                self.assertGreaterEqual(len(common), int(length * rate))
                lost = sorted(set(common) - set(live))
                self.assertFalse(lost, f"{len(lost)} of {len(common)} lost, from {lost[:1]} to {lost[-1:]}")
                self.assertEqual([stamp for stamp in live if live[stamp] != expected[stamp]], [])
        for topic in ("/joint_states", "/joint_twin/command", "/joint_twin/load"):
            self.assertEqual(messages_by_stamp(self.live, topic), messages_by_stamp(self.recording, topic), topic)

    def test_the_arguments_can_be_listed_without_any_given(self):
        listed = subprocess.run(["roslaunch", "--ros-args", PACKAGE, "replay.launch"], stdout=subprocess.PIPE,
                                stderr=subprocess.PIPE, text=True, timeout=LAUNCH_TIMEOUT)
        self.assertEqual((listed.returncode, listed.stderr), (0, ""))
        self.assertIn("bag: Bag to play", listed.stdout)

    def check_inputs_were_in_time(self):
        with rosbag.Bag(self.live) as bag:
            statuses = [status for _, array, _ in bag.read_messages(["/diagnostics"]) for status in array.status
                        if status.name == "joint_twin: Input" and status.values]
        late = {pair.value for status in statuses for pair in status.values
                if pair.key == "Inputs too late for their stamps"}
        self.assertEqual(late, {"0"})

    def test_an_interrupt_leaves_a_bag_that_can_be_read(self):
        launch = self.launch()
        active = f"{self.live}.active"
        wait_until(lambda: os.path.exists(active), "the recorder", LAUNCH_TIMEOUT)
        # Some of the simulated messages must have come, none of the bag's end.
        wait_until(lambda: os.path.getsize(active) > 100000 or launch.process.poll() is not None, "messages",
                   LAUNCH_TIMEOUT)
        self.assertIsNone(launch.process.poll(), launch.log())
        launch.interrupt()
        self.assertEqual(glob.glob(self.path("*.active")), [])
        self.assertGreater(len(messages_by_stamp(self.live, "/joint_twin/joint_states")), 0)

    def test_an_existing_output_is_refused(self):
        with open(self.live, "w") as file:
            file.write("not to be lost")
        begin = time.monotonic()
        launch = self.launch()
        launch.process.wait(timeout=LAUNCH_TIMEOUT)
        self.assertIn("exists and is not overwritten", launch.log())
        with open(self.live) as file:
            self.assertEqual(file.read(), "not to be lost")
        self.assertLess(time.monotonic() - begin, 2.0 * PATIENCE)

    def test_a_full_disk_ends_the_recorder_with_what_was_recorded(self):
        limit = 2000000  # of a file [byte]
        recorder = subprocess.Popen([executable("replay_recorder"), self.recording, "--output", self.live],
                                    stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                                    preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit)))
        self.addCleanup(recorder.kill)
        publisher = rospy.Publisher("/joint_twin/command", JointState, queue_size=100)
        self.addCleanup(publisher.unregister)
        wait_until(lambda: publisher.get_num_connections() > 0, "the recorder")

        def publish():
            publisher.publish(JointState(name=["x" * 20000]))
            return recorder.poll() is not None

        wait_until(publish, "the end of the recorder")
        note = recorder.communicate()[0]
        self.assertEqual(recorder.returncode, 1, note)
        self.assertIn(f"{self.live}.active has {limit} bytes of ", note)
        with rosbag.Bag(f"{self.live}.active", "a", allow_unindexed=True) as bag:
            for _ in bag.reindex():
                pass
        with rosbag.Bag(f"{self.live}.active") as bag:
            self.assertGreater(bag.get_message_count("/joint_twin/command"), 0.3 * limit / 20100)


if __name__ == "__main__":
    rospy.init_node("replay_test")
    rostest.rosrun(PACKAGE, "replay", Replay, sys.argv)
