#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs ctest in the current folder and names what its closing lines do not: every skipped test with its reason, and
every test that passed only when it was repeated. The names stand just before ctest's closing lines.

Usage: run_ctest.py [OPTION OF CTEST...]
Ends with ctest's exit code; with 1 if ctest passed and a test was skipped without a reason.

A reason is a line `skipped: REASON` in the test's output, or the words of Python's unittest. rosunit does not show the
output of a test with a master: its reasons are read from the results in test_results/.
"""
import pathlib
import re
import subprocess
import sys
import time

CLOSING = re.compile(r"\d+% tests passed")
RESULT = re.compile(r"\s*(?:\d+/\d+\s+)?Test\s+#\d+: (\S+) \.*\s*(\*\*\*\S+|Passed)")
GIVEN = re.compile(r"^skipped: *(.*)$", re.MULTILINE)
BY_UNITTEST = re.compile(r"skipped (['\"])(.*)\1$", re.MULTILINE)
# A runner's own count of the tests that it skipped.
COUNTED = re.compile(r"^(?:OK|FAILED) \(.*\bskipped=(\d+)|^\[  SKIPPED \] (\d+) tests?,", re.MULTILINE)


def run(arguments):
    """Runs ctest and prints its output as it comes, but the closing lines. @returns exit code, the closing lines, and
    the results of each test in their order: {name: ["***Failed", "Passed"]}."""
    closing, results = [], {}
    command = ["ctest", *arguments]
    with subprocess.Popen(command, stdout=subprocess.PIPE, universal_newlines=True, errors="replace") as ctest:
        for line in ctest.stdout:
            if closing or CLOSING.match(line):
                closing.append(line)
                continue
            print(line, end="", flush=True)
            result = RESULT.match(line)
            if result:
                results.setdefault(result.group(1), []).append(result.group(2))
    return ctest.returncode, "".join(closing), results


def outputs(started):
    """What each test wrote in its last run, by name."""
    log = pathlib.Path("Testing/Temporary/LastTest.log")
    if not log.exists():
        return {}
    text = log.read_text(encoding="utf-8", errors="replace")
    sections = re.split(r"^\d+/\d+ Testing: (.*)$", text, flags=re.MULTILINE)
    found = dict(zip(sections[1::2], sections[2::2]))
    for path in pathlib.Path("test_results").rglob("rosunit-*.xml"):
        if path.stat().st_mtime >= started:
            found[path.stem] = path.read_text(encoding="utf-8", errors="replace")
    return found


def reasons(output):
    """Reasons for skipping in a test's output; an empty one for each skipped test that has none."""
    given = [reason.strip() for reason in GIVEN.findall(output)]
    given += [reason.strip() for _, reason in BY_UNITTEST.findall(output)]
    counts = [int(by_unittest or by_gtest) for by_unittest, by_gtest in COUNTED.findall(output)]
    return given + [""] * (sum(counts) - len(given))


def skipped(results, started):
    """(test, reason) of every test that was skipped, whole or in part."""
    found = []
    for name, output in outputs(started).items():
        given = reasons(output)
        if not given and results.get(name, [""])[-1] == "***Skipped":
            given = [""]
        found += [(name, reason) for reason in dict.fromkeys(given)]
    return found


def main():
    if sys.argv[1:] in (["-h"], ["--help"]):
        print(__doc__)
        return 0
    started = time.time()
    code, closing, results = run(sys.argv[1:])
    repeated = [name for name, states in results.items() if states[-1] == "Passed" and len(states) > 1]
    without_test = skipped(results, started)
    if repeated or without_test:
        print()
    for name in repeated:
        print(f"passed when repeated: {name}")
    for name, reason in without_test:
        print(f"skipped: {name}: {reason or 'NO REASON GIVEN'}")
    print("\n" + closing, end="", flush=True)
    return code or (1 if any(not reason for _, reason in without_test) else 0)


if __name__ == "__main__":
    sys.exit(main())
