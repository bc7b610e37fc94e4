#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""The live twin of an arm, driven by the action FollowJointTrajectory as MoveIt drives a robot."""
import math
import struct
import sys
import time
import unittest

import actionlib
import control_msgs.msg
import genmsg
import genpy.dynamic
import numpy as np
import roslib.packages
import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from control_msgs.msg import FollowJointTrajectoryAction, FollowJointTrajectoryGoal, JointTolerance
from control_msgs.msg import FollowJointTrajectoryResult as Result
from geometry_msgs.msg import PoseStamped, WrenchStamped
from sensor_msgs.msg import JointState
from std_msgs.msg import Bool, Float64
from std_srvs.srv import Trigger
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from ros_support import PACKAGE, PATIENCE, Listener, wait_until

CONTROLLER = "/arm_controller"
NAMES = ("shoulder_pan_joint", "shoulder_lift_joint", "elbow_joint", "wrist_1_joint", "wrist_2_joint", "wrist_3_joint")
START = dict(zip(NAMES, (0.0, -math.pi / 2, 0.0, -math.pi / 2, 0.0, 0.0)))
THERE = {name: angle + 0.2 for name, angle in START.items()}
FAR = {name: angle + 0.8 for name, angle in START.items()}
# Of github.com/ros-controls/control_msgs for ROS 1, branch kinetic-devel.
SUMS = {
    "JointTolerance": "f544fe9c16cf04547e135dd6063ff5be",
    "FollowJointTrajectoryActionGoal": "cff5c1d533bf2f82dd0138d57f4304bb",
    "FollowJointTrajectoryActionResult": "c4fb3b000dc9da4fd99699380efcc5d9",
    "FollowJointTrajectoryActionFeedback": "d8920dc4eae9fc107e00999cce4be641",
}
# Of github.com/UniversalRobots/Universal_Robots_ROS_Driver.
MODE_SUMS = {"RobotMode": "73b72d58742c4889c47118411b03a3b4", "SafetyMode": "5da08725a63d4237bad689481131a84b"}


def trajectory(angles, duration, names=NAMES):
    point = JointTrajectoryPoint(positions=[angles[name] for name in names],
                                 time_from_start=rospy.Duration.from_sec(duration))
    return JointTrajectory(joint_names=names, points=[point])


def transforms(*listeners):
    """By frame: its parent, rotation and translation. Debian has no Python module of tf2_msgs."""
    frames = {}
    for message in (each for listener in listeners for each in listener.messages()):
        header = message._connection_header
        kind = genpy.dynamic.generate_dynamic(header["type"], header["message_definition"])[header["type"]]
        for each in kind().deserialize(message._buff).transforms:
            x, y, z, w = (getattr(each.transform.rotation, axis) for axis in "xyzw")
            rotation = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                                 [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                                 [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])
            place = each.transform.translation
            frames[each.child_frame_id] = each.header.frame_id, rotation, np.array([place.x, place.y, place.z])
    return frames


