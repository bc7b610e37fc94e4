# SPDX-License-Identifier: BSD-3-Clause
"""Shared by the tests with a master: waiting, listening, and starting nodes with a configuration. Waits are by the wall
clock and generous, conditions are polled: a busy machine makes these tests slower, not red."""
import glob
import os
import re
import signal
import socket
import subprocess
import sys
import threading
import time
import unittest
import xml.etree.ElementTree as xml
import xmlrpc.client

import roslib.message
import roslib.packages
import rosgraph
import rosparam
import rospkg
import rospy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "support"))
import processes  # noqa: E402

PACKAGE = "harmonic_joint_twin"
SLOWNESS = float(os.environ.get("HJT_PATIENCE", "1"))  # of the programs under test: sanitizers make them slow
PATIENCE = 30.0 * SLOWNESS  # [s]
# Skipped tests with their reasons: rosunit's results have no word of them. They go where the tests' own output goes.
unittest.TestResult.addSkip = lambda result, test, reason: print(f"skipped: {reason}")
LAUNCH_TIMEOUT = 4.0 * PATIENCE  # [s]
# Environment in which `--report` writes its data and no page is drawn, which takes seconds for each joint.
NO_PAGE = {"PYTHONPATH": os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "support", "no_page")}
OK, WARN, ERROR, STALE = DiagnosticStatus.OK, DiagnosticStatus.WARN, DiagnosticStatus.ERROR, DiagnosticStatus.STALE


def package_path(*parts):
    return os.path.join(rospkg.RosPack().get_path(PACKAGE), *parts)


def executable(name):
    return roslib.packages.find_node(PACKAGE, name)[0]


def wait_until(condition, what, patience=PATIENCE):
    deadline = time.monotonic() + patience
    while not condition():
        if time.monotonic() > deadline:
            raise AssertionError(f"waited {patience} s in vain: {what}")
        time.sleep(0.01)


def processor_time(node):
    """Of all threads of a node so far [s]."""
    uri = rosgraph.Master("/ros_support").lookupNode(node)
    pid = xmlrpc.client.ServerProxy(uri).getPid("/ros_support")[2]
    return processes.processor_time(pid)


class Listener:
    """Keeps every message of a topic."""

    def __init__(self, topic, message_type):
        self._lock = threading.Lock()
        self._messages = []
        self._subscriber = rospy.Subscriber(topic, message_type, self._add, tcp_nodelay=True)

    def _add(self, message):
        with self._lock:
            self._messages.append(message)

    def messages(self):
        with self._lock:
            return list(self._messages)

    def clear(self):
        with self._lock:
            self._messages.clear()

    def wait_for(self, count, patience=PATIENCE):
        wait_until(lambda: len(self.messages()) >= count, f"{count} messages on {self._subscriber.name}", patience)
        return self.messages()

    def wait_for_connection(self):
        wait_until(lambda: self._subscriber.get_num_connections() > 0, f"a publisher of {self._subscriber.name}")

    def close(self):
        self._subscriber.unregister()


def numbers_in(message):
    """Every floating-point number of a message, in its arrays and in the messages below it."""
    for slot in message.__slots__:
        value = getattr(message, slot)
        for entry in value if isinstance(value, (list, tuple)) else [value]:
            if isinstance(entry, float):
                yield entry
            elif hasattr(entry, "__slots__"):
                yield from numbers_in(entry)


def layout_curves():
    """What PlotJuggler's layout draws: by topic, without the node's name, the paths of its numbers."""
    curves = {}
    for curve in xml.parse(package_path("config", "plotjuggler.xml")).iter("curve"):
        topic, number = re.fullmatch(r"/joint_twin/(\w+)/([\w\[\]/]+)", curve.get("name")).groups()
        curves.setdefault(topic, []).append(number)
    return curves


def number_at(message, path):
    """As PlotJuggler finds it: field/field[index]."""
    for name, index in re.findall(r"(\w+)(?:\[(\d+)\])?", path):
        message = getattr(message, name)
        message = message[int(index)] if index else message
    return float(message)


def listen_to_all(node):
    """A listener for each topic that a node publishes below its name."""
    return {name[len(node) + 1:]: Listener(name, roslib.message.get_message_class(kind))
            for name, kind in rospy.get_published_topics(node)}


