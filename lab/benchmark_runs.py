# SPDX-License-Identifier: BSD-3-Clause
"""Runs of the benchmark: asked of its program, kept in files."""
import json
import os
import re
import subprocess
import sys
import tempfile
import threading
import time


class Progress:
    """Prints the messages of the problems on stderr, with the part done and the time left."""

    def __init__(self, problems):
        self.start = time.monotonic()
        self.done = {problem: 0.0 for problem in problems}
        self.lock = threading.Lock()

    def tell(self, problem, line):
        # A third for the references, a third for the first run, in which hopeless ones are found out, a third for the
        # others.
        counted = re.search(r"(?:: |run )(\d+) of (\d+)", line)
        with self.lock:
            if counted:
                part = (int(counted[1]) - 1) / int(counted[2])
                self.done[problem] = max(self.done[problem], (2.0 if ": run " in line else 1.0) / 3.0 + part / 3.0)
            whole = sum(self.done.values()) / len(self.done)
            spent = time.monotonic() - self.start
            left = f"{spent * (1.0 / whole - 1.0) / 60.0:.0f} min left" if whole > 0.05 else "time left not known yet"
            print(f"[{100.0 * whole:3.0f} %, {left}] {line}", file=sys.stderr, flush=True)

    def finish(self, problem):
        with self.lock:
            self.done[problem] = 1.0


def ask(tool, problem, *arguments, progress):
    """Runs the tool, its progress passed on, and gives its JSON lines."""
    environment = dict(os.environ, OPENBLAS_NUM_THREADS="1", OMP_NUM_THREADS="1")
    with tempfile.TemporaryFile("w+", encoding="utf-8") as out:
        with subprocess.Popen([tool, problem, *arguments], stdout=out, stderr=subprocess.PIPE, text=True,
                              env=environment) as process:
            for line in process.stderr:
                progress.tell(problem, line.rstrip())
        if process.returncode:
            raise RuntimeError(f"work_precision {problem} {' '.join(arguments)}: exit code {process.returncode}")
        out.seek(0)
        return [json.loads(line) for line in out]


def cached(file, reuse, newer_than, make):
    """JSON lines of a file, renewed if something they depend on is younger."""
    fresh = os.path.exists(file) and (reuse or os.path.getmtime(file) > newer_than)
    if not fresh:
        lines = make()
        with open(file, "w", encoding="utf-8") as out:
            out.writelines(json.dumps(line) + "\n" for line in lines)
    with open(file, encoding="utf-8") as source:
        return [json.loads(line) for line in source]


def measure(problem, options, progress):
    """The reference and the rows of a problem."""
    built = os.path.getmtime(options.tool)
    file = os.path.join(options.work, problem + ".ref")
    reference = cached(os.path.join(options.work, problem + ".reference.jsonl"), options.reuse, built,
                       lambda: ask(options.tool, problem, "--reference", file, "--make-reference",
                                   progress=progress))[0]
    rows = cached(os.path.join(options.work, problem + ".jsonl"), options.reuse, float("inf"),
                  lambda: ask(options.tool, problem, "--reference", file, "--runs", str(options.runs),
                              "--limit", str(options.limit), progress=progress))
    progress.finish(problem)
    return reference, rows