class ArmAction(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.states = Listener("/joint_states", JointState)
        cls.command = rospy.Publisher("/arm_twin/command", JointTrajectory, queue_size=1)
        cls.wrench = rospy.Publisher("/arm_twin/wrench", WrenchStamped, queue_size=1)
        cls.modes = [Listener(f"/ur_hardware_interface/{name}_mode", rospy.AnyMsg) for name in ("robot", "safety")]
        cls.program = Listener("/ur_hardware_interface/robot_program_running", Bool)
        cls.scaling = Listener("/speed_scaling_factor", Float64)
        cls.states.wait_for(10, 4.0 * PATIENCE)  # the first time it builds its tables
        cls.client = actionlib.ActionClient(CONTROLLER + "/follow_joint_trajectory", FollowJointTrajectoryAction)
        wait_until(cls.client.wait_for_server, "the action")
        wait_until(lambda: cls.command.get_num_connections() == cls.wrench.get_num_connections() == 1, "its topics")
        for listener in (*cls.modes, cls.program, cls.scaling):
            listener.wait_for(1)

    def setUp(self):
        self.feedback = []

    def last(self):
        message = self.states.messages()[-1]
        return dict(zip(message.name, message.position))

    def off(self, angles):
        return max(abs(self.last()[name] - angles[name]) for name in NAMES)

    def speed(self):
        return max(abs(speed) for message in self.states.messages()[-25:] for speed in message.velocity)

    def send(self, angles, duration, names=NAMES, **tolerances):
        goal = FollowJointTrajectoryGoal(trajectory=trajectory(angles, duration, names), **tolerances)
        return self.client.send_goal(goal, feedback_cb=lambda _, message: self.feedback.append(message))

    def ends(self, handle, status, code, text=""):
        wait_until(lambda: handle.get_comm_state() == actionlib.CommState.DONE, "the end of the goal")
        result = handle.get_result()
        found = handle.get_goal_status(), result.error_code
        self.assertEqual(found, (status, code), result.error_string)
        self.assertIn(text, result.error_string)
        if text:
            self.assertIn(text, handle.get_goal_status_text())

    def goes_on(self, handle):
        wait_until(lambda: handle.get_comm_state() == actionlib.CommState.ACTIVE and self.speed() > 0.05, "the motion")

    def go(self, angles, duration=1.5):
        self.ends(self.send(angles, duration), GoalStatus.SUCCEEDED, Result.SUCCESSFUL)

    def test_0_its_messages_are_the_original_ones(self):
        self.assertEqual({name: getattr(control_msgs.msg, name)._md5sum for name in SUMS}, SUMS)

    def test_1_a_trajectory_reaches_its_goal(self):
        self.go(THERE)
        self.assertLess(self.off(THERE), 2e-3)
        self.assertGreater(len(self.feedback), 5)
        for message in self.feedback:
            self.assertEqual(tuple(message.joint_names), NAMES)
            rows = zip(message.desired.positions, message.actual.positions, message.error.positions)
            for wanted, actual, error in rows:
                self.assertAlmostEqual(wanted - actual, error, 12)
        errors = [abs(error) for message in self.feedback for error in message.error.positions]
        self.assertGreater(max(errors), 1e-5)
        self.assertLess(max(errors), 0.05)

    def test_2_another_goal_takes_its_place(self):
        first = self.send(FAR, 8.0)
        self.goes_on(first)
        second = self.send(START, 2.0)
        self.ends(first, GoalStatus.PREEMPTED, 0, "another goal has replaced this goal")
        self.ends(second, GoalStatus.SUCCEEDED, Result.SUCCESSFUL)
        self.assertLess(self.off(START), 2e-3)

    def test_3_it_is_cancelled_and_the_arm_rests(self):
        handle = self.send(FAR, 8.0)
        self.goes_on(handle)
        handle.cancel()
        self.ends(handle, GoalStatus.PREEMPTED, 0, "the client has cancelled the goal")
        wait_until(lambda: self.speed() < 2e-3, "the arm at rest")
        self.assertGreater(self.off(FAR), 0.3)

    def test_4_a_trajectory_on_the_topic_takes_its_place(self):
        handle = self.send(FAR, 8.0)
        self.goes_on(handle)
        self.command.publish(trajectory(START, 2.0))
        self.ends(handle, GoalStatus.PREEMPTED, 0, "a trajectory on ~command has replaced the goal")
        wait_until(lambda: self.off(START) < 2e-3, "the arm where the topic wanted it")

    def test_5_one_that_leaves_its_path_is_aborted_and_the_arm_rests(self):
        self.go(START)
        handle = self.send(FAR, 2.0, path_tolerance=[JointTolerance("elbow_joint", 1e-4, 0.0, 0.0)])
        self.ends(handle, GoalStatus.ABORTED, Result.PATH_TOLERANCE_VIOLATED,
                  "elbow_joint is off by 0.0001")
        wait_until(lambda: self.speed() < 2e-3, "the arm at rest")
        self.assertGreater(self.off(FAR), 0.3)
        # Without a bound it may leave it, below 0 there is none.
        self.go(START)
        self.ends(self.send(THERE, 2.0, path_tolerance=[JointTolerance("elbow_joint", -1.0, -1.0, 0.0)]),
                  GoalStatus.SUCCEEDED, Result.SUCCESSFUL)

    def test_6_one_that_does_not_arrive_in_time_is_aborted(self):
        self.go(START)
        handle = self.send(THERE, 1.0, goal_tolerance=[JointTolerance(name, 1e-9, 0.0, 0.0) for name in NAMES],
                           goal_time_tolerance=rospy.Duration.from_sec(0.05))
        self.ends(handle, GoalStatus.ABORTED, Result.GOAL_TOLERANCE_VIOLATED, "tolerance 1e-09")

    def test_7_after_a_protective_stop_it_goes_on_from_where_it_stands(self):
        self.go(START)
        handle = self.send(FAR, 5.0)
        wait_until(lambda: self.off(START) > 0.2, "the arm on its way")
        push = WrenchStamped()
        push.wrench.force.x = push.wrench.force.z = -1000.0  # more than any joint bears
        self.wrench.publish(push)
        self.ends(handle, GoalStatus.ABORTED, Result.PATH_TOLERANCE_VIOLATED, "protective stop: ")
        self.wrench.publish(WrenchStamped())
        self.ends(self.send(START, 2.0), GoalStatus.REJECTED, Result.INVALID_GOAL, "~unlock_protective_stop ends")
        wait_until(lambda: self.states_of_driver() == (7, 3, False, 0.0), "the driver's states in the stop")
        unlock = rospy.ServiceProxy("/arm_twin/unlock_protective_stop", Trigger)
        wait_until(lambda: unlock().success, "the end of the stop")
        stood = self.last()
        wait_until(lambda: self.states_of_driver() == (7, 1, True, 1.0), "the driver's states")
        time.sleep(0.5)
        self.assertLess(self.off(stood), 5e-3)
        self.assertGreater(self.off(START), 0.1)
        self.go(START, 3.0)
        self.assertLess(self.off(START), 2e-3)

    def states_of_driver(self):
        modes = [struct.unpack("b", listener.messages()[-1]._buff)[0] for listener in self.modes]
        return (*modes, self.program.messages()[-1].data, self.scaling.messages()[-1].data)

    def test_8_tf_has_the_tool_where_the_twin_has_it(self):
        if not roslib.packages.find_node("robot_state_publisher", "robot_state_publisher"):
            self.skipTest("robot_state_publisher is not installed")
        self.go(START)
        self.go(THERE)
        wait_until(lambda: self.speed() < 2e-3, "the arm at rest")
        pose = Listener("/arm_twin/tool_pose", PoseStamped).wait_for(1)[-1].pose.position
        moving, fixed = (Listener(name, rospy.AnyMsg) for name in ("/tf", "/tf_static"))
        wait_until(lambda: {"tool"} <= set(transforms(moving, fixed)), "the frame of the tool")
        moving.clear()
        moving.wait_for(2)
        frames = transforms(moving, fixed)
        place, frame = np.zeros(3), "tool"
        while frame != "base":
            frame, rotation, translation = frames[frame]
            place = rotation @ place + translation
        self.assertLess(math.dist(place, (pose.x, pose.y, pose.z)), 1e-3)
        self.assertGreater(abs(place[0]) + abs(place[1]), 0.1)

    def test_8_the_modes_are_messages_of_the_driver(self):
        for listener in self.modes:
            header = listener.messages()[-1]._connection_header
            definition = header["message_definition"]
            package, name = header["type"].split("/")
            context = genmsg.MsgContext.create_default()
            spec = genmsg.msg_loader.load_msg_from_string(context, definition, header["type"])
            self.assertEqual(genmsg.gentools.compute_md5(context, spec), header["md5sum"])
            self.assertEqual((package, header["md5sum"]), ("ur_dashboard_msgs", MODE_SUMS[name]))

    def test_9_what_it_cannot_follow_is_rejected(self):
        cases = (
            (Result.INVALID_JOINTS, "the arm has no joint knee_joint", 2.0,
             dict(names=NAMES[:5] + ("knee_joint",))),
            (Result.INVALID_GOAL, "its limit is 3.142", 0.05, {}),
            (Result.INVALID_GOAL, "rad/s^2; it", None, {}),
            (Result.INVALID_GOAL, "path_tolerance names 'knee_joint'", 2.0,
             dict(path_tolerance=[JointTolerance("knee_joint", 0.1, 0.0, 0.0)])),
            (Result.INVALID_GOAL, "goal_tolerance of elbow_joint is not a number", 2.0,
             dict(goal_tolerance=[JointTolerance("elbow_joint", math.nan, 0.0, 0.0)])),
        )
        for code, text, duration, others in cases:
            near = {name: angle + 0.05 for name, angle in self.last().items()}
            where = near if duration is None else FAR
            handle = self.send(dict(where, knee_joint=0.0), duration or 0.05, **others)
            self.ends(handle, GoalStatus.REJECTED, code, text)


if __name__ == "__main__":
    rospy.init_node("arm_action_test")
    rostest.rosrun(PACKAGE, "arm_action_test", ArmAction, sys.argv)
