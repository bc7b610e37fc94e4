# SPDX-License-Identifier: BSD-3-Clause
"""Names and likely faults by clang-tidy (.clang-tidy) in every source of src/ that the build compiles.

usage: clang_tidy.py BUILD_FOLDER
"""
import concurrent.futures
import json
import os
import subprocess
import sys

import project


def sources(build, root):
    with open(os.path.join(build, "compile_commands.json"), encoding="utf-8") as file:
        compiled = {os.path.normpath(os.path.join(entry["directory"], entry["file"])) for entry in json.load(file)}
    folder = os.path.join(root, "src") + os.sep
    return sorted(path for path in compiled if path.startswith(folder))


def findings(build, path):
    """Pair of the exit code and what clang-tidy said of one file."""
    result = subprocess.run(["clang-tidy", "--quiet", "-p", build, path], stdout=subprocess.PIPE,
                            stderr=subprocess.PIPE, universal_newlines=True, check=False)
    said = result.stdout if result.stdout.strip() or not result.returncode else result.stderr
    return result.returncode, said.strip()


def check(build, root=project.ROOT):
    paths = sources(build, root)
    problems = [] if paths else ["src: no compiled sources found"]
    with concurrent.futures.ThreadPoolExecutor(max_workers=os.cpu_count()) as pool:
        for path, (code, said) in zip(paths, pool.map(lambda one: findings(build, one), paths)):
            print(f"{os.path.relpath(path, root)}: {'ok' if not code else 'FAULTS'}", flush=True)
            if code:
                problems.append(said)
    return problems


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    project.run(lambda root: check(sys.argv[1], root))
