# SPDX-License-Identifier: BSD-3-Clause
"""The counts that forecasts of life use are those of docs/health.md."""
import os
import sys

import project

sys.path.append(os.path.join(project.ROOT, "lab"))
import assessment_counts as script  # noqa: E402  (its folder is known now)


def check(root):
    texts = [project.text(root, file) for file in (script.PAGE, script.TABLE)]
    if project.text(root, script.HEADER) == script.header(*texts):
        return []
    return [f"{script.HEADER}: not what {script.PAGE} says; run lab/run assessment_counts"]


if __name__ == "__main__":
    project.run(check)
