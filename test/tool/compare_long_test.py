# SPDX-License-Identifier: BSD-3-Clause
"""`joint_twin compare` over hours: time and memory."""
import os
import subprocess
import time

import robot
import tool

DURATION, SHORT = 7200.0, 300.0  # [s]
FASTER = 20.0  # than the recording took
OPTIONS = ["--joint", "elbow", "--config", "joints/elbow.yaml", "--force", "--report"]
INDEX = 100  # [byte] at most, of rosbag's own index of an open bag, for each message
SLACK = 4 * 1024 ** 2  # [byte]


class Long(tool.ToolTest):
    def measure(self, name):
        """Seconds and peak memory [byte] of a comparison, without the page: that another program makes."""
        started = time.monotonic()
        process = subprocess.Popen([self.executable, "compare", self.path(name), *OPTIONS, self.path("report")],
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                                   env=dict(os.environ, PYTHONPATH=self.directory))
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.WEXITSTATUS(status)
        self.assertEqual(process.returncode, 1)
        self.assertIn("comparison.json", os.listdir(self.path("report")))
        return time.monotonic() - started, 1024 * usage.ru_maxrss

    def growth(self, write, name):
        """By how much more memory two hours take than five minutes [byte]; their time is checked."""
        self.write("jinja2.py", "raise ImportError(name='jinja2')\n")
        write(self.path("short" + name), SHORT)
        write(self.path("long" + name), DURATION)
        _, short = self.measure("short" + name)
        took, long = self.measure("long" + name)
        print(f"two hours, {name}: {took:.1f} s, {DURATION / took:.0f} times as fast; memory {long / 1024 ** 2:.0f} MB, "
              f"five minutes: {short / 1024 ** 2:.0f} MB", flush=True)
        self.assertLess(took, DURATION / FASTER)
        return long - short

    def test_a_table_of_two_hours_takes_no_more_memory_than_one_of_minutes(self):
        self.assertLess(self.growth(robot.write_long_csv, ".csv"), SLACK)

    def test_a_bag_of_two_hours_takes_more_by_its_index_alone(self):
        self.assertLess(self.growth(robot.write_long_bag, ".bag"), INDEX * robot.RATE * DURATION + SLACK)


if __name__ == "__main__":
    tool.main()
