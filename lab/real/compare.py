#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Holds the twin against recordings of real robots and writes docs/real_robot.md. Started by scripts/compare_real."""
import argparse
import os
import sys
import tempfile

import two_encoders
import ur10e
import ur5
from runs import Runner


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
    lines = ["# Beside a real robot", "", "Written by `lab/run compare_real`; do not edit.", ""]
    with tempfile.TemporaryDirectory() as directory:
        runner = Runner(settings.tool, directory)
        for part in (ur5, ur10e, two_encoders):
            lines += part.section(runner, settings.telemetry, settings.docs, images)
    lines += ["## Runs", "", "The commands behind these figures: [real_robot_runs.txt](real_robot_runs.txt).", ""]
    with open(os.path.join(settings.docs, "real_robot_runs.txt"), "w", encoding="utf-8") as file:
        file.write("\n".join(["# SPDX-License-Identifier: BSD-3-Clause", *runner.commands, ""]))
    with open(os.path.join(settings.docs, "real_robot.md"), "w", encoding="utf-8") as file:
        file.write("\n".join(lines))
    return 0


if __name__ == "__main__":
    sys.exit(main())
