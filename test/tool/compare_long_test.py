# SPDX-License-Identifier: BSD-3-Clause
"""`joint_twin compare` over hours: processor time and memory."""
import os

import robot
import tool

HOUR = 3600.0  # [s]
FASTER = 20.0  # than the recording took
OPTIONS = ["--joint", "elbow", "--config", "joints/elbow.yaml", "--force", "--report", "report"]
INDEX = 64  # [byte] of rosbag's own index of an open bag, for each message: a tree's node of 56, as malloc gives it
SLACK = 4 * 1024 ** 2  # [byte]


class Long(tool.ToolTest):
    def compare(self, name):
        """Processor time [s] and peak memory [byte], without the page: that another program makes."""
        code, took, peak = self.measure("compare", name, *OPTIONS, environment=tool.NO_PAGE)
        self.assertEqual(code, 0)
        self.assertIn("comparison.json", os.listdir(self.path("report")))
        return took, peak

    def growth(self, write, name, short, long):
        """By how much more memory a long recording takes than a short one [byte]; its time is checked."""
        write(self.path("short" + name), short)
        write(self.path("long" + name), long)
        _, least = self.compare("short" + name)
        took, most = self.compare("long" + name)
        print(f"{long / HOUR:.1f} hours, {name}: {took:.1f} s, {long / took:.0f} times as fast; memory "
              f"{most / 1024 ** 2:.0f} MB, of {short / HOUR:.1f} hours {least / 1024 ** 2:.0f} MB", flush=True)
        self.assertLess(took, long / FASTER)
        return most - least

    def test_a_table_takes_no_more_memory_the_longer_it_is(self):
        # Below 48 MB, which is what the reader's own buffer holds, a table fills it the more the longer it is.
        self.assertLess(self.growth(robot.write_long_csv, ".csv", 2.0 * HOUR, 4.0 * HOUR), SLACK)

    def test_a_bag_of_two_hours_takes_more_by_its_index_alone(self):
        # After an hour the references of nearly all operating points are there.
        short, long = HOUR, 2.0 * HOUR
        messages = robot.RATE * (long - short)
        self.assertLess(self.growth(robot.write_long_bag, ".bag", short, long), INDEX * messages + SLACK)


if __name__ == "__main__":
    tool.main()
