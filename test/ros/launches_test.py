#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""A master stays up while launches come and go: each starts there as on a new master, whatever ran before."""
import concurrent.futures
import glob
import json
import os
import re
import subprocess
import sys
import tempfile
import time
import unittest

import rosgraph
import rostest

from ros_support import LAUNCH_TIMEOUT, PACKAGE, Launch, Node, free_port, package_path, wait_until

AT_ONCE = 3  # masters
RECORDED = 10000  # of a bag that is being written: more than its head, so the clock runs [bytes]
# What a launch file needs; the topics that its nodes publish or hear once they are up; the bag that it writes.
ARGUMENTS = {"view": ["rviz:=false"],
             "replay": ["bag:={played}", "out:={folder}/replay.bag", "force:=true", "joint:=base",
                        "connect_time:=0.5"],
             "demo": ["profile:={folder}/profile.bag", "out:={folder}/demo.bag"]}
REPLAY = {("/joint_twin", "/joint_twin/health"), ("/replay_player", "/clock"), ("/replay_recorder", "/diagnostics")}
UP = {"twin": {("/joint_twin", "/joint_twin/health")},
      "arm": {("/joint_twin", "/wrist_3/joint_twin/comparison"), ("/joint_twin", "/joint_states")},
      "arm_twin": {("/arm_twin", "/joint_states"), ("/arm_twin", "/wrist_3/arm_twin/health")},
      "view": {("/joint_twin", "/joint_twin/health"), ("/drive_markers", "/drive_markers/markers")},
      "aggregator": {("/diagnostic_aggregator", "/diagnostics_agg")}, "replay": REPLAY, "demo": REPLAY}
# Leaves a robot's description on the server, as such files do, for whoever comes next: arm_action.test launches it.
DESCRIPTION = "arm_description"
WRITTEN = {"replay": "replay.bag.active", "demo": "demo.bag.active"}
# As other arguments, or other programs of the same names, may have left it.
LEFT = {"/joint_twin/telemetry/effort": "joint_torque", "/joint_twin/diagnostic_period": 60.0,
        "/wrist_1/joint_twin/telemetry/torque_per_current": 10.7, "/drive_markers/twin_of": "old",
        "/diagnostic_aggregator/analyzers/motors": {"type": "diagnostic_aggregator/GenericAnalyzer", "path": "Motors"}}
OF_ROS = {"rosdistro", "roslaunch", "rosversion", "run_id"}
JOINTS = ("base", "shoulder", "elbow", "wrist_1", "wrist_2", "wrist_3")


def each_pair_in_a_row(names):
    """The shortest row of names in which every name follows every name, itself too, once."""
    row = []
    for i, name in enumerate(names):
        row += [name] + [each for other in names[i + 1:] for each in (name, other)]
    return row + names[:1]


def size(path):
    return os.path.getsize(path) if os.path.exists(path) else 0


def connections(master):
    """Pairs of node and topic."""
    published, subscribed, _ = master.getSystemState()
    return {(node, topic) for topic, nodes in published + subscribed for node in nodes}


def by_nodes(parameters):
    """Those of a joint by the node that it belongs to: each arm's node has its own below a joint."""
    found = {}
    for key, value in parameters.items():
        if key in JOINTS:
            found.update({f"{key}/{node}": values for node, values in value.items()})
        elif key not in OF_ROS:
            found[key] = value
    return found


