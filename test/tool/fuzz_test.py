# SPDX-License-Identifier: BSD-3-Clause
"""Damaged recordings and descriptions: every reader answers within its time and memory, in words.

HJT_FUZZ: mutations of each kind of file (300 for a release); without it as many as a minute allows.
"""
import os
import random
import resource
import subprocess
import time

import tool
from recorded import states, swinging, write_bag, write_csv, write_db3, write_mcap

MEMORY = 4 << 30  # of a reader [byte]
SECONDS = 20.0  # for a file
MINUTE = 45.0  # for all, where HJT_FUZZ does not say how many [s]
CONFIG = os.path.join(tool.CHECKOUT, "config", "arms")
NUMBERS = (b"nan", b"-inf", b"1e300", b"-1", b"0", b"8,393", b"65536", b"", b"0x10", b"'")


def damaged(data, draw):
    """A copy with some bytes changed, a number replaced, a piece cut out, doubled or moved."""
    data = bytearray(data)
    kind = draw.randrange(5)
    at = draw.randrange(len(data))
    if kind == 0:
        for _ in range(draw.choice((1, 4, 32))):
            data[draw.randrange(len(data))] = draw.randrange(256)
    elif kind == 1:
        digits = [i for i in range(at, min(at + 2000, len(data))) if chr(data[i]).isdigit()]
        if digits:
            end = digits[0] + 1
            while end < len(data) and chr(data[end]) in "0123456789.e-":
                end += 1
            data[digits[0]:end] = draw.choice(NUMBERS)
    elif kind == 2:
        del data[at:at + draw.choice((1, 8, 1000, len(data)))]
    elif kind == 3:
        data[at:at] = data[at:at + draw.choice((8, 4096))]
    else:
        data[at:at + 8] = draw.choice((b"\xff" * 8, b"\0" * 8, b"\0\0\0\x7f\0\0\0\0"))
    return bytes(data)


class Fuzz(tool.ToolTest):
    def attempt(self, *arguments):
        try:
            return subprocess.run([self.executable, *arguments], cwd=self.directory, stdout=subprocess.PIPE,
                                  stderr=subprocess.PIPE, timeout=SECONDS * tool.SLOWER, check=False,
                                  preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY)))
        except subprocess.TimeoutExpired:
            return None

    def test_damage_is_answered_in_words(self):
        if tool.SLOWER != 1.0:
            self.skipTest("memory is the sanitizer's")
        columns = swinging(4.0)
        with open(os.path.join(CONFIG, "ur5.urdf"), "rb") as file:
            urdf = file.read()
        with open(os.path.join(CONFIG, "ur5.yaml"), encoding="utf-8") as file:
            self.write("arm.yaml", file.read())
        self.write("ur5.urdf", urdf.decode())
        tool.write_recording(self.path("in.bag"))
        kinds = [(write_csv(self.path("a.csv"), columns), ["check", "a.csv", "--arm", "ur5", "--json"]),
                 (write_bag(self.path("a.bag"), states(columns)), ["check", "a.bag", "--arm", "ur5", "--json"]),
                 (write_bag(self.path("a.bz2.bag"), states(columns), compression="bz2"), ["check", "a.bz2.bag"]),
                 (write_bag(self.path("a.lz4.bag"), states(columns), compression="lz4"), ["check", "a.lz4.bag"]),
                 (self.path("in.bag"), ["replay", "in.bag", "--out", "out.bag", "--force"]),
                 (write_db3(self.path("a.db3"), states(columns)), ["check", "a.db3", "--arm", "ur5", "--json"]),
                 (write_mcap(self.path("a.mcap"), states(columns)), ["check", "a.mcap", "--arm", "ur5", "--json"]),
                 (self.path("ur5.urdf"), ["checkup", "--arm", "arm.yaml", "--out", "motion.csv", "--force"]),
                 (self.path("arm.yaml"), ["checkup", "--arm", "arm.yaml", "--out", "motion.csv", "--force"])]
        asked = int(os.environ.get("HJT_FUZZ", "0"))
        deadline = time.monotonic() + MINUTE
        draw = random.Random(20261128)
        number = 0
        while number < asked or (asked == 0 and time.monotonic() < deadline):
            for path, command in kinds:
                with open(path, "rb") as file:
                    sound = file.read()
                with open(path, "wb") as file:
                    file.write(damaged(sound, draw))
                done = self.attempt(*command)
                if (done is None or done.returncode not in (0, 1) or b"bad_alloc" in done.stderr or
                        b"nan" in done.stdout):
                    kept = os.path.join("/tmp", f"fuzz_{number}_{os.path.basename(path)}")
                    os.replace(path, kept)
                    self.fail(f"{kept}: {'no answer' if done is None else (done.returncode, done.stderr[-500:])}")
                with open(path, "wb") as file:
                    file.write(sound)
                if asked == 0 and time.monotonic() > deadline:
                    break
            number += 1


if __name__ == "__main__":
    tool.main()
