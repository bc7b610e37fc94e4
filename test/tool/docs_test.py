# SPDX-License-Identifier: BSD-3-Clause
"""Commands that pages print: they run, and print what the page shows below them.

In a block of code a line that begins with `$ ` is a command of a shell, the lines up to the next one are what it
prints; `...` stands for any lines. A command that ends with a pipe goes on in the next line. In a block `sh` the lines
that begin with `joint_twin` end with 0 where the files that they read are there. Each page has a folder of its own.
"""
import os
import re
import shlex
import subprocess

import tool

COMMAND = re.compile(r"^\$ (.*)$")
NUMBER = re.compile(r"^[-+]?\d+\.?\d*(?:e[-+]?\d+)?$")
TOLERANCE = 1e-4  # of a number: which vectors the processor has changes the last digits of sums
# Of statistics of windows with noise: the C library's last digits decide which count an encoder gives.
NOISY, NOISY_TOLERANCE = ["docs/indicators.md", "docs/health.md"], 0.05
ROUNDING = 1e-6  # smaller numbers are rounding of the solver, as the columns `residual`
SHOWN = ["README.md", "docs/tool.md", "docs/own_gear.md", "docs/gear_study.md", "docs/indicators.md", "docs/health.md",
         "docs/life.md"]
RUN = ["README.md", "docs/tool.md", "docs/own_gear.md", "docs/faults.md"]
BESIDE, RECORDINGS = "docs/beside_a_robot.md", "mkdir recordings && ln sound.bag later.bag recordings"
ARM, ARM_EXAMPLE = "docs/arm_twin.md", "joint_twin checkup "  # page, and how its first try without a robot begins


def blocks(page, language):
    """The blocks of code in this language, as lists of lines."""
    found, inside = [], None
    for line in page.splitlines():
        if line.startswith("```"):
            if inside is not None:
                found.append(inside)
            inside = [] if inside is None and line[3:] == language else None
        elif inside is not None:
            inside.append(line)
    return found


def transcripts(page):
    """Pairs of command and printed lines of every block that begins with a command."""
    for block in blocks(page, ""):
        if block and COMMAND.match(block[0]):
            pairs = []
            for line in block:
                command = COMMAND.match(line)
                if command:
                    pairs.append((command[1], []))
                elif pairs[-1][0].endswith("|"):
                    pairs[-1] = (f"{pairs[-1][0]} {line}", [])
                else:
                    pairs[-1][1].append(line)
            yield pairs


def same_word(shown, printed, tolerance):
    if NUMBER.match(shown) and NUMBER.match(printed):
        one, other = float(shown), float(printed)
        return abs(one - other) <= max(tolerance * abs(one), ROUNDING if abs(one) < ROUNDING else 0.0)
    return shown == printed


def same_line(shown, printed, tolerance):
    one, other = shown.split(), printed.split()
    return len(one) == len(other) and all(same_word(*words, tolerance) for words in zip(one, other))


def difference(shown, printed, tolerance=TOLERANCE):
    """First line of the page that was not printed, or of the output that the page does not show; None if alike."""
    here = iter(printed)
    skipping = False
    for line in shown:
        if line.strip() == "...":
            skipping = True
            continue
        got = next(here, None)
        while skipping and got is not None and not same_line(line, got, tolerance):
            got = next(here, None)
        if got is None or not same_line(line, got, tolerance):
            return f"the page shows\n  {line}\nprinted was\n  {got}"
        skipping = False
    rest = None if skipping else next(here, None)
    return f"printed was, and not shown:\n  {rest}" if rest is not None else None


