#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Holds the twin against recordings of real robots and writes docs/real_robot.md. Started by `lab/run compare_real`."""
import argparse
import os
import sys
import tempfile

import two_encoders
import ur10e
import ur5
from runs import Runner

sys.path.append(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
from lab import wrapped  # noqa: E402  (its folder is known now)

HEAD = """# Beside a real robot

`lab/run compare_real` writes this page.

This page shows how far the twin differs from a sound robot. If the twin differs less from your robot than from the
sound robots of this page, the difference is no sign of a fault. The page also counts the right verdicts on recordings
of sound joints and on recordings with raised friction.

The recordings come from one UR5, one UR10e and one drive of the maker NEURA, all sound. The recordings are not part of
this project. The shipped friction of the UR5 and the widths of the verdict's interval come from recordings of this
page. The friction of your arm may vary more between recordings than that of the recorded arms.

For each robot the program identifies the twins on one recording and compares the twins with the other recordings.
[real_robot_runs.txt](real_robot_runs.txt) has the commands behind the figures.
"""


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--tool", required=True)
    parser.add_argument("--docs", required=True)
    parser.add_argument("--telemetry", required=True)
    settings = parser.parse_args()
    recordings = [os.path.join(ur5.FOLDER, f"{ur5.FOLDER}_{ur5.TRAIN}.csv"), two_encoders.LOADED]
    if not any(os.path.isfile(os.path.join(settings.telemetry, name)) for name in recordings):
        print(f"skipped: neither {' nor '.join(recordings)} in {settings.telemetry}; name their folder as argument or "
              "in $HJT_TELEMETRY_DIR")
        return 0
    images = os.path.join(settings.docs, "images", "real_robot")
    os.makedirs(images, exist_ok=True)
    lines = [HEAD]
    with tempfile.TemporaryDirectory() as directory:
        runner = Runner(settings.tool, directory)
        for part in (ur5, ur10e, two_encoders):
            lines += part.section(runner, settings.telemetry, settings.docs, images)
    with open(os.path.join(settings.docs, "real_robot_runs.txt"), "w", encoding="utf-8") as file:
        file.write("\n".join(["# SPDX-License-Identifier: BSD-3-Clause", *runner.commands, ""]))
    with open(os.path.join(settings.docs, "real_robot.md"), "w", encoding="utf-8") as file:
        file.write(wrapped("\n".join(lines)))
    return 0


if __name__ == "__main__":
    sys.exit(main())
