#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs ctest in the current folder. Before the closing lines of ctest the script prints what these lines lack: each
skipped test with its reason, each test that passed only when it was repeated, and the sums of the test times by label.

Usage: run_ctest.py [OPTION OF CTEST...]
The exit code is that of ctest, or 1 if ctest passed and a test was skipped without a reason.

A test with the label `timed` depends on time and can fail on a busy machine. If it fails, it runs a second time, alone,
after all other tests.

A reason is a line `skipped: REASON` in the output of a test, or the text of Python's unittest. rosunit does not show
the output of a test with a master, so the script reads the reasons from the results in test_results/.
"""
import collections
import json
import pathlib
import re
import subprocess
import sys
import time

CLOSING = re.compile(r"\d+% tests passed")
RESULT = re.compile(r"\s*(?:\d+/\d+\s+)?Test\s+#\d+: (\S+) \.*\s*(\*\*\*[^\d\s]+|Passed).*?(\d+\.\d+) sec")
TIMED = "timed"  # label of tests that depend on time
GIVEN = re.compile(r"^skipped: *(.*)$", re.MULTILINE)
BY_UNITTEST = re.compile(r"skipped (['\"])(.*)\1$", re.MULTILINE)
# Number of skipped tests, as unittest or gtest prints it.
COUNTED = re.compile(r"^(?:OK|FAILED) \(.*\bskipped=(\d+)|^\[  SKIPPED \] (\d+) tests?,", re.MULTILINE)


def run(arguments):
    """Runs ctest and prints its output at once, except the closing lines. @returns exit code, closing lines, the
    results of each test in their order, {name: ["***Failed", "Passed"]}, and the times of the tests [s]."""
    closing, results, times = [], {}, collections.Counter()
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
                times[result.group(1)] += float(result.group(3))
    return ctest.returncode, "".join(closing), results, times


def labels():
    """Labels of every test, by its name."""
    listed = subprocess.run(["ctest", "--show-only=json-v1"], stdout=subprocess.PIPE, universal_newlines=True,
                            check=False)
    try:
        tests = json.loads(listed.stdout)["tests"]
    except (KeyError, ValueError):  # an option such as --help
        return {}
    properties = {test["name"]: {each["name"]: each["value"] for each in test.get("properties", [])} for test in tests}
    return {name: found.get("LABELS", []) for name, found in properties.items()}


def sums(times, labels_of):
    """Lines with the sums of the test times: for each label, and for all tests."""
    by_label = collections.defaultdict(list)
    for name, seconds in times.items():
        for label in labels_of.get(name, []):
            by_label[label].append(seconds)
    found = [f"{sum(each):.0f} s in {len(each)} tests: {label}" for label, each in sorted(by_label.items())]
    return found + [f"{sum(times.values()):.0f} s in {len(times)} tests: all"]


def repeat(arguments, closing, results, times, labels_of):
    """Runs again each timed test that failed. @returns the closing lines without the tests that then passed, or None if
    no test did."""
    late = [name for name, states in results.items() if states[-1] not in ("Passed", "***Skipped", "***Not")
            and TIMED in labels_of.get(name, [])]
    if not late or any(option.startswith("--repeat") for option in arguments):
        return None
    print("\nThese tests run once more, alone: " + ", ".join(late), flush=True)
    options = ["--output-on-failure"] if "--output-on-failure" in arguments else []
    chosen = "^(" + "|".join(map(re.escape, late)) + ")$"
    _, _, again, more = run([*options, "-j", "1", "-R", chosen])
    for name, states in again.items():
        results[name] += states
        times[name] += more[name]
    return without(closing, {name for name, states in again.items() if states[-1] == "Passed"})


def without(closing, passed):
    """Closing lines of ctest as if the tests `passed` had not failed; None if `passed` is empty."""
    if not passed:
        return None
    kept = [line for line in closing.splitlines() if not any(f" - {name} (" in line for name in passed)]
    failed, total = map(int, re.search(r"(\d+) tests failed out of (\d+)", closing).groups())
    failed -= len(passed)
    share = int(100.0 * (total - failed) / total) if failed else 100
    kept[0] = f"{share}% tests passed, {failed} tests failed out of {total}"
    if not failed:
        kept = [line for line in kept if "tests FAILED" not in line]
    return "\n".join(kept) + "\n"


def outputs(started):
    """Output of each test in its last run, by the name of the test."""
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
    """Reasons of skipped tests in the output of a test; an empty reason for each skipped test without one."""
    given = [reason.strip() for reason in GIVEN.findall(output)]
    given += [reason.strip() for _, reason in BY_UNITTEST.findall(output)]
    counts = [int(by_unittest or by_gtest) for by_unittest, by_gtest in COUNTED.findall(output)]
    return given + [""] * (sum(counts) - len(given))


def skipped(results, started):
    """(test, reason) of every test that was skipped completely or in part."""
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
    arguments = sys.argv[1:]
    labels_of = labels()  # must come before the tests, because ctest overwrites its log whenever it runs
    code, closing, results, times = run(arguments)
    without_test = skipped(results, started)
    cleared = repeat(arguments, closing, results, times, labels_of)
    if cleared is not None:
        closing = cleared
        code = 0 if " 0 tests failed" in closing else code
        without_test = list(dict.fromkeys(without_test + skipped(results, started)))
    repeated = [name for name, states in results.items() if states[-1] == "Passed" and len(states) > 1]
    if results:
        print()
    for name in repeated:
        print(f"passed when repeated: {name}")
    for name, reason in without_test:
        print(f"skipped: {name}: {reason or 'NO REASON GIVEN'}")
    for line in sums(times, labels_of) if results else []:
        print(line)
    print("\n" + closing, end="", flush=True)
    return code or (1 if any(not reason for _, reason in without_test) else 0)


if __name__ == "__main__":
    sys.exit(main())