class Launches(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = folder.name
        cls.played = os.path.join(folder.name, "played.bag")
        subprocess.run([package_path("scripts", "demo_profile.py"), cls.played], check=True)

    def visit(self, name, port=None):
        """Starts a launch file and ends it. What was in force: parameters on the server, gears and gains that the node
        of an arm tells, and the nodes on /clock."""
        folder = tempfile.mkdtemp(dir=self.folder)  # others run at the same time
        launch = Launch(os.path.join(folder, "launch.log"), f"{name}.launch",
                        *(argument.format(folder=folder, played=self.played) for argument in ARGUMENTS.get(name, [])),
                        port=port, ROS_LOG_DIR=os.path.join(folder, "log"))
        state = set()

        def is_up():
            self.assertIsNone(launch.process.poll(), launch.log())
            try:
                state.update(connections(launch.master))
            except OSError:  # a new master
                pass
            return UP[name] <= state and (name not in WRITTEN or size(os.path.join(folder, WRITTEN[name])) > RECORDED)

        try:
            wait_until(is_up, f"{name}.launch", LAUNCH_TIMEOUT)
            parameters = json.loads(json.dumps(launch.master.getParam("/")).replace(folder, "FOLDER"))
        finally:
            launch.interrupt()
        if port:
            wait_until(lambda: not UP[name] & connections(launch.master), f"the nodes of {name}.launch to leave")
        log = launch.log()
        self.assertNotIn("The parameter server has values from before this start", log)
        self.assertNotIn("FATAL", log)
        return (by_nodes(parameters), re.findall(r"\w+ is \w+: .* degC", log),
                {node for node, topic in state if topic == "/clock"})

    def start_master(self, port=None):
        port = port or free_port()
        self.core = core = subprocess.Popen(["rosmaster", "--core", "-p", str(port)], stdout=subprocess.DEVNULL)
        self.addCleanup(core.wait)
        self.addCleanup(core.terminate)
        master = rosgraph.Master("/test", f"http://localhost:{port}")
        wait_until(master.is_online, "the master", LAUNCH_TIMEOUT)
        return port, master

    def test_each_starts_after_each_as_on_a_new_master(self):
        files = glob.glob(package_path("launch", "*.launch"))
        names = sorted({os.path.splitext(os.path.basename(file))[0] for file in files} - {DESCRIPTION})
        row = each_pair_in_a_row(names)
        length = -(-len(row) // AT_ONCE)
        with concurrent.futures.ThreadPoolExecutor(AT_ONCE) as pool:  # most of the time each waits for its nodes
            clean = dict(zip(names, pool.map(self.visit, names)))
            # Each part begins with the last of the one before: no pair is lost.
            list(pool.map(lambda first: self.visit_in_turn(row[max(first - 1, 0):first + length], clean),
                          range(0, len(row), length)))

    def visit_in_turn(self, names, clean):
        """On one master. `clean`: what each finds on a master of its own."""
        port, master = self.start_master()
        before = "nothing"
        for name in names:
            for key, value in LEFT.items():
                master.setParam(key, value)
            expected, expected_told, expected_clock = clean[name]
            parameters, told, clock = self.visit(name, port)
            place = f"{name}.launch after {before}.launch"
            self.assertNotIn("use_sim_time", parameters, place)
            self.assertEqual({key: parameters.get(key) for key in expected}, expected, place)
            self.assertEqual(told, expected_told, place)
            self.assertEqual(clock, expected_clock, place)
            before = name

    def test_a_simulation_keeps_its_clock(self):
        port, master = self.start_master()
        master.setParam("/use_sim_time", True)
        parameters, _, clock = self.visit("twin", port)
        self.assertTrue(parameters["use_sim_time"])
        self.assertEqual(clock, {"/joint_twin"})
        self.visit("replay", port)
        self.assertTrue(master.getParam("/use_sim_time"))

    def test_a_node_stays_without_its_master_and_ends_when_another_has_come(self):
        for name, *arguments in (("joint_twin",), ("arm_twin", "_arm:=ur5", "_input/mode:=commands")):
            port, master = self.start_master()
            node = Node(name, *arguments, ROS_MASTER_URI=f"http://localhost:{port}")
            self.addCleanup(node.kill)
            wait_until(lambda m=master, n=name: (f"/{n}", "/diagnostics") in connections(m), name, LAUNCH_TIMEOUT)
            self.core.terminate()
            self.core.wait()
            time.sleep(7.0)  # longer than from one look at the master to the next
            self.assertIsNone(node.process.poll(), node.output())
            self.start_master(port)
            self.assertEqual(node.wait_for_exit(LAUNCH_TIMEOUT), 1, node.output())
            self.assertIn("The ROS master was replaced, and the new one does not know this node", node.output())


if __name__ == "__main__":
    rostest.rosrun(PACKAGE, "launches", Launches, sys.argv)
