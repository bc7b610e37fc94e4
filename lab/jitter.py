# SPDX-License-Identifier: BSD-3-Clause
"""Runs the live node in several states of the machine and writes how it kept up: a table and a figure."""
import argparse
import contextlib
import os
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
import xmlrpc.client
from collections import namedtuple

import rosgraph
import rospy
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64
from std_srvs.srv import Trigger

import lab
from lab import plt
from harmonic_joint_twin.msg import Timing

PACKAGE = "harmonic_joint_twin"
NODE = "/joint_twin"
PATIENCE = 60.0     # [s]
SETTLE_TIME = 2.0   # before counting begins [s]
COMMAND_RATE = 125.0  # [Hz]
TORQUE = 0.4        # [N.m]
PRIORITY = 80

Case = namedtuple("Case", "name hogs priority")
Result = namedtuple("Result", "case timing permitted")


def cases():
    others = sorted(os.sched_getaffinity(0))
    return [Case("quiet", [], 0), Case("a hog on one core", others[-1:], 0), Case("a hog on every core", others, 0),
            Case(f"a hog on every core, SCHED_FIFO {PRIORITY}", others, PRIORITY)]


def wait_until(condition, what):
    deadline = time.monotonic() + PATIENCE
    while not condition():
        if time.monotonic() > deadline:
            sys.exit(f"jitter: waited {PATIENCE:.0f} s in vain for {what}")
        time.sleep(0.05)


@contextlib.contextmanager
def process(command, **options):
    running = subprocess.Popen(command, stdout=subprocess.DEVNULL, **options)
    try:
        yield running
    finally:
        running.send_signal(signal.SIGINT)
        try:
            running.wait(timeout=20.0)
        except subprocess.TimeoutExpired:
            running.kill()
            running.wait()


@contextlib.contextmanager
def hogs(processors):
    """Endless loops, one bound to each of the processors."""
    with contextlib.ExitStack() as stack:
        for processor in processors:
            stack.enter_context(process([sys.executable, "-c", "while True: pass"], stderr=subprocess.DEVNULL,
                                        preexec_fn=lambda cpu=processor: os.sched_setaffinity(0, {cpu})))
        yield


@contextlib.contextmanager
def master():
    """A master of its own, on a free port."""
    with socket.socket() as probe:
        probe.bind(("localhost", 0))
        port = probe.getsockname()[1]
    os.environ["ROS_MASTER_URI"] = f"http://localhost:{port}"
    with process(["roscore", "-p", str(port)], stderr=subprocess.DEVNULL):
        wait_until(lambda: rosgraph.is_master_online(), "roscore")
        yield


class Bench:
    """Clients of the node: torque at 125 Hz, a subscriber to the joint states, the report of its timing."""

    def __init__(self):
        rospy.init_node("jitter", disable_signals=True)
        self.timing = None
        self._torque = rospy.Publisher(f"{NODE}/motor_torque_command", Float64, queue_size=10)
        rospy.Subscriber(f"{NODE}/joint_states", JointState, lambda message: None)
        rospy.Subscriber(f"{NODE}/timing", Timing, self._keep)
        threading.Thread(target=self._drive, daemon=True).start()

    def _keep(self, message):
        self.timing = message

    def _drive(self):
        while not rospy.is_shutdown():
            self._torque.publish(TORQUE)
            time.sleep(1.0 / COMMAND_RATE)

    def measure(self, case, duration):
        with tempfile.NamedTemporaryFile("w", suffix=".yaml") as overlay:
            overlay.write(f"realtime: {{priority: {case.priority}, lock_memory: {str(case.priority > 0).lower()}}}\n")
            overlay.flush()
            with process(["roslaunch", PACKAGE, "twin.launch", "joint:=base", f"params:={overlay.name}"]):
                self.timing = None
                wait_until(lambda: self.timing is not None, "the node")
                with hogs(case.hogs):
                    time.sleep(SETTLE_TIME)
                    rospy.ServiceProxy(f"{NODE}/reset", Trigger)()
                    time.sleep(duration)
                    self.timing = None
                    wait_until(lambda: self.timing is not None, "the last report")
                    return Result(case, self.timing, case.priority == 0 or has_priority())


