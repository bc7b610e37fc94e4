# SPDX-License-Identifier: BSD-3-Clause
"""Writes recordings as ROS 1 and ROS 2 do: .bag, .db3, .mcap."""
import sqlite3
import struct

import genpy
import rosbag
from sensor_msgs.msg import JointState

import tool

JOINTS = tool.JOINT_NAMES


def states(columns, prefix="", suffix="", start=tool.START):
    """(seconds, JointState) of each row."""
    for row, seconds in enumerate(columns["timestamp"]):
        of = {quantity: [columns[f"actual_{quantity}_{joint}"][row] for joint in range(6)]
              for quantity in ("q", "qd", "current")}
        state = JointState(name=[prefix + name + suffix for name in JOINTS], position=of["q"], velocity=of["qd"],
                           effort=of["current"])
        state.header.stamp = genpy.Time(start) + genpy.Duration.from_sec(seconds)
        yield seconds, state


def write_bag(path, messages, recorded_from=tool.START):
    with rosbag.Bag(path, "w") as bag:
        for seconds, state in messages:
            bag.write("/joint_states", state, genpy.Time(recorded_from) + genpy.Duration.from_sec(seconds + 0.0005))
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
