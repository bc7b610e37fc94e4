# SPDX-License-Identifier: BSD-3-Clause
"""The tool is found by its name after the workspace's setup.bash: by the shell and by rosrun."""
import os
import subprocess
import unittest

import tool


class Path(tool.ToolTest):
    def source_and_run(self, command):
        setup = os.path.join(os.path.dirname(self.executable), "..", "..", "setup.bash")
        environment = {name: os.environ[name] for name in ("HOME", "PATH") if name in os.environ}
        return subprocess.run(["bash", "-c", f"source '{setup}' && {command}"], stdin=subprocess.DEVNULL, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, env=environment, check=False)

    def assert_runs(self, command):
        done = self.source_and_run(command)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertEqual(done.stdout, self.succeed("--help").stdout)

    def test_shell(self):
        self.assert_runs("joint_twin --help")

    @unittest.skipIf(os.path.isdir(os.path.join(tool.CHECKOUT, "build-sanitize")), "two builds: rosrun would ask which")
    def test_rosrun(self):
        self.assert_runs("rosrun harmonic_joint_twin joint_twin --help")


if __name__ == "__main__":
    tool.main()
