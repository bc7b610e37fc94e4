# SPDX-License-Identifier: BSD-3-Clause
"""A recording of a UR as a controller's table and as a driver's bag: times, and angles and currents of its six joints,
shape (rows, 6)."""
import genpy
import numpy as np
import rosbag
from sensor_msgs.msg import JointState

JOINTS = ["shoulder_pan_joint", "shoulder_lift_joint", "elbow_joint", "wrist_1_joint", "wrist_2_joint", "wrist_3_joint"]


def write_csv(path, times, angles, currents):
    names = ["timestamp"] + [f"actual_q_{i}" for i in range(6)] + [f"actual_current_{i}" for i in range(6)]
    np.savetxt(path, np.column_stack([times, angles, currents]), "%.17g", ",", header=",".join(names), comments="")


def write_bag(path, times, angles, currents):
    with rosbag.Bag(path, "w") as bag:
        for at, position, effort in zip(times, angles, currents):
            stamp = genpy.Time(1000) + genpy.Duration.from_sec(at)
            state = JointState(name=JOINTS, position=list(position), effort=list(effort))
            state.header.stamp = stamp
            bag.write("/joint_states", state, stamp)
