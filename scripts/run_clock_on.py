#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Continues /clock after the end of a played bag, so that the twin, which is behind the clock, simulates the end."""
import argparse
import time

import rosbag
import rosgraph
import rospy
from rosgraph_msgs.msg import Clock

PATIENCE = 10.0     # longest wait for the subscribers of /clock [s]
PERIOD = 0.001      # time between two messages on /clock [s]
ROUNDING = 1e-6     # rounding error of the bag's end, which rosbag gives as a float since the epoch [s]


def connect():
    """Returns a publisher of /clock after all subscribers have connected, or after PATIENCE."""
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
    parser.add_argument("duration", type=float, help="time by which the clock advances beyond the end of the bag [s]")
    parser.add_argument("--rate", type=float, default=1.0, help="speed of the clock as a multiple of real time")
    parser.add_argument("--wait", type=float, default=0.0, help="wait at the end, in wall clock time [s]")
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
