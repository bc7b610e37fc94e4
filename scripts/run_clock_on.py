#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs /clock on from the end of a bag that has been played, so that a twin which holds back simulates to its end."""
import argparse
import time

import rosbag
import rosgraph
import rospy
from rosgraph_msgs.msg import Clock

PATIENCE = 10.0     # for the listeners of the clock [s]
PERIOD = 0.001      # between two messages on the clock [s]
ROUNDING = 1e-6     # of the bag's end, which rosbag tells as a float since the epoch [s]


def connect():
    """A publisher of /clock, once all who listen to it have found it."""
    clock = rospy.Publisher("/clock", Clock, queue_size=1000)
    master = rosgraph.Master(rospy.get_name())
    deadline = time.monotonic() + PATIENCE
    while time.monotonic() < deadline:
        _, subscribed, _ = master.getSystemState()
        listeners = {node for topic, nodes in subscribed if topic == "/clock" for node in nodes}
        if listeners <= {connection.endpoint_id for connection in clock.impl.connections}:
            break
        time.sleep(PERIOD)
    return clock


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("bag", help="the bag that has been played")
    parser.add_argument("duration", type=float, help="how far the clock runs on [s]")
    parser.add_argument("--rate", type=float, default=1.0, help="speed of the clock, times real time")
    parser.add_argument("--wait", type=float, default=0.0, help="by the wall clock, once the clock stands [s]")
    options = parser.parse_args(rospy.myargv()[1:])
    with rosbag.Bag(options.bag) as bag:
        end = rospy.Time.from_sec(bag.get_end_time() + ROUNDING)
    rospy.init_node("run_clock_on", anonymous=True, disable_rostime=True)
    clock = connect()
    begin = time.monotonic()
    elapsed = 0.0
    while elapsed < options.duration and not rospy.is_shutdown():
        elapsed = min((time.monotonic() - begin) * options.rate, options.duration)
        clock.publish(end + rospy.Duration.from_sec(elapsed))
        time.sleep(PERIOD)
    time.sleep(options.wait)


if __name__ == "__main__":
    main()
