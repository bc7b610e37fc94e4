# SPDX-License-Identifier: BSD-3-Clause
"""What the lint checks share: the package's files, and how a check is run from the command line."""
import os
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))

# Not part of the package: history, results and caches (as in .gitignore).
SKIPPED = 77  # exit code of a check that cannot be made here
SKIPPED_FOLDERS = {".git", "build", "devel", "install", "out", "__pycache__", ".vscode"}
SKIPPED_SUFFIXES = (".bag", ".active", ".pyc")


def files(root, folder="", suffixes=None):
    """Paths relative to `root` of the files below `folder`, sorted."""
    found = []
    for path, folders, names in os.walk(os.path.join(root, folder)):
        if "CMakeCache.txt" in names:  # a build folder of another name
            folders[:] = []
            continue
        folders[:] = sorted(name for name in folders if name not in SKIPPED_FOLDERS)
        for name in sorted(names):
            if not name.endswith(SKIPPED_SUFFIXES) and (suffixes is None or name.endswith(tuple(suffixes))):
                found.append(os.path.relpath(os.path.join(path, name), root))
    return found


def text(root, path):
    with open(os.path.join(root, path), encoding="utf-8") as file:
        return file.read()


def lines(root, path):
    """Pairs of line number, from 1, and line."""
    return list(enumerate(text(root, path).splitlines(), start=1))


def skip(reason):
    """Ends a check that cannot be made here; ctest knows the exit code."""
    print(f"skipped: {reason}")
    sys.exit(SKIPPED)


def run(check, root=ROOT):
    """Prints what `check(root)` finds, a list of 'path:line: what'; exit code 1 if that is anything."""
    problems = check(root)
    for problem in problems:
        print(problem)
    print(f"{os.path.basename(sys.argv[0])}: {len(problems)} problems")
    sys.exit(1 if problems else 0)
