#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""The drive drawn from a running twin, and its diagnostics sorted by the aggregator."""
import math
import sys
import unittest

import dynamic_reconfigure.client
import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray
from std_msgs.msg import Float64
from visualization_msgs.msg import Marker, MarkerArray

from ros_support import PACKAGE, STALE, Listener, wait_until

TORQUE = 0.9  # of the motor [N.m]: loads the flanks while the arm is sped up


class View(unittest.TestCase):
    def drawing(self):
        """The latest one."""
        return {(marker.ns, marker.id): marker for marker in self.markers.messages()[-1].markers}

    def setUp(self):
        self.markers = Listener("/base/drive_markers/markers", MarkerArray)
        self.markers.wait_for(1)

    def test_the_whole_drive_is_drawn(self):
        drawing = self.drawing()
        for part in ("flexspline", "circular_spline", "wave_generator"):
            marker = drawing[part, 0]
            self.assertEqual(marker.header.frame_id, "base_link", part)
            self.assertEqual(marker.action, Marker.ADD, part)
            radii = [math.hypot(point.x, point.y) for point in marker.points]
            self.assertGreater(min(radii), 0.015, part)
            self.assertLess(max(radii), 0.050, part)
        self.assertEqual(len(drawing["circular_spline", 0].points), 202 * 24)
        self.assertEqual(len(drawing["flexspline", 0].colors), 200 * 24)

    def test_the_exaggeration_changes_meanwhile(self):
        def depth():
            """Of the flexspline, between its nearest and its farthest point from the axis [m]."""
            radii = [math.hypot(point.x, point.y) for point in self.drawing()["flexspline", 0].points]
            return max(radii) - min(radii)

        before = depth()
        client = dynamic_reconfigure.client.Client("/base/drive_markers", timeout=10.0)
        client.update_configuration({"exaggeration": 2.0})
        wait_until(lambda: depth() < 0.7 * before, "teeth drawn half as deep")
        client.update_configuration({"exaggeration": 4.0})
        wait_until(lambda: abs(depth() - before) < 0.05 * before, "teeth drawn as before")

    def test_what_is_no_number_is_refused(self):
        client = dynamic_reconfigure.client.Client("/base/drive_markers", timeout=10.0)
        before = client.get_configuration(timeout=10.0)
        for name in ("exaggeration", "arrow_length", "full_force"):
            found = client.update_configuration({name: float("nan")})
            self.assertEqual(found[name], before[name], name)
        seen = len(self.markers.messages())
        wait_until(lambda: len(self.markers.messages()) > seen + 1, "another drawing")
        for marker in self.drawing().values():
            self.assertTrue(all(math.isfinite(value) for point in marker.points for value in (point.x, point.y)),
                            marker.ns)

    def test_arrows_and_colours_tell_the_load(self):
        command = rospy.Publisher("/base/joint_twin/motor_torque_command", Float64, queue_size=10)
        wait_until(lambda: command.get_num_connections() > 0, "the twin to listen")

        loaded = []

        def loaded_alone(sign, flank, other):
            command.publish(sign * TORQUE)
            drawing = self.drawing()
            redness = max(color.r - color.b for color in drawing["flexspline", 0].colors)
            if drawing[flank, 0].points and not drawing[other, 0].points and redness > 0.05:
                loaded.append(drawing)
            return bool(loaded)

        for sign, flank, other in ((1, "trailing_flank_force", "leading_flank_force"),
                                   (-1, "leading_flank_force", "trailing_flank_force")):
            loaded.clear()
            wait_until(lambda sign=sign, flank=flank, other=other: loaded_alone(sign, flank, other),
                       f"arrows on the {flank} alone, its teeth red")
            self.assertEqual(loaded[-1][other, 0].action, Marker.DELETE)
            self.assertIn("teeth loaded", loaded[-1]["loads", 0].text)

    def test_the_aggregator_sorts_the_diagnostics(self):
        aggregated = Listener("/diagnostics_agg", DiagnosticArray)

        def parts():
            messages = aggregated.messages()
            return {status.name: status for status in messages[-1].status} if messages else {}

        for part in ("Drive", "Input", "Timing", "Health"):
            name = f"/Harmonic drives/{part}/base joint_twin: {part}"
            wait_until(lambda name=name: name in parts(), name)
        wait_until(lambda: parts()["/Harmonic drives/Timing"].level != STALE, "the timing to be judged")


if __name__ == "__main__":
    rospy.init_node("view_test")
    rostest.rosrun(PACKAGE, "view", View, sys.argv)
