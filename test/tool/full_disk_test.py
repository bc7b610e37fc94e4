# SPDX-License-Identifier: BSD-3-Clause
"""A disk that takes no more: the tool says so, ends with 1, and what it wrote can be read."""
import os
import shutil

import rosbag

import tool

LIMIT = 2000000  # of a file [byte]
PLAN = """
name: test
seed: 7
duration: 3.0
repeats: 1
duty:
  - name: turning
    torque: {constant: 0.3}
record:
"""
GROUPS = """  format: hdf5
  start: 0.0
  deflate: 0
  groups:
    signals: {rate: 500.0, type: float64, columns: [mesh_force, joint_torque]}
"""


class FullDisk(tool.ToolTest):
    def fail_at_limit(self, *arguments):
        done = self.run_with_file_limit(LIMIT, *arguments)
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertEqual(done.stdout, "")
        return done.stderr

    def check_active(self, name, text):
        """The unfinished bag: reported, readable once it is indexed, and without its last chunk alone."""
        self.assertFalse(os.path.exists(self.path(name)))
        self.assertIn(f"{name} cannot be written", text)
        self.assertIn(f"{name}.active has {LIMIT} bytes of ", text)
        self.assertIn("rosbag reindex", text)
        with rosbag.Bag(self.path(name + ".active"), "a", allow_unindexed=True) as bag:
            for _ in bag.reindex():
                pass
        reported = int(text.split(" bytes of ")[1].split()[0])
        self.assertGreater(len(tool.raw_messages(self.path(name + ".active"))), 0.3 * reported)

    def test_a_simulation_keeps_what_was_recorded(self):
        text = self.fail_at_limit("simulate", "--torque", 0.2, "--duration", 3, "--out", "out.bag")
        self.check_active("out.bag", text)
        text = self.fail_at_limit("simulate", "--torque", 0.2, "--duration", 10, "--out", "out.csv")
        self.assertIn("out.csv cannot be written", text)

    def test_a_replay_keeps_what_was_recorded(self):
        tool.write_recording(self.path("in.bag"), duration=3.0)
        self.check_active("out.bag", self.fail_at_limit("replay", "in.bag", "--out", "out.bag"))

    def test_an_import_keeps_what_was_recorded(self):
        self.write("in.csv", "\n".join(tool.telemetry_csv(rows=20000)) + "\n")
        self.check_active("out.bag", self.fail_at_limit("import", "in.csv", "--joint", "2", "--out", "out.bag"))

    def test_a_sweep_leaves_no_half_run(self):
        for name, record in [("hdf5", GROUPS), ("bag", "  format: bag\n")]:
            with self.subTest(name):
                self.write("plan.yaml", PLAN + record)
                text = self.fail_at_limit("sweep", "plan.yaml", "--out", name)
                self.assertIn("run_000000000", text)
                self.assertIn("cannot be written", text)
                self.assertEqual(os.listdir(self.path(name + "/runs")), [])
                self.succeed("sweep", "plan.yaml", "--out", name)  # with space again it goes on
                shutil.rmtree(self.path(name))


if __name__ == "__main__":
    tool.main()
