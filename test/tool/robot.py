# SPDX-License-Identifier: BSD-3-Clause
"""Made-up telemetry of a robot's elbow, for the tests that read recordings."""
import io
import math
import random
import struct

import genpy
import numpy as np
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


def write_bag(path, duration, friction=1.0, with_load=True, dropped=0.0):
    """`dropped`: share of the messages that are left out, of either topic."""
    generator = random.Random(5)
    with rosbag.Bag(path, "w") as bag:
        for stamp, state, load in rows(duration, friction):
            if with_load and generator.random() >= dropped:
                bag.write(LOAD_TOPIC, load, stamp)
            if generator.random() >= dropped:
                bag.write(STATES_TOPIC, state, stamp)


def minute():
    """The joint states of a motion that repeats itself, after 20 pi seconds."""
    return [state for _, state, _ in rows(20.0 * math.pi)]


def fields(**values):
    """As the records of a bag hold them."""
    return b"".join(struct.pack("<I", len(name) + 1 + len(value)) + name.encode() + b"=" + value
                    for name, value in values.items())


def record(data, **header):
    names = fields(**header)
    return struct.pack("<I", len(names)) + names + struct.pack("<I", len(data)) + data


def write_long_bag(path, duration):
    """Hours of telemetry without load, a chunk for each motion: rosbag itself takes 20 s for an hour."""
    def number(value, kind="I"):
        return struct.pack("<" + kind, value)

    connection = record(fields(topic=STATES_TOPIC.encode(), type=JointState._type.encode(),
                               md5sum=JointState._md5sum.encode(), message_definition=JointState._full_text.encode()),
                        op=b"\x07", conn=number(0), topic=STATES_TOPIC.encode())
    messages = []
    for state in minute():
        data = io.BytesIO()
        state.serialize(data)
        messages.append(record(data.getvalue(), op=b"\x02", conn=number(0), time=bytes(8)))
    size, stamp_at = len(messages[0]), len(messages[0]) - len(data.getvalue()) + 4
    time_at = messages[0].index(b"time=") + len("time=")
    motion = np.frombuffer(b"".join(messages), np.uint8).reshape(-1, size)
    count = int(duration * RATE)
    chunks = []
    with open(path, "wb") as file:
        file.write(b"#ROSBAG V2.0\n" + bytes(4096))
        for begin in range(0, count, len(motion)):
            rows = motion[:count - begin].copy()
            nanoseconds = tool.START * 10 ** 9 + np.arange(begin, begin + len(rows)) * round(1e9 / RATE)
            stamps = np.stack(np.divmod(nanoseconds, 10 ** 9), axis=1).astype("<u4")
            rows[:, time_at:time_at + 8] = rows[:, stamp_at:stamp_at + 8] = stamps.view(np.uint8)
            before = b"" if chunks else connection
            places = len(before) + size * np.arange(len(rows), dtype="<u4")
            chunks.append(record(struct.pack("<II", 0, len(rows)), op=b"\x06", ver=number(1),
                                 chunk_pos=number(file.tell(), "Q"), start_time=stamps[0].tobytes(),
                                 end_time=stamps[-1].tobytes(), count=number(1)))
            data = before + rows.tobytes()
            file.write(record(data, op=b"\x05", compression=b"none", size=number(len(data))))
            file.write(record(np.column_stack([stamps, places]).astype("<u4").tobytes(), op=b"\x04", ver=number(1),
                              conn=number(0), count=number(len(rows))))
        header = {"op": b"\x03", "index_pos": number(file.tell(), "Q"), "conn_count": number(1),
                  "chunk_count": number(len(chunks))}
        file.write(connection + b"".join(chunks))
        file.seek(len(b"#ROSBAG V2.0\n"))
        file.write(record((4096 - len(record(b"", **header))) * b" ", **header))


def write_long_csv(path, duration):
    """The same as a controller's table, which has columns of other joints too."""
    values = [f"{state.position[1]:.9f},{state.effort[1]:.6f}" for state in minute()]
    with open(path, "w", encoding="ascii") as file:
        joints = (2, 1, 0)
        file.write(",".join(["timestamp"] + [f"actual_q_{joint},actual_current_{joint}" for joint in joints]) + "\n")
        for row in range(int(duration * RATE)):
            file.write(f"{row / RATE:.3f}" + len(joints) * ("," + values[row % len(values)]) + "\n")