class Pages(tool.ToolTest):
    def page(self, name):
        """The text of a page, in a new folder for what its commands write."""
        self.folder = self.path(name.replace("/", "_"))
        os.makedirs(self.folder)
        os.symlink(os.path.join(tool.CHECKOUT, "plans"), os.path.join(self.folder, "plans"))
        with open(os.path.join(tool.CHECKOUT, name), encoding="utf-8") as file:
            return file.read()

    def shell(self, script, environment=None):
        path = f"{os.path.dirname(os.path.abspath(self.executable))}:{os.environ['PATH']}"
        return subprocess.run(["bash", "-c", script], cwd=self.folder, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, universal_newlines=True, timeout=600 * tool.SLOWER,
                              env=dict(os.environ, PATH=path, **(environment or {})), check=False)

    def test_commands_print_what_the_page_shows(self):
        for name in SHOWN:
            for number, pairs in enumerate(transcripts(self.page(name))):
                mark = "=== end of a command ==="
                script = f"\necho '{mark}'\n".join(command for command, _ in pairs)
                printed = self.shell(script).stdout.split(mark + "\n")
                with self.subTest(page=name, block=number):
                    self.assertEqual(len(printed), len(pairs), printed)
                    for (command, shown), got in zip(pairs, printed):
                        problem = difference(shown, got.splitlines(), NOISY_TOLERANCE if name in NOISY else TOLERANCE)
                        self.assertIsNone(problem, f"$ {command}\n{problem}")

    def test_commands_end_well(self):
        ran = 0
        for name in RUN:
            for block in blocks(self.page(name), "sh"):
                for line in "\n".join(block).replace("\\\n", " ").splitlines():
                    if line.startswith("joint_twin ") and self.can_run(line):
                        ran += 1
                        with self.subTest(page=name, command=line):
                            done = self.shell(line)
                            self.assertEqual(done.returncode, 0, done.stdout)
        self.assertGreater(ran, 5)

    def test_the_first_try_without_a_robot_and_the_first_hour_beside_one_name_the_worn_joint_alone(self):
        """The twin's bags are the robot's; what both pages print runs once."""
        page = self.page(BESIDE)
        tries = next(block for block in blocks(self.page(ARM), "sh") if block[0].startswith(ARM_EXAMPLE))
        hour = [line for block in blocks(page, "sh") for line in block if line.startswith("joint_twin ")]
        printed = {}
        for line in [*tries, RECORDINGS, *hour]:
            command = line.split("#")[0].strip()
            if command not in printed:
                done = self.shell(command, tool.NO_PAGE)
                self.assertEqual(done.returncode, 0, f"{line}\n{done.stdout}")
                printed[command] = done.stdout
        said = {command.split(" --arm")[0]: text for command, text in printed.items()}
        self.assertRegex(said["joint_twin check sound.bag"], r"125 Hz, 0 missing, 0 gaps, .* 0 unreadable")
        self.assertRegex(said["joint_twin compare sound.bag"], r"(?m)^OK$")
        self.assertRegex(said["joint_twin compare later.bag"], r"(?m)^WARN$")
        found = re.findall(r"(?m)^(\w+): Not as in a sound joint: friction",
                           said["joint_twin compare later.bag"])
        self.assertEqual(found, ["elbow"])
        self.assertNotIn("hardly moves", said["joint_twin identify sound.bag"])
        for done in ("trend recordings", "follow sound.bag"):
            self.assertIn(f"joint_twin {done}", said)

    def can_run(self, line):
        """Whether every file is there that the command reads; words behind --out and the like are written."""
        words = shlex.split(line, comments=True)
        read = [word for before, word in zip([""] + words, words) if not before.startswith("--out")]
        folders = [self.folder, os.path.join(tool.CHECKOUT, "config")]
        return all(any(os.path.exists(os.path.join(folder, word)) for folder in folders)
                   for word in read if re.search(r"\.(bag|csv|h5|yaml)$", word))


class Comparison(tool.ToolTest):
    def test_numbers_words_and_lines_that_differ_are_found(self):
        self.assertIsNone(difference(["a 1.00000 x"], ["a   1.00001  x"]))
        self.assertIsNone(difference(["a 3.1e-08"], ["a 9.9e-09"]))
        self.assertIsNone(difference(["a", "...", "z"], ["a", "b", "c", "z"]))
        self.assertIsNone(difference(["a", "..."], ["a", "b"]))
        for shown, printed in [(["a 1.0"], ["a 1.001"]), (["a"], ["b"]), (["a"], []), (["a"], ["a", "b"]),
                               (["a 1.0"], ["a"]), (["a", "...", "y"], ["a", "b"])]:
            self.assertIsNotNone(difference(shown, printed), (shown, printed))


if __name__ == "__main__":
    tool.main()
