#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Twins beside a UR5 that publishes as its driver does, with what goes wrong on a network. The three joints are twins,
led by a speed control, with the noise of real sensors; the elbow's grease has gone."""
import csv
import glob
import math
import os
import shutil
import subprocess
import sys
import tempfile
import time
import unittest

import rosbag
import rospy
import rostest
from sensor_msgs.msg import JointState

from harmonic_joint_twin.msg import Assessment, Comparison, Indicators
from ros_support import PACKAGE, WARN, Diagnostics, Listener, executable, listen_to_all, numbers_in, wait_until

JOINTS = {"base": "shoulder_pan_joint", "shoulder": "shoulder_lift_joint", "elbow": "elbow_joint"}
TWINS = [("motion", joint) for joint in JOINTS] + [("observer", joint)
                                                   for joint in JOINTS] + [("torque", "base"), ("loaded", "base")]
MODES = {"loaded": "motion"}  # of the others, their names
LOADS = {"loaded": "target_moment"}  # of the others, the model
RATIO, GAIN = 101.0, 10.7  # [-], [N.m/A] at the joint
PERIOD = 0.008  # [s]
FIELDS = [field for field in Comparison.__slots__ if field != "header"]
PLAN = """name: {joint}
seed: 3
duration: 6.0
repeats: 1
overlays: [joints/{joint}.yaml, real_sensors.yaml]
set: {{publish.joint_states_rate: 125.0, publish.encoders_rate: 1.0, publish.contact_forces_rate: 1.0}}
duty:
  - name: swing
    speed: {{trapezoid: {{peak: 0.8, slope: 2.0, hold: 0.8, pause: 0.3}}}}
    bandwidth: 8.0
    load: {{constant: 0.0}}
classes:
  robot: [{faults}]
record: {{format: bag}}
"""
GREASE_GONE = "{kind: lubricant_degradation, severity: 1.0, place: -1, onset: 0.0}"


def run_robot(directory, joint):
    """Angles and currents of one joint, a row each 8 ms."""
    plan = os.path.join(directory, joint + ".yaml")
    with open(plan, "w") as file:
        file.write(PLAN.format(joint=joint, faults=GREASE_GONE if joint == "elbow" else ""))
    out = os.path.join(directory, joint)
    subprocess.run([executable("joint_twin"), "sweep", plan, "--out", out], check=True, stderr=subprocess.DEVNULL)
    with rosbag.Bag(glob.glob(os.path.join(out, "runs", "*.bag"))[0]) as bag:
        return [(state.position[1], state.effort[0] * RATIO / GAIN)
                for _, state, _ in bag.read_messages("/joint_twin/joint_states")]


def load_at(row, begin):
    load = JointState(name=list(JOINTS.values()), effort=[8.0 * math.sin(0.02 * row)] * 3)
    load.header.stamp = begin + rospy.Duration.from_sec(PERIOD * row)
    return load


