# SPDX-License-Identifier: BSD-3-Clause
"""Import and replay of a real UR5 recording; skipped where it is not at hand.

Looked for in HJT_TELEMETRY_DIR, else in shared/telemetry beside the checkout.
"""
import os
import unittest

import numpy as np

import tool

DIRECTORY = os.environ.get("HJT_TELEMETRY_DIR", os.path.join(tool.CHECKOUT, "..", "shared", "telemetry"))
RECORDING = os.path.join(DIRECTORY, "ur5_cb", "ur5_cb_no6.csv")


@unittest.skipUnless(os.path.exists(RECORDING), f"no recording {RECORDING}; name its directory in HJT_TELEMETRY_DIR")
class Recording(tool.ToolTest):
    def test_every_joint_is_imported_whole(self):
        for joint in range(6):
            summary = self.succeed_json("import", RECORDING, "--joint", joint, "--out", f"{joint}.bag")
            self.assertEqual((summary["rows"], summary["joint"]), (10264, tool.JOINT_NAMES[joint]))

    def test_base_joint_turns_as_the_real_one(self):
        # No independent proof: the friction of config/joints was found on this very recording. It shows that signs,
        # units and stamps are right from the file to the simulated joint.
        # The first 14 s hold the whole first stroke of the base, -2.79 rad. Torques in, no feedback: what friction and
        # inertia leave open adds up twice, so the stroke need only agree to 15 %, the speed's course by correlation.
        with open(RECORDING) as file:
            lines = file.read().splitlines()[:1 + 14 * 125]
        self.write("head.csv", "\n".join(lines) + "\n")
        self.succeed("import", "head.csv", "--joint", 0, "--out", "in.bag")
        self.succeed("replay", "in.bag", "--out", "out.bag", "--config", "config/joints/base.yaml",
                     "--config", "config/recorded_load.yaml", "--set", "publish.contact_forces_rate=1")
        real = tool.series(self.path("out.bag"), "/joint_states")
        twin = tool.series(self.path("out.bag"), "/joint_twin/joint_states")
        stroke = real[-1][1].position[0] - real[0][1].position[0]
        self.assertAlmostEqual(twin[-1][1].position[1] / stroke, 1.0, delta=0.15)
        real_speed = np.array([message.velocity[0] for _, message in real])
        twin_speed = np.interp([at for at, _ in real], [at for at, _ in twin],
                               [message.velocity[1] for _, message in twin])
        self.assertGreater(np.corrcoef(real_speed, twin_speed)[0, 1], 0.95)


if __name__ == "__main__":
    tool.main()
