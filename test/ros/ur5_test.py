#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Twins beside a UR5 that publishes as its driver does, with what goes wrong on a network. The six joints draw the
currents that the twin predicts, with the noise of real ones."""
import csv
import math
import os
import shutil
import subprocess
import sys
import tempfile
import time
import unittest

import numpy as np
import rosbag
import rospy
import rostest
from sensor_msgs.msg import JointState, Temperature

from harmonic_joint_twin.msg import Assessment, Comparison, ContactForces, Encoders, Health, Indicators
from ros_support import (PACKAGE, PATIENCE, WARN, Diagnostics, Listener, executable, layout_curves, listen_to_all,
                         number_at, numbers_in, processor_time, wait_until)

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "support"))
from verdict_cases import recorded  # noqa: E402

JOINTS = {"base": "shoulder_pan_joint", "shoulder": "shoulder_lift_joint", "elbow": "elbow_joint",
          "wrist_1": "wrist_1_joint", "wrist_2": "wrist_2_joint", "wrist_3": "wrist_3_joint"}
ARMS = ("motion", "observer")
TWINS = [(mode, joint) for mode in ARMS for joint in JOINTS] + [("torque", "base"), ("loaded", "base")]
MODES = {"loaded": "motion"}            # of single joints, the others' are their names
LOADS = {"loaded": "target_moment"}     # of single joints, the others' is the model
ENDS = [0.6, -0.9, 1.1, -0.5, 0.4, 0.7]  # of the swings [rad]
TEMPERATURES = {"base": 25.5, "wrist_3": 31.0}  # at the begin; of the others none is published [degC]
PERIOD, SECONDS = 0.008, 8.0            # [s]
RATIO = 101.0                           # of every joint's gear [-]
WAIT_OF_ARM, WAIT_OF_JOINT = 25, 8      # rows whose later ones never came
FIELDS = [field for field in Comparison.__slots__ if field != "header"]


def load_at(row, begin):
    load = JointState(name=list(JOINTS.values()), effort=[8.0 * math.sin(0.02 * row)] * len(JOINTS))
    load.header.stamp = begin + rospy.Duration.from_sec(PERIOD * row)
    return load


def temperatures_at(row, begin):
    """Some of the joints' and the cabinet's; from time to time what a broken sensor gives."""
    values = [(joint, value + 0.001 * row) for joint, value in TEMPERATURES.items()]
    if row % 100 == 0:
        values += [(joint, bad) for joint in TEMPERATURES for bad in (float("nan"), 150.0)] + [("cabinet", 40.0)]
    for joint, value in values:
        message = Temperature(temperature=value)
        message.header.frame_id = JOINTS.get(joint, joint)
        message.header.stamp = begin + rospy.Duration.from_sec(PERIOD * row)
        yield message


class UR5(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.directory = tempfile.mkdtemp(prefix="ur5_test_")
        cls.comparisons = {twin: Listener(f"/{twin[0]}/{twin[1]}/joint_twin/comparison", Comparison) for twin in TWINS}
        cls.diagnostics = {twin: Diagnostics(f"/{twin[0]}/{twin[1]}/joint_twin") for twin in TWINS}
        cls.indicators = Listener("/motion/base/joint_twin/indicators", Indicators)
        cls.assessments = Listener("/motion/base/joint_twin/assessment", Assessment)
        times = np.round(np.arange(0.0, SECONDS, PERIOD), 9)
        angles = [0.0, -1.0, 0.0, 0.0, 0.0, 0.0] + 0.5 * (1.0 - np.cos(1.6 * times))[:, None] * ENDS
        robot = list(zip(angles, recorded("ur5", times, angles)[0]))
        cls.publisher = rospy.Publisher("/joint_states", JointState, queue_size=1000)
        cls.load_publisher = rospy.Publisher("/target_moments", JointState, queue_size=1000)
        cls.temperature_publisher = rospy.Publisher("/joint_temperatures", Temperature, queue_size=1000)
        wait_until(lambda: cls.temperature_publisher.get_num_connections() == len(ARMS) + 2, "temperatures' topic")
        wait_until(lambda: cls.load_publisher.get_num_connections() == 1, "the twin that receives its load")
        wait_until(lambda: cls.publisher.get_num_connections() == len(ARMS) + 2, "all nodes")
        cls.everything = {(twin, name): listener for twin in TWINS
                          for name, listener in listen_to_all(f"/{twin[0]}/{twin[1]}/joint_twin").items()}
        for listener in [*cls.comparisons.values(), *cls.everything.values()]:
            listener.wait_for_connection()
        cls.bag_path = os.path.join(cls.directory, "robot.bag")
        before = processor_time("/motion/joint_twin")
        cls.play(robot)
        cls.share = (processor_time("/motion/joint_twin") - before) / SECONDS

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.directory)

    @classmethod
    def play(cls, robot):
        """125 Hz by the wall clock: rows lost, sent twice, with NaN, without effort, of other joints only."""
        cls.sent = {"rows": 0, "repeated": 0, "not_finite": 0, "incomplete": 0, "unknown": 0}
        order = [2, 1, 0, 5, 4, 3]  # of UR's driver: the elbow first
        with rosbag.Bag(cls.bag_path, "w") as bag:
            begin = rospy.Time.now() + rospy.Duration.from_sec(0.5)  # the first loads have arrived by then
            for row, (position, current) in enumerate(robot):
                stamp = begin + rospy.Duration.from_sec(PERIOD * row)
                # Live ahead of their rows, as two topics keep no order between them.
                for ahead in range(row, row + 50) if row == 0 else range(row + 25, row + 75) if row % 50 == 25 else []:
                    cls.load_publisher.publish(load_at(ahead, begin))
                for ahead in [0] if row == 0 else [row + 25] if row % 50 == 25 and row + 25 < len(robot) else []:
                    for temperature in temperatures_at(ahead, begin):
                        cls.temperature_publisher.publish(temperature)
                time.sleep(max(0.0, (stamp - rospy.Time.now()).to_sec()))
                bag.write("/joint_twin/load", load_at(row, begin), rospy.Time.now())
                for temperature in temperatures_at(row, begin) if row % 50 == 0 else []:
                    bag.write("/joint_temperatures", temperature, rospy.Time.now())
                if row % 40 == 25 or 300 <= row < 330:
                    continue
                names = list(JOINTS.values())
                message = JointState(name=["finger_joint"] + [names[joint] for joint in order],
                                     position=[0.0] + [position[joint] for joint in order],
                                     effort=[0.0] + [current[joint] for joint in order])
                message.header.stamp = stamp
                kind = "rows"
                if row % 100 == 60:
                    message.effort = [float("nan")] * len(message.name)
                    kind = "not_finite"
                elif row % 100 == 70:
                    message.effort = []
                    kind = "incomplete"
                elif row % 100 == 80:
                    message.name[1:] = ["gripper", "track", "camera", "lift", "door", "lamp"]
                    kind = "unknown"
                for _ in range(2 if kind == "rows" and row % 100 == 10 else 1):
                    cls.publisher.publish(message)
                    bag.write("/joint_states", message, rospy.Time.now())
                    cls.sent[kind] += 1
                cls.sent["repeated"] += 1 if kind == "rows" and row % 100 == 10 else 0

    def wait_for_rows(self, twin):
        """All rows but those whose later ones never came."""
        wait = WAIT_OF_ARM if twin[0] in ARMS else WAIT_OF_JOINT
        rows = self.sent["rows"] - self.sent["repeated"] - wait
        return self.comparisons[twin].wait_for(rows, patience=2.0 * PATIENCE)

    def test_each_twin_names_its_joint_and_gives_finite_numbers(self):
        for twin in TWINS:
            messages = self.wait_for_rows(twin)
            self.assertEqual({message.header.frame_id for message in messages}, {JOINTS[twin[1]]})
            self.assertTrue(all(math.isfinite(getattr(message, field)) for message in messages for field in FIELDS),
                            twin)
            self.assertEqual(sum(message.after_gap for message in messages), 1, twin)
            for path in layout_curves()["comparison"]:
                self.assertTrue(math.isfinite(number_at(messages[-1], path)), path)

    def test_the_load_is_that_of_the_arm(self):
        for mode in ARMS:
            for joint in JOINTS:
                messages = self.wait_for_rows((mode, joint))
                self.assertTrue(all(message.load_told for message in messages), (mode, joint))
                moving = [m for m in messages if abs(m.velocity_measured) > 0.15]
                more = sum(math.copysign(1.0, m.velocity_measured) * m.current_residual for m in moving) / len(moving)
                self.assertLess(abs(more), 0.15, (mode, joint))

    def test_temperatures_are_those_received_and_bad_ones_are_not_used(self):
        for twin in TWINS:
            published = TEMPERATURES.get(twin[1])
            messages = self.wait_for_rows(twin)
            self.assertEqual({message.temperature_received for message in messages}, {published is not None}, twin)
            low, high = (published, published + 1.0) if published else (25.0, 25.0)
            for message in messages:
                self.assertGreaterEqual(message.temperature, low - 1e-9, twin)
                self.assertLessEqual(message.temperature, high + 1e-9, twin)
            values = self.diagnostics[twin].fresh("Drive")
            self.assertEqual(values["Source of the temperature"], "received" if published else "configured", twin)
            refused = int(self.diagnostics[twin].fresh("Input")["Temperatures refused"])
            self.assertEqual(refused, 2 * len(range(0, round(SECONDS / PERIOD), 100)) if published else 0, twin)

    def test_live_and_offline_give_the_same_numbers(self):
        for mode in ARMS:
            subprocess.run([executable("joint_twin"), "follow", self.bag_path, "--arm", "ur5", "--mode", mode, "--out",
                            os.path.join(self.directory, mode)],
                           check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        for twin in TWINS:
            name, joint = twin
            if name in ARMS:
                out = os.path.join(self.directory, name, joint + ".csv")
            else:
                mode, load = MODES.get(name, name), LOADS.get(name, "model")
                out = os.path.join(self.directory, f"{name}_{joint}.csv")
                subprocess.run([executable("joint_twin"), "follow", self.bag_path, "--joint", joint, "--mode", mode,
                                "--config",
                                f"joints/{joint}.yaml", "--set", f"telemetry.load={load}", "--out", out],
                               check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            with open(out) as file:
                offline = [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]
            live = self.wait_for_rows(twin)
            self.assertIn(len(offline) - len(live), range(WAIT_OF_ARM + 1))
            # The column of an arm's load holds the motor's inertia too, as a controller's torque does.
            fields = [field for field in FIELDS if name not in ARMS or field != "load_torque"]
            for message, row in zip(live, offline):
                for field in fields:
                    self.assertEqual(getattr(message, field), row[field], (twin, field, row["time"]))

    def test_tooth_forces_encoders_and_health_are_of_the_measured_joint(self):
        for mode in ARMS:
            for joint in JOINTS:
                rows = {row.header.stamp: row for row in self.wait_for_rows((mode, joint))}
                topics = {name: self.everything[(mode, joint), name].wait_for(50)
                          for name in ("contact_forces", "encoders", "health")}
                with self.subTest(mode=mode, joint=joint):
                    for kind, messages in zip((ContactForces, Encoders, Health), topics.values()):
                        self.assertEqual(messages[0]._md5sum, kind._md5sum)
                    for forces, encoders, health in zip(*topics.values()):
                        row = rows[forces.header.stamp]
                        self.assertEqual(encoders.header.stamp, forces.header.stamp)
                        self.assertAlmostEqual(forces.output_angle, row.position_measured, places=9)
                        self.assertAlmostEqual(encoders.output_angle_true, row.position_measured, places=9)
                        self.assertAlmostEqual(encoders.motor_angle_true / RATIO - row.position_measured,
                                               health.torsion, places=9)
                        self.assertLess(abs(health.torsion), 5e-3)
                        self.assertAlmostEqual(health.joint_torque, row.joint_torque, places=9)
                        self.assertEqual(sum(abs(force) > 0.0 for force in forces.mesh_force), health.teeth_loaded)
                        self.assertAlmostEqual(sum(forces.wave_generator_force), health.wave_generator_load, places=6)
                        self.assertEqual((health.torsion_min, health.torsion_max), (health.torsion, health.torsion))
                    # The rows since the message before.
                    for before, health in zip(topics["health"], topics["health"][1:]):
                        torques = [row.joint_torque for stamp, row in rows.items()
                                   if before.header.stamp < stamp <= health.header.stamp]
                        self.assertAlmostEqual(health.joint_torque_min, min(torques), places=9)
                        self.assertAlmostEqual(health.joint_torque_max, max(torques), places=9)
                        self.assertAlmostEqual(health.joint_torque_mean, sum(torques) / len(torques), places=6)
                        self.assertLessEqual(health.motor_torque_min, health.motor_torque_mean)
                        self.assertLessEqual(health.motor_torque_mean, health.motor_torque_max)

    def test_processor_time(self):
        print(f"six joints, motion mode, {1.0 / PERIOD:.0f} Hz, all topics heard: {100.0 * self.share:.1f} % of a core")
        self.assertLess(self.share, 0.6)

    def test_what_was_wrong_with_the_messages_is_reported(self):
        for twin in TWINS:
            self.wait_for_rows(twin)
            values = self.diagnostics[twin].fresh("Input")
            self.assertEqual(values["Topic"], "/joint_states")
            self.assertEqual(int(values["Not finite, refused"]), self.sent["not_finite"])
            self.assertEqual(int(values["Without position or effort, refused"]), self.sent["incomplete"])
            self.assertEqual(int(values["Unknown joint, refused"]), self.sent["unknown"])
            self.assertIn("gripper", values["Names in the last message without the joint"])
            self.assertEqual(int(values["Stamps repeated"]), self.sent["repeated"])
            self.assertEqual(int(values["Gaps that cut the stream"]), 1)
            self.assertAlmostEqual(float(values["Period [s]"]), PERIOD, delta=1e-4)
            self.assertGreaterEqual(float(values["Reception less stamp [s]"]), 0.0)
            self.assertLess(float(values["Reception less stamp [s]"]), 0.5)

    def test_telemetry_that_stops_is_reported_and_health_comes_from_it(self):
        twin = ("motion", "base")
        self.wait_for_rows(twin)
        wait_until(lambda: any("stopped" in status.message for status in self.diagnostics[twin].statuses("Input")),
                   "the end of the telemetry")
        self.assertEqual(self.diagnostics[twin].level("Input"), WARN)
        self.assertGreater(len(self.indicators.messages()), 3)
        self.assertEqual(self.assessments.messages()[-1].header.frame_id, JOINTS["base"])

    def test_every_number_on_every_topic_is_finite(self):
        for twin in TWINS:
            for name in ("comparison", "indicators", "assessment", "contact_forces", "encoders", "health", "stress",
                         "verdict"):
                self.everything[twin, name].wait_for(1)
        for which, listener in self.everything.items():
            with self.subTest(topic=which):
                self.assertEqual([message for message in listener.messages()
                                  if not all(math.isfinite(number) for number in numbers_in(message))], [])


if __name__ == "__main__":
    rospy.init_node("ur5_test")
    rostest.rosrun(PACKAGE, "ur5", UR5, sys.argv)
