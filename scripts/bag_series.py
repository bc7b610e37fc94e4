# SPDX-License-Identifier: BSD-3-Clause
"""Reads the signals of one simulated joint from a bag, as numpy arrays over the time of their stamps."""
import sys

import numpy as np
import rosbag

HEALTH_TYPE = "harmonic_joint_twin/Health"
FEW = 20000  # number of messages up to which no progress is printed


class Series:
    """Messages of one topic: `time` [s] since the start of the simulation, and one array for each field."""

    def __init__(self, time, fields):
        self.time = time
        self.fields = fields

    def __getitem__(self, name):
        return self.fields[name]

    def __len__(self):
        return len(self.time)


def input_row(message, joint):
    """Torque [N.m] in a stamped message, if the message names this joint or its motor; otherwise None."""
    for name in (joint, joint + "_motor"):
        if name in message.name and len(message.effort) > message.name.index(name):
            return {"torque": message.effort[message.name.index(name)]}
    return None


def measured_row(message, joint):
    """Speed [rad/s] of this joint in the telemetry of a robot; None if the message lacks the joint."""
    if joint in message.name and len(message.velocity) > message.name.index(joint):
        return {"velocity": message.velocity[message.name.index(joint)]}
    return None


def joint_states_row(message, _joint):
    """Values of a message in which the node puts the motor first, then the joint."""
    return {"motor_velocity": message.velocity[0], "output_velocity": message.velocity[1],
            "motor_torque": message.effort[0], "joint_torque": message.effort[1]}


def slots_row(message, _joint):
    return {name: getattr(message, name) for name in message.__slots__ if name != "header"}


ROWS = {"command": input_row, "load": input_row, "joint_states": joint_states_row, "encoders": slots_row,
        "contact_forces": slots_row, "health": slots_row, "stress": slots_row, "measured": measured_row}

TELEMETRY = "/joint_states"  # topic of the robot beside the twin, if the bag is a recording
OUTPUTS = ["joint_states", "encoders", "contact_forces", "health"]


def find_namespaces(bag):
    """Namespaces in the bag with the output of a twin."""
    topics = bag.get_type_and_topic_info().topics
    return sorted(topic[:-len("/health")] for topic, info in topics.items()
                  if info.msg_type == HEALTH_TYPE and topic.endswith("/health"))


class Recording:
    """Topics of a twin in a bag. `joint` is the name of the joint, `ratio` the nominal ratio of its gear, and `counts`
    the number of messages of each topic."""

    def __init__(self, path, namespace=None):
        with rosbag.Bag(path) as bag:
            found = find_namespaces(bag)
            if not found:
                raise ValueError(f"{path} has no topic of type {HEALTH_TYPE}, so it contains no output of a twin")
            if namespace is not None and namespace not in found:
                raise ValueError(f"{path} has no twin in {namespace}; it has twins in {', '.join(found)}")
            self.namespace = namespace if namespace is not None else found[0]
            topics = {f"{self.namespace}/{name}": name for name in ROWS if name != "measured"}
            topics[TELEMETRY] = "measured"
            info = bag.get_type_and_topic_info(list(topics)).topics
            self.counts = {topics[topic]: info[topic].message_count for topic in topics if topic in info}
            missing = [name for name in OUTPUTS if not self.counts.get(name)]
            if missing:
                raise ValueError(f"{path} has no messages on {self.namespace}/{missing[0]}")
            _, first, _ = next(bag.read_messages([f"{self.namespace}/health"]))
            self.joint = first.header.frame_id
            self._read(bag, topics)

    def _read(self, bag, topics):
        stamps = {name: [] for name in ROWS}
        rows = {name: [] for name in ROWS}
        total = sum(self.counts.values())
        tenth = max(1, total // 10)
        for number, (topic, message, _) in enumerate(bag.read_messages(list(topics)), start=1):
            name = topics[topic]
            row = ROWS[name](message, self.joint)
            if row is not None:
                stamps[name].append(message.header.stamp.to_nsec())
                rows[name].append(row)
            if total > FEW and number % tenth == 0:
                print(f"  reading {10 * (number // tenth)} %", file=sys.stderr, flush=True)
        start = min(stamps[name][0] for name in OUTPUTS)
        self.series = {name: to_series(stamps[name], rows[name], start) for name in ROWS}
        # The circular spline turns with the output. It has two teeth more than the flexspline.
        self.ratio = 0.5 * (self.series["contact_forces"]["mesh_force"].shape[1] + 2)

    def __getitem__(self, name):
        return self.series[name]


def to_series(stamps, rows, start):
    order = np.argsort(np.array(stamps, dtype=np.int64), kind="stable")
    fields = rows[0].keys() if rows else []
    time = (np.array(stamps, dtype=np.int64)[order] - start) * 1e-9
    return Series(time, {name: np.array([row[name] for row in rows])[order] for name in fields})
