#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Applies one worked example of docs/extending.md to a copy of the source tree, builds it and runs its test.

Usage: extending_test.py PATCH BUILD_DIR

The lines before the first hunk of the patch hold
  Targets: what to build
  Run:     the command, found in the built package's folders of programs
  Edits:   how many edits the example may take
  Apart:   files that are not counted, such as those of a parameter that comes with the example (optional)
New files together count as one edit, every changed file as one. All examples share BUILD_DIR/.extending, so that only
the first one pays for what they have in common.
"""
import filecmp
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys

SOURCE = pathlib.Path(__file__).resolve().parents[2]
PROGRAMS = ("lib/harmonic_joint_twin", "bin", ".")


def fail(text):
    sys.exit(f"extending_test.py: {text}")


def run(command, **options):
    print("+", " ".join(map(str, command)), flush=True)
    if subprocess.run(command, **options).returncode != 0:
        fail(f"failed: {' '.join(map(str, command))}")


def header(patch):
    """The named lines before the first hunk."""
    text = re.split(r"^--- ", patch, maxsplit=1, flags=re.MULTILINE)[0]
    fields = dict(re.findall(r"^(\w+): +(.*)$", text, flags=re.MULTILINE))
    missing = {"Targets", "Run", "Edits"} - set(fields)
    if missing:
        fail(f"the patch names no {', '.join(sorted(missing))}")
    return fields


def edited(patch, apart):
    """Edits that the patch takes, as text: its new files together, and each file it changes."""
    pairs = re.findall(r"^--- (\S+).*\n\+\+\+ (\S+)", patch, flags=re.MULTILINE)
    new = [target[2:] for source, target in pairs if source == "/dev/null"]
    changed = [target[2:] for source, target in pairs if source != "/dev/null"]
    edits = ["new: " + ", ".join(new)] if new else []
    return edits + [name for name in changed if name not in apart]


def files_of(folder):
    """All but what is hidden and what has been built."""
    names = set()
    for path in folder.iterdir():
        if path.name.startswith(".") or (path / "CMakeCache.txt").exists():
            continue
        found = path.rglob("*") if path.is_dir() else [path]
        names |= {file.relative_to(folder) for file in found if file.is_file() and "__pycache__" not in file.parts}
    return names


def synchronise(copy):
    """Makes `copy` equal to the source tree; files that are equal keep their time, so that nothing is built in vain."""
    wanted = files_of(SOURCE)
    for name in files_of(copy) - wanted if copy.exists() else ():
        (copy / name).unlink()
    for name in wanted:
        target = copy / name
        if not target.exists() or not filecmp.cmp(SOURCE / name, target, shallow=False):
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(SOURCE / name, target)


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    path = pathlib.Path(sys.argv[1])
    patch = path.read_text(encoding="utf-8")
    fields = header(patch)
    edits = edited(patch, fields.get("Apart", "").split())
    print(f"{path.stem}: {len(edits)} edits, allowed {fields['Edits']}")
    print("".join(f"  {edit}\n" for edit in edits), end="")
    if len(edits) > int(fields["Edits"]):
        fail("more edits than the example may take")

    # Hidden: roslaunch looks for launch files in all other folders of a package.
    folder = pathlib.Path(sys.argv[2]).resolve() / ".extending"
    copy, build = folder / "source", folder / "build"
    synchronise(copy)
    run(["patch", "-p1", "--forward", "--no-backup-if-mismatch", "-i", path.resolve()], cwd=copy)
    # Quick to build rather than to run; with the assertions.
    run(["cmake", "-S", copy, "-B", build, "-DCMAKE_BUILD_TYPE=Debug", "-DCMAKE_CXX_FLAGS_DEBUG=-O0",
         f"-DCATKIN_DEVEL_PREFIX={build}/devel", "-DPYTHON_EXECUTABLE=/usr/bin/python3"], stdout=subprocess.DEVNULL)
    run(["cmake", "--build", build, "-j", os.environ.get("HJT_JOBS", str(os.cpu_count())), "--target",
         *fields["Targets"].split()])
    command = shlex.split(fields["Run"])
    programs = [build / "devel" / place / command[0] for place in PROGRAMS] + [build / command[0]]
    program = next((each for each in programs if each.exists()), None)
    if program is None:
        fail(f"no program {command[0]} was built")
    result = subprocess.run([program, *command[1:]], cwd=copy, capture_output=True, text=True)
    print(result.stdout + result.stderr)
    if result.returncode != 0:
        fail(f"{fields['Run']}: ended with {result.returncode}")
    if "Running 0 tests" in result.stdout:
        fail(f"{fields['Run']}: no test ran")


if __name__ == "__main__":
    main()
