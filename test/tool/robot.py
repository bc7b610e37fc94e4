# SPDX-License-Identifier: BSD-3-Clause
"""Made-up telemetry of a robot's elbow, for the tests that read recordings."""
import math
import random

import genpy
import rosbag
from sensor_msgs.msg import JointState

import tool

RATIO, GAIN = 101.0, 9.5  # [-], [N.m/A]
COULOMB, VISCOUS = 12.0, 4.0  # [N.m], [N.m.s/rad] at the joint
NOISE = 0.02  # [A]
RATE = 125.0  # [Hz]
JOINT = "elbow_joint"
LOAD_TOPIC = "/joint_twin/load"
STATES_TOPIC = "/joint_states"


def telemetry(seconds, generator, friction=1.0):
    """Elbow under a weight, swinging: angle, current and load as a robot would tell them."""
    angle = 0.7 * math.sin(0.9 * seconds) + 0.2 * math.sin(2.3 * seconds)
    speed = 0.63 * math.cos(0.9 * seconds) + 0.46 * math.cos(2.3 * seconds)
    load = 20.0 * math.sin(angle + 0.4)
    torque = load + friction * (math.copysign(COULOMB, speed) + VISCOUS * speed)
    return angle, torque / GAIN + generator.gauss(0.0, NOISE), load


def message(names, positions, efforts, stamp):
    state = JointState(name=names, position=positions, effort=efforts)
    state.header.stamp = stamp
    return state


def rows(duration, friction=1.0):
    """(stamp, joint states, load) of each row."""
    generator = random.Random(4)
    for row in range(int(duration * RATE)):
        seconds = row / RATE
        stamp = genpy.Time(tool.START) + genpy.Duration.from_sec(seconds + 0.001 * generator.random())
        angle, current, load = telemetry(seconds, generator, friction)
        yield (stamp, message(["wrist_1_joint", JOINT], [0.0, angle], [0.0, current], stamp),
               message([JOINT], [], [load], stamp))


def write_bag(path, duration, friction=1.0, with_load=True):
    with rosbag.Bag(path, "w") as bag:
        for stamp, state, load in rows(duration, friction):
            if with_load:
                bag.write(LOAD_TOPIC, load, stamp)
            bag.write(STATES_TOPIC, state, stamp)
