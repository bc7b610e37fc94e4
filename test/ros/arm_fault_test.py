#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""docs/arm_twin.md as it is printed: the live twin of an arm, arm.launch beside it with the report of the sound arm,
and a fault that comes while it moves; then its protective stop."""
import os
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import rospy
import rostest
from geometry_msgs.msg import WrenchStamped
from rosgraph_msgs.msg import Log
from sensor_msgs.msg import JointState
from std_srvs.srv import Trigger
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from harmonic_joint_twin.msg import Timing
from ros_support import (PACKAGE, PATIENCE, SLOWNESS, Diagnostics, Listener, executable, package_path,
                         processor_time, wait_until)

PAGE = package_path("docs", "arm_twin.md")
REPORT = "--report sound"  # end of the command that makes what the live node compares with
NODE, BESIDE = "/arm_twin", "/joint_twin"
JOINTS = ("base", "shoulder", "elbow", "wrist_1", "wrist_2", "wrist_3")
SICK = "elbow"
MEASURED_OVER = 10.0  # processor time [s]


def printed(program):
    """The page's commands that begin with this word."""
    with open(PAGE, encoding="utf-8") as page:
        return [line.strip() for line in page if line.startswith(program + " ")]


class ArmFault(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = folder.name
        path = os.path.dirname(executable("joint_twin")) + os.pathsep + os.environ["PATH"]
        cls.environment = dict(os.environ, PATH=path, PWD=cls.folder)
        for line in printed("joint_twin"):
            subprocess.run(["bash", "-c", line], cwd=cls.folder, env=cls.environment, check=True)
            if line.endswith(REPORT):
                break
        for line in printed("roslaunch")[:2]:
            launch = cls.start(line)
            cls.addClassCleanup(launch.wait)
            cls.addClassCleanup(launch.send_signal, signal.SIGINT)
        cls.states = Listener("/joint_states", JointState)
        cls.log = Listener("/rosout", Log)
        cls.timing = Listener(f"{NODE}/timing", Timing)
        cls.diagnostics = {joint: Diagnostics(f"/{joint}/joint_twin") for joint in JOINTS}
        cls.states.wait_for(10, 4.0 * PATIENCE)  # the first time it builds its tables

    @classmethod
    def start(cls, line):
        return subprocess.Popen(["bash", "-c", "exec " + line], cwd=cls.folder, env=cls.environment)

    def friction(self):
        """Level of that finding, by joint."""
        return {joint: self.diagnostics[joint].values("Drive").get("Friction", "").split(".")[0] for joint in JOINTS}

    def wait_for_friction(self, expected, what, patience):
        try:
            wait_until(lambda: self.friction() == expected, what, patience)
        except AssertionError as error:
            drives = {joint: self.diagnostics[joint].values("Drive") for joint in JOINTS}
            raise AssertionError(f"{error}: {drives}") from None

    def speeds(self):
        return [abs(speed) for speed in self.states.messages()[-1].velocity]

    def test_1_a_fault_that_comes_in_motion_is_seen_beside_it(self):
        self.wait_for_friction(dict.fromkeys(JOINTS, "OK"), "six sound joints", 8.0 * PATIENCE)
        wait_until(lambda: min(self.speeds()) > 0.05, "all six joints in motion")
        inject, = printed("rostopic")
        self.assertEqual(self.start(inject).wait(timeout=PATIENCE), 0)
        injected = time.monotonic()
        self.wait_for_friction({joint: "WARN" if joint == SICK else "OK" for joint in JOINTS}, f"the {SICK} alone",
                               12.0 * PATIENCE)
        print(f"seen {time.monotonic() - injected:.0f} s after it came")

    def test_2_both_nodes_need_less_than_a_core(self):
        begin = {node: processor_time(node) for node in (NODE, BESIDE)}
        began = time.monotonic()
        time.sleep(MEASURED_OVER)
        span = time.monotonic() - began
        shares = {node: (processor_time(node) - begin[node]) / span for node in begin}
        factor = self.timing.messages()[-1].real_time_factor
        print("processor time, of one core: " + ", ".join(f"{node} {share:.3f}" for node, share in shares.items())
              + f"; real time factor {factor:.3f}")
        self.assertLess(sum(shares.values()), SLOWNESS)
        self.assertGreater(factor, 0.99 / SLOWNESS)

    def test_3_a_protective_stop_stands_until_the_reset(self):
        wrench = rospy.Publisher(f"{NODE}/wrench", WrenchStamped, queue_size=1)
        command = rospy.Publisher(f"{NODE}/command", JointTrajectory, queue_size=1)
        for publisher in (wrench, command):
            wait_until(lambda each=publisher: each.get_num_connections() == 1, publisher.name)

        def said(text):
            wait_until(lambda: any(text in message.msg for message in self.log.messages()), text)

        push = WrenchStamped()
        push.wrench.force.x = push.wrench.force.z = -1000.0  # more than any joint bears
        wrench.publish(push)
        said("Protective stop: ")
        wrench.publish(WrenchStamped())
        self.states.clear()

        def moved():
            rows = self.states.wait_for(100)[-100:]
            return max(max(angles) - min(angles) for angles in zip(*(row.position for row in rows)))

        wait_until(lambda: moved() < 1e-3, "the arm at rest in its brakes")  # it swings in the compliance at first
        last = self.states.messages()[-1]
        point = JointTrajectoryPoint(positions=list(last.position), time_from_start=rospy.Duration(2))
        command.publish(JointTrajectory(joint_names=last.name, points=[point]))
        said("Refused a trajectory on ~command: protective stop; ~unlock_protective_stop ends it")
        self.assertTrue(rospy.ServiceProxy(f"{NODE}/reset", Trigger)().success)
        wait_until(lambda: min(self.speeds()) > 0.05, "all six joints in motion again")


if __name__ == "__main__":
    rospy.init_node("arm_fault_test")
    rostest.rosrun(PACKAGE, "arm_fault_test", ArmFault, sys.argv)
