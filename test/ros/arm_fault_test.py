#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""docs/arm_twin.md as it is printed: the live twin of an arm, arm.launch beside it with the report of the sound arm,
and a fault that comes while it moves; then the live part of docs/beside_a_robot.md's first hour."""
import os
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import rospy
import rostest
from rosgraph_msgs.msg import Log
from sensor_msgs.msg import JointState

from ros_support import NO_PAGE, PACKAGE, PATIENCE, Diagnostics, Listener, executable, package_path, wait_until

PAGE, FIRST_HOUR = (package_path("docs", page) for page in ("arm_twin.md", "beside_a_robot.md"))
REPORT = "--report sound"  # end of the command that makes what the live node compares with
JOINTS = ("base", "shoulder", "elbow", "wrist_1", "wrist_2", "wrist_3")
SICK = "elbow"


def read(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def printed(program, path=PAGE):
    """The page's commands that begin with these words."""
    return [line.strip() for line in read(path).splitlines() if line.startswith(program + " ")]


class ArmFault(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = folder.name
        path = os.path.dirname(executable("joint_twin")) + os.pathsep + os.environ["PATH"]
        cls.environment = dict(os.environ, PATH=path, PWD=cls.folder)
        for line in printed("joint_twin"):
            cls.run_to_its_end(line)
            if line.endswith(REPORT):
                break
        _, cls.beside = [cls.launch(line) for line in printed("roslaunch")[:2]]
        cls.states = Listener("/joint_states", JointState)
        cls.log = Listener("/rosout", Log)
        cls.diagnostics = {joint: Diagnostics(f"/{joint}/joint_twin") for joint in JOINTS}
        cls.states.wait_for(10, 4.0 * PATIENCE)  # the first time it builds its tables

    @classmethod
    def start(cls, line, **more):
        return subprocess.Popen(["bash", "-c", "exec " + line], cwd=cls.folder, env=cls.environment, **more)

    @classmethod
    def run_to_its_end(cls, line):
        subprocess.run(["bash", "-c", line], cwd=cls.folder, env={**cls.environment, **NO_PAGE}, check=True)

    @classmethod
    def launch(cls, line, **more):
        launch = cls.start(line, **more)
        cls.addClassCleanup(launch.wait)
        cls.addClassCleanup(launch.send_signal, signal.SIGINT)
        return launch

    def friction(self):
        """Level of that finding, by joint."""
        return {joint: self.diagnostics[joint].values("Drive").get("Friction", "").split(".")[0] for joint in JOINTS}

    def wait_for_friction(self, expected, what, patience):
        try:
            wait_until(lambda: self.friction() == expected, what, patience)
        except AssertionError as error:
            drives = {joint: self.diagnostics[joint].values("Drive") for joint in JOINTS}
            raise AssertionError(f"{error}: {drives}") from None

    def wait_for_log(self, text):
        wait_until(lambda: any(text in message.msg for message in self.log.messages()), text)

    def test_1_a_fault_that_comes_in_motion_is_seen_beside_it(self):
        self.wait_for_friction(dict.fromkeys(JOINTS, "OK"), "six sound joints", 8.0 * PATIENCE)
        wait_until(lambda: min(map(abs, self.states.messages()[-1].velocity)) > 0.05, "all six joints in motion")
        inject, = printed("rostopic")
        self.assertEqual(self.start(inject).wait(timeout=PATIENCE), 0)
        injected = time.monotonic()
        self.wait_for_friction({joint: "WARN" if joint == SICK else "OK" for joint in JOINTS}, f"the {SICK} alone",
                               12.0 * PATIENCE)
        print(f"seen {time.monotonic() - injected:.0f} s after it came")

    def test_2_the_first_hour_watches_with_the_drives_that_it_identified(self):
        identify, = printed("joint_twin identify", FIRST_HOUR)
        watch, = printed("roslaunch harmonic_joint_twin arm.launch", FIRST_HOUR)
        self.run_to_its_end(identify)
        self.beside.send_signal(signal.SIGINT)
        self.beside.wait()
        self.log.clear()
        said = os.path.join(self.folder, "watch.log")
        with open(said, "w", encoding="utf-8") as log:
            beside = self.launch(watch, stdout=log)
        for state in (f"{joint}/joint_twin: OK" for joint in JOINTS):
            self.wait_for_log(state)
        beside.send_signal(signal.SIGINT)  # flushes what it said
        beside.wait()
        self.assertIn(f"identified: {self.folder}/my_arm, reference: {self.folder}/sound", read(said))


if __name__ == "__main__":
    rospy.init_node("arm_fault_test")
    rostest.rosrun(PACKAGE, "arm_fault", ArmFault, sys.argv)
