# SPDX-License-Identifier: BSD-3-Clause
"""Every Python file by flake8, with the rules of setup.cfg; the executables without a suffix are shell scripts."""
import os
import subprocess
import sys

import project


def check(root):
    paths = project.files(root, suffixes=[".py"])
    if not paths:
        return ["no Python files found"]
    result = subprocess.run([sys.executable, "-m", "flake8", "--config", os.path.join(project.ROOT, "setup.cfg"),
                             *paths],
                            cwd=root, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True,
                            check=False)
    return result.stdout.splitlines()


if __name__ == "__main__":
    project.run(check)
