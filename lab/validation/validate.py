# SPDX-License-Identifier: BSD-3-Clause
"""Runs the sections of the validation and writes the page. See `lab/run validate --help`."""
import argparse
import concurrent.futures
import importlib
import os
import shlex
import sys
import tempfile
import time

import summary
from page import Page, Settings, markdown_table, say

# Module and title, in the order of the page.
SECTIONS = {
    "thesis": "The thesis, chapter by chapter",
    "catalogue": "Catalogue, size 25",
    "teeth": "Teeth",
    "wear": "Wear and stiffness",
    "stress": "Stress and fatigue",
    "published": "Published finite elements",
    "manufacture": "Errors of manufacture",
    "drives": "Real drives",
    "heat": "Heat",
    "size14": "Size 14",
    "family": "The family",
    "dynamics": "The quasi-static claim",
}

HEAD = """# Validation, all rows

Written by `lab/run validate`. Every number and figure below comes from runs of `joint_twin`. A row that *does not hold*
is known not to, and says why; one that **fails** should hold.
"""


def build_section(name, settings):
    """One section in a process of its own: gives the page and the seconds it took."""
    started = time.monotonic()
    sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
    os.makedirs(settings.work, exist_ok=True)
    page = Page(name, settings)
    importlib.import_module(name).build(page)
    page.finish()
    return page, time.monotonic() - started


def write_page(path, pages):
    rows = [row for page in pages for row in page.rows]
    failing = [row for row in rows if row.fails]
    open_rows = sum(bool(row.known) and not row.holds for row in rows)
    sections = [[f"[{SECTIONS[page.section]}](#{summary.anchor(SECTIONS[page.section])})", len(page.rows),
                 sum(row.holds for row in page.rows)] for page in pages]
    verdict = f"{len(failing)} fail" if failing else "all hold"
    if open_rows:
        verdict = f"{open_rows} known not to hold, " + (verdict if failing else "all others hold")
    lines = [HEAD, f"**{len(rows)} rows; {verdict}.**", ""]
    lines += markdown_table(["section", "rows", "hold"], sections) + [""]
    for page in pages:
        lines += [f"## {SECTIONS[page.section]}", ""] + page.lines
        lines += ["<details><summary>Runs of this section</summary>", "", "```sh"] + page.commands
        lines += ["```", "", "</details>", ""]
    with open(path, "w", encoding="utf-8") as file:
        file.write("\n".join(lines).rstrip() + "\n")


def report(pages):
    for page in pages:
        for row in page.rows:
            if row.fails:
                print(f"FAILS {row.name}: {row.quantity}: {row.bound.expected()} expected "
                      f"({row.bound.tolerance(row.unit)}), {row.value:.6g} {row.unit} came out")
    rows = [row for page in pages for row in page.rows]
    failing = sum(row.fails for row in rows)
    holding = sum(row.holds for row in rows)
    known = len(rows) - holding - failing
    print(f"{len(rows)} rows, {holding} hold, {failing} fail" + (f", {known} known not to hold" if known else ""))
    return failing


def parse(arguments):
    parser = argparse.ArgumentParser(
        prog="validate", description="Holds the twin against thesis, catalogue and real drives. Writes all "
        "rows to out/validation and, where nothing is left out or changed, the summary "
        "docs/validation.md. Exit code 0 if every row holds or is known not to, 1 if another fails or a run did.")
    parser.add_argument("--tool", required=True, help=argparse.SUPPRESS)
    parser.add_argument("--docs", required=True, help=argparse.SUPPRESS)
    parser.add_argument("--telemetry", required=True, help=argparse.SUPPRESS)
    parser.add_argument("--section", action="append", choices=SECTIONS, metavar="NAME",
                        help="only this section; repeatable: " + ", ".join(SECTIONS))
    parser.add_argument("--fast", action="store_true", help="only rows that take a few seconds, no figures")
    parser.add_argument("--config", action="append", default=[], metavar="FILE",
                        help="overlay for every run, after its own: a deliberately wrong parameter, say")
    parser.add_argument("--set", action="append", default=[], metavar="section.key=value",
                        help="one parameter for every run, after its own")
    parser.add_argument("--out", metavar="DIR", help="folder of all rows (default: out/validation of the "
                        "checkout; needed to write them with --section, --fast, --config or --set)")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), metavar="N", help="sections at a time")
    options = parser.parse_args(arguments)
    for path in options.config:
        if not os.path.isfile(path):
            parser.error(f"--config: no such file: {path}")
    return options


def main(arguments):
    options = parse(arguments)
    names = [name for name in SECTIONS if not options.section or name in options.section]
    overlays = [word for path in options.config for word in ("--config", os.path.abspath(path))]
    overlays += [word for assignment in options.set for word in ("--set", assignment)]
    whole = not (options.section or options.fast or overlays)
    out = options.out or (os.path.join(os.path.dirname(options.docs), "out", "validation") if whole else None)
    failed = False
    with tempfile.TemporaryDirectory(prefix="validate.") as work:
        pages = {}
        with concurrent.futures.ProcessPoolExecutor(max(1, options.jobs)) as pool:
            running = {}
            for name in names:
                settings = Settings(options.tool, os.path.abspath(out or work), os.path.join(work, name),
                                    options.telemetry, options.fast, tuple(overlays))
                running[pool.submit(build_section, name, settings)] = name
            for done in concurrent.futures.as_completed(running):
                name = running[done]
                try:
                    pages[name], seconds = done.result()
                # pylint: disable=broad-except  (whatever stops one section: the others count)
                except Exception as error:
                    failed = True
                    say(f"[{len(pages)}/{len(names)}] {name}: STOPPED: {error}")
                    continue
                say(f"[{len(pages)}/{len(names)}] {name}: {len(pages[name].rows)} rows, {seconds:.0f} s")
        ordered = [pages[name] for name in names if name in pages]
        if out and not failed:
            os.makedirs(out, exist_ok=True)
            write_page(os.path.join(out, "validation.md"), ordered)
            say(f"page: {shlex.quote(os.path.join(out, 'validation.md'))}")
            if whole:
                summary.write(options.docs, out, ordered, SECTIONS)
                say(f"summary: {shlex.quote(os.path.join(options.docs, 'validation.md'))}")
    return 1 if report(ordered) or failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
