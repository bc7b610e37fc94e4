#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""The tables of topics and services in docs/node.md list exactly what a running node offers, with their types."""
import os
import sys
import unittest

import rosgraph
import rosservice
import rostest
import rospy

sys.path.insert(0, os.path.dirname(os.path.realpath(__file__)))
import doc_tables  # noqa: E402  (it lies beside this file, wherever that was started from)
import project  # noqa: E402

NODE = "/joint_twin"
# Every node of roscpp has these.
OF_ROS = {"/rosout", "/clock", f"{NODE}/get_loggers", f"{NODE}/set_logger_level"}
TIMEOUT = 30.0  # for the node to come up [s]


class NodeInterface(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.wait_for_service(f"{NODE}/brake", TIMEOUT)
        master = rosgraph.Master("/node_interface")
        cls.published, cls.subscribed, cls.services = ({name for name, nodes in group if NODE in nodes} - OF_ROS
                                                       for group in master.getSystemState())
        cls.types = dict(master.getTopicTypes())
        cls.page = project.text(project.ROOT, "docs/node.md")

    def table(self, title):
        return {name.replace("~", f"{NODE}/"): kind for name, kind
                in doc_tables.names_and_types(self.page, title).items()}

    def test_subscribed_topics(self):
        self.assertEqual(self.table("Subscribed topics"), {name: self.types[name] for name in self.subscribed})

    def test_published_topics(self):
        self.assertEqual(self.table("Published topics"), {name: self.types[name] for name in self.published})

    def test_services(self):
        self.assertEqual(self.table("Services"), {name: rosservice.get_service_type(name) for name in self.services})


if __name__ == "__main__":
    rospy.init_node("node_interface")
    rostest.rosrun("harmonic_joint_twin", "node_interface", NodeInterface)