class UR5(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.directory = tempfile.mkdtemp(prefix="ur5_test_")
        cls.comparisons = {twin: Listener(f"/{twin[0]}/{twin[1]}/joint_twin/comparison", Comparison) for twin in TWINS}
        cls.diagnostics = {twin: Diagnostics(f"/{twin[0]}/{twin[1]}/joint_twin") for twin in TWINS}
        cls.everything = {(twin, name): listener for twin in TWINS
                          for name, listener in listen_to_all(f"/{twin[0]}/{twin[1]}/joint_twin").items()}
        cls.indicators = Listener("/motion/base/joint_twin/indicators", Indicators)
        cls.assessments = Listener("/motion/base/joint_twin/assessment", Assessment)
        robot = {joint: run_robot(cls.directory, joint) for joint in JOINTS}
        cls.publisher = rospy.Publisher("/joint_states", JointState, queue_size=1000)
        cls.load_publisher = rospy.Publisher("/target_moments", JointState, queue_size=1000)
        wait_until(lambda: cls.load_publisher.get_num_connections() == 1, "the twin that receives its load")
        wait_until(lambda: cls.publisher.get_num_connections() == len(TWINS), "all twins")
        for listener in cls.comparisons.values():
            listener.wait_for_connection()
        cls.bag_path = os.path.join(cls.directory, "robot.bag")
        cls.play(robot)

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.directory)

    @classmethod
    def play(cls, robot):
        """125 Hz by the wall clock: rows lost, sent twice, with NaN, without effort, of other joints only."""
        cls.sent = {"rows": 0, "repeated": 0, "not_finite": 0, "incomplete": 0, "unknown": 0}
        with rosbag.Bag(cls.bag_path, "w") as bag:
            begin = rospy.Time.now() + rospy.Duration.from_sec(0.5)  # the first loads have arrived by then
            for row in range(len(robot["base"])):
                stamp = begin + rospy.Duration.from_sec(PERIOD * row)
                # Live ahead of their rows, as two topics keep no order between them.
                for ahead in range(row, row + 50) if row == 0 else range(row + 25, row + 75) if row % 50 == 25 else []:
                    cls.load_publisher.publish(load_at(ahead, begin))
                time.sleep(max(0.0, (stamp - rospy.Time.now()).to_sec()))
                bag.write("/joint_twin/load", load_at(row, begin), rospy.Time.now())
                if row % 40 == 25 or 300 <= row < 330:
                    continue
                message = JointState(name=["wrist_1_joint", *JOINTS.values()],
                                     position=[0.0] + [robot[joint][row][0] for joint in JOINTS], velocity=[0.0] * 4,
                                     effort=[0.0] + [robot[joint][row][1] for joint in JOINTS])
                message.header.stamp = stamp
                kind = "rows"
                if row % 100 == 60:
                    message.effort = [float("nan")] * 4
                    kind = "not_finite"
                elif row % 100 == 70:
                    message.effort = []
                    kind = "incomplete"
                elif row % 100 == 80:
                    message.name[1:] = ["gripper", "track", "camera"]
                    kind = "unknown"
                for _ in range(2 if kind == "rows" and row % 100 == 10 else 1):
                    cls.publisher.publish(message)
                    bag.write("/joint_states", message, rospy.Time.now())
                    cls.sent[kind] += 1
                cls.sent["repeated"] += 1 if kind == "rows" and row % 100 == 10 else 0

    def wait_for_rows(self, twin):
        """All rows but those whose later ones never came."""
        return self.comparisons[twin].wait_for(self.sent["rows"] - self.sent["repeated"] - 8, patience=60.0)

    def test_each_twin_names_its_joint_and_tells_finite_numbers(self):
        for twin in TWINS:
            messages = self.wait_for_rows(twin)
            self.assertEqual({message.header.frame_id for message in messages}, {JOINTS[twin[1]]})
            self.assertTrue(all(math.isfinite(getattr(message, field)) for message in messages for field in FIELDS),
                            twin)
            self.assertEqual(sum(message.after_gap for message in messages), 1, twin)

    def test_the_sick_joint_stands_out(self):
        for mode in ("motion", "observer"):
            more = {}
            for joint in JOINTS:
                moving = [m for m in self.wait_for_rows((mode, joint)) if abs(m.velocity_measured) > 0.6]
                more[joint] = sum(math.copysign(1.0, m.velocity_measured) * m.current_residual
                                  for m in moving) / len(moving)
            self.assertGreater(abs(more["elbow"]), 0.3, (mode, more))
            self.assertLess(max(abs(more["base"]), abs(more["shoulder"])), 0.15, (mode, more))

    def test_live_and_offline_give_the_same_numbers(self):
        for twin in TWINS:
            name, joint = twin
            mode, load = MODES.get(name, name), LOADS.get(name, "model")
            out = os.path.join(self.directory, f"{name}_{joint}.csv")
            subprocess.run([executable("joint_twin"), "follow", self.bag_path, "--joint", joint, "--mode", mode,
                            "--config",
                            f"joints/{joint}.yaml", "--set", f"telemetry.load={load}", "--out", out],
                           check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            with open(out) as file:
                offline = [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]
            live = self.wait_for_rows(twin)
            self.assertEqual(all(message.load_told for message in live), name in LOADS)
            self.assertIn(len(offline) - len(live), range(9))
            for message, row in zip(live, offline):
                for field in FIELDS:
                    self.assertEqual(getattr(message, field), row[field], (twin, field, row["time"]))

    def test_what_was_wrong_with_the_messages_is_told(self):
        for twin in TWINS:
            self.wait_for_rows(twin)
            values = self.diagnostics[twin].fresh("Input")
            self.assertEqual(values["Topic"], "/joint_states")
            self.assertEqual(int(values["Not finite, refused"]), self.sent["not_finite"])
            self.assertEqual(int(values["Without position or effort, refused"]), self.sent["incomplete"])
            self.assertEqual(int(values["Unknown joint, refused"]), self.sent["unknown"])
            self.assertIn("gripper", values["Names in the last of those"])
            self.assertEqual(int(values["Stamps repeated"]), self.sent["repeated"])
            self.assertEqual(int(values["Gaps that cut the stream"]), 1)
            self.assertAlmostEqual(float(values["Period [s]"]), PERIOD, delta=1e-4)
            self.assertGreaterEqual(float(values["Reception less stamp [s]"]), 0.0)
            self.assertLess(float(values["Reception less stamp [s]"]), 0.5)

    def test_telemetry_that_stops_is_told_and_health_comes_from_it(self):
        twin = ("motion", "base")
        self.wait_for_rows(twin)
        wait_until(lambda: any("stopped" in status.message for status in self.diagnostics[twin].statuses("Input")),
                   "the end of the telemetry")
        self.assertEqual(self.diagnostics[twin].level("Input"), WARN)
        self.assertGreater(len(self.indicators.messages()), 3)
        self.assertEqual(self.assessments.messages()[-1].header.frame_id, JOINTS["base"])

    def test_every_number_on_every_topic_is_finite(self):
        for twin in TWINS:
            for name in ("comparison", "indicators", "assessment"):
                self.everything[twin, name].wait_for(1)
        for which, listener in self.everything.items():
            with self.subTest(topic=which):
                self.assertEqual([message for message in listener.messages()
                                  if not all(math.isfinite(number) for number in numbers_in(message))], [])


if __name__ == "__main__":
    rospy.init_node("ur5_test")
    rostest.rosrun(PACKAGE, "ur5", UR5, sys.argv)
