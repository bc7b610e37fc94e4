#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Instructions that the steps of the twin take in a short run, counted by callgrind, against instructions.json.

Usage: instruction_count.py BENCHMARK COMPILER [--renew]
Fails if they are a tenth more than the figure. Times are noise on a shared machine; instructions are not. The figure
holds for the compiler named in it, a Release build and a processor with AVX2: elsewhere, and without valgrind, the test
is skipped. --renew stores the figure of this build.
"""
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

FIGURE = pathlib.Path(__file__).with_name("instructions.json")
ALLOWED = 1.10
SKIPPED = 77
STEP = "hjt::Twin::step(long)"


def skip(reason):
    print(f"skipped: {reason}")
    sys.exit(SKIPPED)


def has_avx2():
    try:
        flags = set(pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8").split())
    except OSError:
        return False
    return "avx2" in flags


def count(benchmark):
    """Instructions in all steps of a short run of every scene."""
    with tempfile.TemporaryDirectory() as folder:
        profile = pathlib.Path(folder) / "callgrind.out"
        command = ["valgrind", "--tool=callgrind", f"--toggle-collect={STEP}", f"--callgrind-out-file={profile}",
                   benchmark, "--duration", "0.01", "--watch", "teeth"]
        run = subprocess.run(command, capture_output=True, text=True)
        if run.returncode != 0:
            sys.exit(f"{' '.join(command)} failed:\n{run.stdout}{run.stderr}")
        text = profile.read_text(encoding="utf-8")
    instructions = int(re.search(r"^(?:summary|totals): (\d+)", text, re.MULTILINE).group(1))
    if instructions == 0:
        sys.exit(f"callgrind has not seen {STEP}")
    return instructions


def main():
    benchmark, compiler = sys.argv[1:3]
    renew = "--renew" in sys.argv[3:]
    figure = json.loads(FIGURE.read_text(encoding="utf-8")) if FIGURE.exists() else {}
    if shutil.which("valgrind") is None:
        skip("no valgrind here")
    if not has_avx2():
        skip("the figure is for processors with AVX2")
    if not renew and figure.get("compiler") != compiler:
        skip(f"the figure is for {figure.get('compiler')}, this build is {compiler}")
    found = count(benchmark)
    if renew:
        figure = {"compiler": compiler, "instructions": found}
        FIGURE.write_text(json.dumps(figure, indent=2) + "\n", encoding="utf-8")
    allowed = ALLOWED * figure["instructions"]
    print(f"{found} instructions; stored {figure['instructions']}, allowed {allowed:.0f}")
    return 1 if found > allowed else 0


if __name__ == "__main__":
    sys.exit(main())