class Diagnostics:
    """What one node says on /diagnostics."""

    def __init__(self, node):
        self._prefix = node.lstrip("/") + ": "
        self._listener = Listener("/diagnostics", DiagnosticArray)

    def statuses(self, task):
        name = self._prefix + task
        return [status for array in self._listener.messages() for status in array.status if status.name == name]

    def values(self, task):
        """Of the latest status that holds any: the first one only says that the node is starting."""
        statuses = [status for status in self.statuses(task) if status.values]
        return {pair.key: pair.value for pair in statuses[-1].values} if statuses else {}

    def number(self, task, key):
        return float(self.values(task).get(key, "nan"))

    def level(self, task):
        statuses = self.statuses(task)
        return statuses[-1].level if statuses else None

    def wait_for(self, task, key, value):
        wait_until(lambda: self.values(task).get(key) == str(value),
                   f"{task}: {key} = {value}; latest: {self.values(task)}")

    def fresh(self, task):
        """Values of a status that came after this call."""
        count = len(self.statuses(task))
        wait_until(lambda: len(self.statuses(task)) > count, f"a status of {task}")
        return self.values(task)


def configuration_files(joint="elbow", overlays=()):
    with open(package_path("config", "stages"), encoding="utf-8") as file:
        stages = [line.strip() for line in file if not line.startswith("#")]
    names = [*stages, f"joints/{joint}.yaml", *overlays]
    return [package_path("config", name) for name in names]


def all_configuration_files():
    """Of a joint; files of arms and signatures have keys of their own."""
    files = glob.glob(package_path("config", "**", "*.yaml"), recursive=True)
    return sorted(file for file in files if os.path.basename(os.path.dirname(file)) not in ("arms", "signatures"))


def load_parameters(node, files, changes=None):
    """Loads files into a node's namespace as roslaunch does, then sets or, for None, deletes single keys."""
    if rosgraph.Master("/test").hasParam(node):
        rosparam.delete_param(node)
    for file in files:
        for parameters, namespace in rosparam.load_file(file, default_namespace=node):
            rosparam.upload_params(namespace, parameters)
    for key, value in (changes or {}).items():
        name = f"{node}/{key}"
        if value is None:
            rosparam.delete_param(name)
        else:
            rosparam.set_param_raw(name, value)


class Node:
    """A joint_twin_node in a process of its own."""

    def __init__(self, name, *remappings, prefix=(), **environment):
        command = [*prefix, executable("joint_twin_node"), f"__name:={name}", *remappings]
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                                        env=dict(os.environ, **environment))
        self._lines = []
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def _read(self):
        for line in self.process.stdout:
            self._lines.append(line)

    def output(self):
        return "".join(self._lines)

    def wait_for_exit(self, patience=PATIENCE):
        code = self.process.wait(timeout=patience)
        self._reader.join()
        return code

    def stop(self, signal_number):
        """Exit code, and how long it took [s]."""
        begin = time.monotonic()
        self.process.send_signal(signal_number)
        return self.wait_for_exit(), time.monotonic() - begin

    def kill(self):
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait()


def free_port():
    with socket.socket() as probe:
        probe.bind(("localhost", 0))
        return probe.getsockname()[1]


class Launch:
    """roslaunch with the master on `port`; with none there it starts one of its own."""

    def __init__(self, log_path, *arguments, port=None, **environment):
        port = port or free_port()
        environment = dict(os.environ, ROS_MASTER_URI=f"http://localhost:{port}", **environment)
        self.log_path = log_path
        self.master = rosgraph.Master("/test", environment["ROS_MASTER_URI"])
        with open(log_path, "w", encoding="utf-8") as log:
            self.process = subprocess.Popen(["roslaunch", "-p", str(port), PACKAGE, *arguments], stdout=log,
                                            stderr=subprocess.STDOUT, env=environment)

    def log(self):
        with open(self.log_path, encoding="utf-8") as log:
            return log.read()

    def interrupt(self):
        """As Ctrl-C does."""
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGINT)
            self.process.wait(timeout=LAUNCH_TIMEOUT)
