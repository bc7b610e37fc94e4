#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Applies the worked examples of docs/extending.md to a copy of the source tree, builds them and runs their tests.

Usage: extending_test.py BUILD_DIR [PATCH...]        all patches beside this file if none is named

The patches are applied one after the other to the same copy: they share one build in BUILD_DIR/.extending. The lines
before the first hunk of a patch hold
  Targets: what to build
  Run:     the command, found in the built package's folders of programs
  Edits:   how many edits the example may take
  Apart:   files that are not counted, such as those of a parameter that comes with the example (optional)
New files together count as one edit, every changed file as one.
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


def count_edits(path, patch, fields):
    edits = edited(patch, fields.get("Apart", "").split())
    print(f"{path.stem}: {len(edits)} edits, allowed {fields['Edits']}")
    print("".join(f"  {edit}\n" for edit in edits), end="")
    if len(edits) > int(fields["Edits"]):
        fail("more edits than the example may take")


def run_example(build, copy, text):
    """Runs the command of an example; fails if no test ran."""
    command = shlex.split(text)
    programs = [build / "devel" / place / command[0] for place in PROGRAMS] + [build / command[0]]
    program = next((each for each in programs if each.exists()), None)
    if program is None:
        fail(f"no program {command[0]} was built")
    # A workspace that is sourced would bring its own libraries.
    libraries = os.pathsep.join([str(build / "devel/lib"), os.environ.get("LD_LIBRARY_PATH", "")])
    result = subprocess.run([program, *command[1:]], cwd=copy, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                            universal_newlines=True, env={**os.environ, "LD_LIBRARY_PATH": libraries})
    print(result.stdout)
    if result.returncode != 0:
        fail(f"{text}: ended with {result.returncode}")
    if "Running 0 tests" in result.stdout:
        fail(f"{text}: no test ran")


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    all_patches = sorted(pathlib.Path(__file__).resolve().parent.glob("*.patch"))
    paths = [pathlib.Path(name).resolve() for name in sys.argv[2:]] or all_patches
    # Hidden: roslaunch looks for launch files in all other folders of a package.
    folder = pathlib.Path(sys.argv[1]).resolve() / ".extending"
    copy, build = folder / "source", folder / "build"
    synchronise(copy)
    examples = []
    for path in paths:
        patch = path.read_text(encoding="utf-8")
        examples.append(header(patch))
        count_edits(path, patch, examples[-1])
        run(["patch", "-p1", "--forward", "--no-backup-if-mismatch", "-i", path], cwd=copy)
    # Quick to build, once and as a whole, rather than to run; with the assertions.
    run(["cmake", "-S", copy, "-B", build, "-DCMAKE_BUILD_TYPE=Debug", "-DCMAKE_CXX_FLAGS_DEBUG=-O0",
         "-DCMAKE_UNITY_BUILD_BATCH_SIZE=40",
         "-Dharmonic_joint_twin_COMPLETE_TOOL=OFF", f"-DCATKIN_DEVEL_PREFIX={build}/devel",
         "-DPYTHON_EXECUTABLE=/usr/bin/python3"], stdout=subprocess.DEVNULL)
    targets = dict.fromkeys(target for fields in examples for target in fields["Targets"].split())
    run(["cmake", "--build", build, "-j", os.environ.get("HJT_JOBS", str(os.cpu_count())), "--target", *targets])
    for fields in examples:
        run_example(build, copy, fields["Run"])


if __name__ == "__main__":
    main()
