#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Writes the torque profile of the demo as a bag of stamped commands: start, run, load step, reverse, stop."""
import argparse

import numpy as np
import rosbag
import rospy
from sensor_msgs.msg import JointState

NAMESPACE = "/joint_twin"
JOINT = "shoulder_pan_joint"  # name of the joint in config/joints/base.yaml
RATE = 125.0                  # rate of a UR5's controller [Hz]
START_STAMP = 1.0             # first stamp; ROS takes a stamp of 0 as the present time [s]

# Points (time [s], torque [N.m]) with straight lines between them. Friction needs about 0.2 N.m of motor torque, and a
# load needs 1/101 of its own torque.
MOTOR_TORQUE = [(0.0, 0.0), (0.4, 0.0), (0.5, 0.42), (0.9, 0.42), (1.0, 0.26), (2.4, 0.26), (2.5, 0.68), (3.6, 0.68),
                (3.7, 0.10), (3.9, -0.42), (4.5, -0.42), (4.6, -0.26), (6.6, -0.26), (6.7, 0.0), (8.0, 0.0)]
LOAD_TORQUE = [(0.0, 0.0), (2.4, 0.0), (2.5, 40.0), (3.6, 40.0), (3.7, 0.0), (8.0, 0.0)]


def message(stamp, torque):
    effort = JointState(name=[JOINT], effort=[torque])
    effort.header.stamp = stamp
    return effort


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("out", metavar="OUT.bag")
    options = parser.parse_args()
    times = np.arange(0.0, MOTOR_TORQUE[-1][0], 1.0 / RATE)
    with rosbag.Bag(options.out, "w") as bag:
        for time in times:
            stamp = rospy.Time.from_sec(START_STAMP + time)
            for topic, points in (("command", MOTOR_TORQUE), ("load", LOAD_TORQUE)):
                torque = float(np.interp(time, *zip(*points)))
                bag.write(f"{NAMESPACE}/{topic}", message(stamp, torque), stamp)


if __name__ == "__main__":
    main()
