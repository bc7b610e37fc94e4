# SPDX-License-Identifier: BSD-3-Clause
"""A made-up UR5 and its recordings, as a controller, ROS 1 and ROS 2 write them: tables, .bag, .db3, .mcap."""
import functools
import os
import sqlite3
import struct
import subprocess
import tempfile

import genpy
import numpy as np
import rosbag
from sensor_msgs.msg import JointState

import tool

JOINTS = tool.JOINT_NAMES
NAMES = ["base", "shoulder", "elbow", "wrist_1", "wrist_2", "wrist_3"]
GAINS = [10.7, 10.7, 10.7, 10.21, 11.9, 11.92]  # of config/arms/ur5.yaml [N.m/A]


def swinging(seconds=40.0, period=0.008):
    """Its motion from the stretched, level pose, with friction alone: columns as those of a controller."""
    time = np.arange(0.0, seconds, period)
    columns = {"timestamp": time}
    noise = np.random.default_rng(3)
    for joint in range(6):
        rate = 0.7 + 0.17 * joint
        columns[f"actual_q_{joint}"] = 0.6 * np.sin(rate * time)
        columns[f"actual_qd_{joint}"] = 0.6 * rate * np.cos(rate * time)
        friction = 10.0 * np.sign(columns[f"actual_qd_{joint}"])
        columns[f"actual_current_{joint}"] = friction / GAINS[joint] + noise.normal(0.0, 0.05, len(time))
    return columns


@functools.lru_cache(maxsize=None)
def predicted(executable, seconds, period, arm, *changes):
    """Currents that the twins of an arm predict for that motion, and the friction in them, by joint [A]. `changes`: of
    their parameters."""
    columns = swinging(seconds, period)
    with tempfile.TemporaryDirectory() as folder:
        motion = write_csv(os.path.join(folder, "motion.csv"), columns)
        subprocess.run([executable, "follow", motion, "--arm", arm, "--out", os.path.join(folder, "out"),
                        *(word for change in changes for word in ("--set", change))], check=True,
                       stdout=subprocess.DEVNULL)
        rows = [tool.read_columns(os.path.join(folder, "out", f"{name}.csv")) for name in NAMES]
    return [[np.interp(columns["timestamp"], own["time"], values)
             for values in (own["current_predicted"], own["friction_torque"] / gain)] for own, gain in zip(rows, GAINS)]


def sound(test, seconds=40.0, period=0.008, arm="ur5", raised=(), share=0.3, changes=()):
    """The same with the currents that the twins predict, friction of these joints raised by a share, and some noise."""
    columns = swinging(seconds, period)
    noise = np.random.default_rng(7)
    for joint, (current, friction) in enumerate(predicted(test.executable, seconds, period, arm, *changes)):
        more = share * friction if NAMES[joint] in raised else 0.0
        columns[f"actual_current_{joint}"] = current + more + noise.normal(0.0, 0.02, len(current))
    return columns


def write_csv(path, columns):
    with open(path, "w", encoding="ascii") as file:
        file.write(",".join(columns) + "\n")
        for row in zip(*columns.values()):
            file.write(",".join(f"{value:.15g}" for value in row) + "\n")
    return path


def states(columns, prefix="", suffix="", start=tool.START, left_out=None):
    """(seconds, JointState) of each row."""
    joints = [joint for joint in range(6) if joint != left_out]
    for row, seconds in enumerate(columns["timestamp"]):
        of = {quantity: [columns[f"actual_{quantity}_{joint}"][row] for joint in joints]
              for quantity in ("q", "qd", "current")}
        state = JointState(name=[prefix + JOINTS[joint] + suffix for joint in joints], position=of["q"],
                           velocity=of["qd"], effort=of["current"])
        state.header.stamp = genpy.Time(start) + genpy.Duration.from_sec(seconds)
        yield seconds, state


def write_bag(path, messages, compression="none"):
    with rosbag.Bag(path, "w", compression=compression) as bag:
        for seconds, state in messages:
            bag.write("/joint_states", state, genpy.Time(tool.START) + genpy.Duration.from_sec(seconds + 0.0005))
    return path


class Cdr:
    """Bytes of a message as ROS 2 writes them."""

    def __init__(self, big=False):
        self.order = ">" if big else "<"
        self.data = bytearray(b"\0\0\0\0" if big else b"\0\1\0\0")

    def number(self, kind, value):
        size = struct.calcsize(kind)
        self.data += b"\0" * (-(len(self.data) - 4) % size) + struct.pack(self.order + kind, value)

    def text(self, value):
        self.number("I", len(value) + 1)
        self.data += value.encode() + b"\0"

    def state(self, state):
        self.number("i", state.header.stamp.secs)
        self.number("I", state.header.stamp.nsecs)
        self.text("base_link")
        self.number("I", len(state.name))
        for name in state.name:
            self.text(name)
        for values in (state.position, state.velocity, state.effort):
            self.number("I", len(values))
            for value in values:
                self.number("d", value)
        return bytes(self.data)


def nanoseconds(state):
    return state.header.stamp.to_nsec() + 500000


def write_db3(path, messages, big=False):
    database = sqlite3.connect(path)
    database.execute("CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, "
                     "serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL)")
    database.execute("CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, "
                     "timestamp INTEGER NOT NULL, data BLOB NOT NULL)")
    database.execute("INSERT INTO topics VALUES(1, '/rosout', 'rcl_interfaces/msg/Log', 'cdr', '')")
    database.execute("INSERT INTO topics VALUES(7, '/joint_states', 'sensor_msgs/msg/JointState', 'cdr', '')")
    database.executemany("INSERT INTO messages(topic_id, timestamp, data) VALUES(7, ?, ?)",
                         ((nanoseconds(state), Cdr(big).state(state)) for _, state in messages))
    database.commit()
    database.close()
    return path


def record(opcode, data):
    return struct.pack("<BQ", opcode, len(data)) + data


def text(value):
    return struct.pack("<I", len(value)) + value.encode()


def write_mcap(path, messages, compress=None, closed=True):
    """`compress`: name in the file and function; none: messages outside of chunks."""
    head = (record(3, struct.pack("<H", 1) + text("sensor_msgs/msg/JointState") + text("ros2msg") + text("")) +
            record(4, struct.pack("<HH", 0, 1) + text("/joint_states") + text("cdr") + struct.pack("<I", 0)))
    parts = [record(5, struct.pack("<HIQQ", 0, 0, nanoseconds(state), nanoseconds(state)) + Cdr().state(state))
             for _, state in messages]
    with open(path, "wb") as file:
        file.write(b"\x89MCAP0\r\n" + record(1, text("ros2") + text("test")))
        for begin in range(0, len(parts), 500):
            body = (head if begin == 0 else b"") + b"".join(parts[begin:begin + 500])
            if compress:
                packed = compress[1](body)
                body = record(6, struct.pack("<QQQI", 0, 0, len(body), 0) + text(compress[0]) +
                              struct.pack("<Q", len(packed)) + packed)
            file.write(body)
        if closed:
            file.write(record(15, struct.pack("<I", 0)) + record(2, struct.pack("<QQI", 0, 0, 0)) + b"\x89MCAP0\r\n")
    return path
