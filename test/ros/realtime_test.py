#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""The node as a real-time process: granted what it asks for, refused it, and stopped for longer than its deadline."""
import os
import signal
import subprocess
import sys
import time
import unittest

import rospy
import rostest

from harmonic_joint_twin.msg import Timing
from ros_support import (PACKAGE, WARN, Diagnostics, Listener, Node, configuration_files, load_parameters,
                         wait_until)

SANITIZED = "ASAN_OPTIONS" in os.environ
NODE = "/twin_under_test"
PRIORITY = 80
ASKED = {"realtime/priority": PRIORITY, "realtime/lock_memory": True}
# Without privileges, whoever runs the test.
UNPRIVILEGED = ["prlimit", "--rtprio=0", "--memlock=65536"]
if os.geteuid() == 0:
    UNPRIVILEGED += ["setpriv", "--bounding-set=-sys_nice,-ipc_lock,-sys_resource"]


def is_permitted():
    return subprocess.run(["chrt", "-f", str(PRIORITY), "true"], stderr=subprocess.DEVNULL).returncode == 0


class Realtime(unittest.TestCase):
    def start(self, changes, prefix=()):
        load_parameters(NODE, configuration_files(), changes)
        self.diagnostics = Diagnostics(NODE)
        self.node = Node(NODE.lstrip("/"), prefix=prefix)
        self.addCleanup(self.node.kill)
        wait_until(lambda: self.node.process.poll() is not None or self.diagnostics.values("Timing"), "the node")
        self.assertIsNone(self.node.process.poll(), self.node.output())

    def loop_thread(self):
        """Number of the thread that runs the loop."""
        tasks = f"/proc/{self.node.process.pid}/task"
        for task in os.listdir(tasks):
            with open(f"{tasks}/{task}/comm") as name:
                if name.read().strip() == "twin_loop":
                    return task
        self.fail("no thread twin_loop")

    def scheduling(self):
        return subprocess.run(["chrt", "-p", self.loop_thread()], stdout=subprocess.PIPE, text=True, check=True).stdout

    def locked_memory(self):
        """Of the process [KiB]."""
        with open(f"/proc/{self.node.process.pid}/status") as status:
            return next(int(line.split()[1]) for line in status if line.startswith("VmLck"))

    def check_running(self):
        first = float(self.diagnostics.fresh("Timing")["Simulated instant [s]"])
        self.assertGreater(float(self.diagnostics.fresh("Timing")["Simulated instant [s]"]), first)

    @unittest.skipIf(SANITIZED, "the sanitizer locks no memory")
    @unittest.skipUnless(is_permitted(), "SCHED_FIFO is not permitted here")
    def test_the_loop_alone_gets_its_priority_and_the_memory_is_locked(self):
        self.start(dict(ASKED, **{"realtime/processor": 0}))
        self.assertIn("SCHED_FIFO", self.scheduling())
        self.assertIn(f"priority: {PRIORITY}", self.scheduling())
        main_thread = os.sched_getscheduler(self.node.process.pid)
        self.assertEqual(main_thread, os.SCHED_OTHER)
        self.assertEqual(os.sched_getaffinity(int(self.loop_thread())), {0})
        self.assertGreater(self.locked_memory(), 1000)
        values = self.diagnostics.values("Timing")
        self.assertEqual([values[key] for key in ("Scheduling", "Memory", "Processor")],
                         [f"SCHED_FIFO {PRIORITY}", "locked", "0"])
        self.check_running()

    @unittest.skipIf(SANITIZED, "the sanitizer locks no memory")
    def test_what_is_not_permitted_is_said_with_its_remedy_and_the_node_goes_on(self):
        self.start(ASKED, UNPRIVILEGED)
        self.assertIn("SCHED_OTHER", self.scheduling())
        self.assertEqual(self.locked_memory(), 0)
        values = self.diagnostics.values("Timing")
        self.assertEqual(values["Scheduling"], f"SCHED_OTHER, SCHED_FIFO {PRIORITY} refused")
        self.assertEqual(values["Memory"], "not locked, refused")
        self.assertEqual(self.diagnostics.level("Timing"), WARN)
        self.check_running()
        for text in ("RLIMIT_RTPRIO is 0", f"- rtprio {PRIORITY}'", "RLIMIT_MEMLOCK is 64 [KiB]",
                     "- memlock unlimited'", "/etc/security/limits.conf"):
            self.assertIn(text, self.node.output())
        self.assertEqual(self.node.output().count("realtime.priority = "), 1)

    def test_a_processor_that_is_not_there_is_said(self):
        self.start({"realtime/processor": 1023})
        self.assertEqual(self.diagnostics.values("Timing")["Processor"], "any, 1023 refused")
        self.assertIn("realtime.processor = 1023 [-] was refused", self.node.output())
        self.check_running()

    def test_a_stall_is_counted_as_missed_and_warned_of(self):
        self.start({})
        timing = Listener(f"{NODE}/timing", Timing)
        self.addCleanup(timing.close)
        before = timing.wait_for(1)[-1].missed_deadlines
        self.node.process.send_signal(signal.SIGSTOP)
        time.sleep(0.3)
        self.node.process.send_signal(signal.SIGCONT)
        wait_until(lambda: timing.messages()[-1].missed_deadlines > before, "a missed deadline")
        self.assertGreater(timing.messages()[-1].lateness_max, 0.2)
        wait_until(lambda: any(status.level == WARN and "Deadlines were missed" in status.message
                               for status in self.diagnostics.statuses("Timing")), "the warning")


if __name__ == "__main__":
    rospy.init_node("realtime_test")
    rostest.rosrun(PACKAGE, "realtime", Realtime, sys.argv)