def has_priority():
    """Whether the system runs the node's loop under SCHED_FIFO."""
    pid = node_process()
    for task in os.listdir(f"/proc/{pid}/task"):
        with open(f"/proc/{pid}/task/{task}/comm") as name:
            if name.read().strip() == "twin_loop":
                return os.sched_getscheduler(int(task)) == os.SCHED_FIFO
    return False


def node_process():
    with xmlrpc.client.ServerProxy(rosgraph.Master("/jitter").lookupNode(NODE)) as node:
        return node.getPid("/jitter")[2]


def microseconds(seconds):
    return f"{seconds * 1e6:.0f}"


def milliseconds(seconds):
    return f"{seconds * 1e3:.2f}"


def table(results):
    lines = ["| machine | wake-up jitter: median [µs] | p99 [µs] | p99.9 [µs] | largest [µs] | lateness: median [ms] "
             "| p99 [ms] | p99.9 [ms] | largest [ms] | deadlines missed | of cycles | real-time factor | load |",
             "|---" * 13 + "|"]
    for case, t, permitted in results:
        name = case.name if permitted else f"{case.name}: not permitted"
        jitter = [microseconds(x) for x in (t.wake_up_median, t.wake_up_p99, t.wake_up_p999, t.wake_up_max)]
        lateness = [milliseconds(x) for x in (t.lateness_median, t.lateness_p99, t.lateness_p999, t.lateness_max)]
        rest = [str(t.missed_deadlines), str(sum(t.lateness_count)), f"{t.real_time_factor:.4f}", f"{t.load:.2f}"]
        lines.append("| " + " | ".join([name, *jitter, *lateness, *rest]) + " |")
    return lines


def draw(results, path):
    figure, panels = plt.subplots(1, 2, figsize=(10, 4.4), sharey=True)
    titles = ("wake-up of the loop after the time it asked for", "oldest instant of a cycle after it was due")
    for panel, title, counts in zip(panels, titles, ("wake_up_count", "lateness_count")):
        for case, timing, _ in results:
            count = getattr(timing, counts)
            shares = [n / max(1, sum(count)) for n in count]
            panel.step([1e3 * end for end in timing.bin_end], shares, where="pre", label=case.name, linewidth=1.2)
        panel.set(xscale="log", yscale="log", xlim=(1e-3, 1e3), xlabel="late by [ms]", title=title)
        panel.grid(alpha=0.3)
    panels[1].axvline(1e3 * results[0].timing.deadline, color="grey", linestyle="--", label="realtime.deadline")
    panels[0].set_ylabel("share of cycles in a bin")
    figure.tight_layout(rect=(0.0, 0.08, 1.0, 1.0))
    figure.legend(*panels[1].get_legend_handles_labels(), loc="lower center", ncol=5, fontsize=8)
    figure.savefig(path, dpi=110)


def processor():
    with open("/proc/cpuinfo") as info:
        return next((line.split(":")[1].strip() for line in info if line.startswith("model name")), "unknown processor")


def section(results, options, load):
    return [*table(results), "",
            f"`lab/run jitter --duration {options.duration:g}` measured these values on {os.cpu_count()} cores of a "
            f"shared virtual machine ({processor()}, Linux {os.uname().release}). The load average before the first "
            f"case was {load:.1f}. The host of the virtual machine also runs other virtual machines, so *quiet* means "
            "only that `lab/run jitter` started no hog (a program that keeps a core busy). A thread with SCHED_FIFO "
            "precedes all other threads of the virtual machine, but not those of the host.", "",
            "![Histograms of wake-up jitter and of lateness](images/jitter.png)"]


def main():
    parser = argparse.ArgumentParser(prog="jitter", description=__doc__)
    parser.add_argument("--docs", required=True, help=argparse.SUPPRESS)
    parser.add_argument("--duration", type=float, default=30.0, help="of each case [s] (default: 30)")
    options = parser.parse_args()
    load = os.getloadavg()[0]
    results = []
    with master():
        bench = Bench()
        for case in cases():
            print(f"{case.name}: {options.duration:g} s", file=sys.stderr)
            results.append(bench.measure(case, options.duration))
        rospy.signal_shutdown("done")
    draw(results, os.path.join(options.docs, "images", "jitter.png"))
    lab.write(os.path.join(options.docs, "performance.md"), "jitter", section(results, options, load))
    print("\n".join(table(results)))


if __name__ == "__main__":
    main()
