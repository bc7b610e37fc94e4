# SPDX-License-Identifier: BSD-3-Clause
"""The page of the validation: sections that run the tool, judge what comes out, and say it in words, tables and
figures."""
import json
import os
import subprocess
import sys
from dataclasses import dataclass, field

sys.path.append(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
from bounds import number  # noqa: E402  (the folder of lab is known now)
from lab import BLUE, GREEN, GREY, ORANGE, PURPLE, RED, STYLE, plt  # noqa: E402, F401  (colours: of the sections)
from evidence import Evidence  # noqa: E402


class ToolError(RuntimeError):
    """The tool was run and failed."""


@dataclass
class Row:
    """One judged quantity."""
    name: str
    quantity: str
    source: str
    bound: object
    value: float
    unit: str
    reason: str
    evidence: Evidence
    known: str = ""  # why it does not hold; empty if it should

    @property
    def holds(self):
        return self.bound.holds(self.value)

    @property
    def fails(self):
        return not self.holds and not self.known

    @property
    def verdict(self):
        return "holds" if self.holds else "*does not hold*" if self.known else "**fails**"


@dataclass
class Settings:
    """What one validation is run with."""
    tool: str
    out: str  # folder of the page
    work: str  # folder for what the runs write
    telemetry: str  # folder of the recordings of real drives
    fast: bool = False  # only what takes a few seconds; no figures
    arguments: tuple = ()  # given to every run of the tool after its own, e.g. a deliberately wrong parameter

    page: str = "validation"  # its name, and that of its folder of figures

    @property
    def images(self):
        return os.path.join(self.out, "images", self.page)


@dataclass
class Page:
    """One section of the page while it is being built."""
    section: str
    settings: Settings
    rows: list = field(default_factory=list)
    lines: list = field(default_factory=list)
    commands: list = field(default_factory=list)
    pending: list = field(default_factory=list)  # rows not yet in a table
    values: list = field(default_factory=list)  # name, value, unit of what is shown and not judged
    results: dict = field(default_factory=dict)

    @property
    def fast(self):
        return self.settings.fast

    def tool(self, *arguments, unfinished=False):
        """Runs `joint_twin ARGUMENTS --json` and gives the parsed document. The same call is run once. `unfinished`:
        a document is taken of a run that gave up, too."""
        return json.loads(self.run(*arguments, "--json", unfinished=unfinished))

    def run(self, *arguments, unfinished=False):
        """Runs `joint_twin ARGUMENTS` and gives what it printed. The same call is run once."""
        command = tuple(str(argument) for argument in arguments)
        if command not in self.results:
            line = [self.settings.tool, *command, *self.settings.arguments]
            done = subprocess.run(line, capture_output=True, text=True, cwd=self.settings.work, check=False)
            if done.returncode and not (unfinished and done.stdout):
                raise ToolError(f"joint_twin {' '.join(line[1:])}: exit code {done.returncode}\n{done.stderr.strip()}")
            # As a reader would call it, in a folder of his own.
            self.commands.append(" ".join(["joint_twin", *line[1:]]).replace(str(self.settings.work), "$PWD"))
            self.results[command] = done.stdout
        return self.results[command]

    def scratch(self, name):
        """Path for a file that a run writes or reads; relative, as the runs see it, is `name` itself."""
        return os.path.join(self.settings.work, name)

    def heading(self, text):
        self._flush()
        self.lines += [f"### {text}", ""]

    def text(self, markdown):
        self._flush()
        self.lines += [markdown.strip(), ""]

    def table(self, header, rows):
        """A table that shows and does not judge."""
        self._flush()
        self.lines += markdown_table(header, rows) + [""]

    def check(self, name, quantity, source, bound, value, unit, reason, known="", *, evidence):
        """One judged quantity. `bound`: see bounds.py. `reason`: why the tolerance is what it is. `known`: why it does
        not hold; empty if it should. `evidence`: what it is worth, see evidence.py."""
        if any(row.name == name for row in self.rows):
            raise ValueError(f"two rows are called {name}")
        row = Row(name, quantity, source, bound, float(value), unit, reason, evidence, known)
        self.rows.append(row)
        self.pending.append(row)

    def value(self, name, value, unit):
        """A number that other pages show and nothing is judged by."""
        self.values.append((name, float(value), unit))

    def figure(self, name, caption, draw, size=(8.0, 3.2)):
        """`draw` fills a matplotlib figure, which is written beside the page."""
        self._flush()
        if self.fast:
            return
        os.makedirs(self.settings.images, exist_ok=True)
        with plt.rc_context(STYLE):
            figure = plt.figure(figsize=size, constrained_layout=True)
            draw(figure)
            figure.savefig(os.path.join(self.settings.images, name + ".png"), metadata={"Software": None})
            plt.close(figure)
        self.lines += [f"![{caption}](images/{self.settings.page}/{name}.png)", "", f"*{caption}*", ""]

    def finish(self):
        self._flush()

    def _flush(self):
        if self.pending:
            header = ["row", "quantity", "source", "expected", "twin", "tolerance", "evidence", "verdict"]
            cells = [[f"`{row.name}`", row.quantity, row.source, with_unit(row.bound.expected(), row.unit),
                      with_unit(number(row.value), row.unit), f"{row.bound.tolerance(row.unit)}: {row.reason}",
                      ": ".join(part for part in (row.evidence.title, row.evidence.link) if part),
                      f"{row.verdict}: {row.known}" if row.known and not row.holds else row.verdict]
                     for row in self.pending]
            self.lines += markdown_table(header, cells) + [""]
            self.pending = []


def with_unit(text, unit):
    return f"{text} {unit}".strip()


def markdown_table(header, rows):
    def line(cells):
        return "| " + " | ".join(str(cell).replace("|", "\\|") for cell in cells) + " |"

    return [line(header), "|" + "---|" * len(header)] + [line(row) for row in rows]


def say(text):
    print(text, file=sys.stderr, flush=True)
