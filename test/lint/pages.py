# SPDX-License-Identifier: BSD-3-Clause
"""Markdown pages: their links, and their numbers that the validation computes."""
import csv
import os
import re

import project

# [text](target), ![text](target) and an image inside a link, whose target stands after the image's own.
MARKDOWN_TARGET = re.compile(r"\]\(([^()\s]+)\)")
HTML_TARGET = re.compile(r"""<(?:img|a)\s[^>]*?(?:src|href)=["']([^"']+)["']""")
CODE_SPAN = re.compile(r"`[^`]*`")
SOURCE = re.compile(r"`(\w+/\w+)`")  # without its ending: `elements/rim_tension`
TEMPORARY_PATH = re.compile(r"(?<![\w.])/tmp/\S*")
VALUES = "docs/validation.csv"
MARK = "<!-- value:"
MARKED = re.compile(r"(?P<number>-?\d+(?:\.(?P<digits>\d+))?)"
                    r"<!-- value: (?P<row>[\w.]+)(?: \* (?P<factor>[\d.e-]+))? -->")


def prose(page):
    """Pairs of line number and line of a page without its blocks of code."""
    fenced = False
    for number, line in enumerate(page.splitlines(), start=1):
        if line.lstrip().startswith("```"):
            fenced = not fenced
        elif not fenced:
            yield number, line


def anchors(page):
    """The anchors of a page's headings as GitHub makes them."""
    found = set()
    for _, line in prose(page):
        heading = re.match(r"#+ +(.*?) *#*$", line)
        if heading:
            text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading.group(1))
            anchor = re.sub(r"[^\w\- ]", "", text.lower()).replace(" ", "-")
            count = 0
            while (anchor if not count else f"{anchor}-{count}") in found:
                count += 1
            found.add(anchor if not count else f"{anchor}-{count}")
    return found


def fault(root, path, target):
    """Why the link to `target` on page `path` leads nowhere; None if it leads somewhere."""
    if re.match(r"[a-z]+:", target):
        return None
    file, _, anchor = target.partition("#")
    linked = os.path.normpath(os.path.join(os.path.dirname(path), file)) if file else path
    if os.path.isabs(linked) or linked.startswith("..") or not os.path.exists(os.path.join(root, linked)):
        return f"no such file: {target}"
    if anchor and linked.endswith(".md") and anchor not in anchors(project.text(root, linked)):
        return f"no such heading: {target}"
    return None


def is_missing(root, source):
    """Whether `source` lies in a folder of src and is no file there."""
    names = [os.path.join(root, top, source + ending) for top in ("src", "include/harmonic_joint_twin", "")
             for ending in ("", ".hpp", ".cpp")]
    return os.path.isdir(os.path.dirname(names[0])) and not any(map(os.path.exists, names))


def check_links(root):
    """Relative links and images lead to files of the package, anchors to headings, `folder/name` to sources; no page
    holds a temporary path. Addresses of the web are not tried."""
    problems = []
    paths = project.files(root, "", [".md"])
    for path in paths:
        page = project.text(root, path)
        for number, line in prose(page):
            problems += [f"{path}:{number}: no such source: {source}" for source in SOURCE.findall(line)
                         if is_missing(root, source)]
            line = CODE_SPAN.sub("", line)
            for target in MARKDOWN_TARGET.findall(line) + HTML_TARGET.findall(line):
                problem = fault(root, path, target)
                if problem:
                    problems.append(f"{path}:{number}: {problem}")
        for number, line in enumerate(page.splitlines(), start=1):
            for temporary in TEMPORARY_PATH.findall(line):
                problems.append(f"{path}:{number}: a temporary path: {temporary}")
    return problems if paths else ["no Markdown pages found"]


def values(root):
    """Row to value, and the counts of rows."""
    rows = list(csv.DictReader(project.text(root, VALUES).splitlines()))
    known = {row["row"]: float(row["value"]) for row in rows}
    rows = [row for row in rows if row["holds"]]  # the others are values alone
    known.update({"rows": len(rows), "rows.fail": sum(row["holds"] == "no" for row in rows)})
    for name in {row["class"] for row in rows}:
        own = [row for row in rows if row["class"] == name]
        known[f"rows.{name.replace(' ', '_')}"] = len(own)
        known[f"rows.{name.replace(' ', '_')}.hold"] = sum(row["holds"] == "yes" for row in own)
    return known


def wrong_value(found, known):
    """What is wrong with one marked number; None if nothing is."""
    if found["row"] not in known:
        return f"no row {found['row']} in {VALUES}"
    value = known[found["row"]] * float(found["factor"] or 1.0)
    digits = len(found["digits"] or "")
    if abs(float(found["number"]) - value) > 0.5000001 * 10.0 ** -digits:
        return f"{found['number']} is shown, {found['row']} has {value:.{digits + 2}f}"
    return None


def check_values(root):
    """Behind a number that the validation computes stands `<!-- value: ROW -->`, or `<!-- value: ROW * FACTOR -->`
    where the page has another unit. It is the row's value in docs/validation.csv, rounded to the digits shown. `rows`
    counts all rows, `rows.CLASS` those of a class, `rows.CLASS.hold` those of them that hold, `rows.fail` those that do
    not."""
    known = values(root)
    problems, marked = [], 0
    for path in project.files(root, "", [".md"]):
        for number, line in project.lines(root, path):
            line = CODE_SPAN.sub("", line)
            found = list(MARKED.finditer(line))
            marked += len(found)
            if line.count(MARK) != len(found):
                problems.append(f"{path}:{number}: no number before '{MARK}', or an unknown form of it")
            problems += [f"{path}:{number}: {problem}" for problem in (wrong_value(one, known) for one in found)
                         if problem]
    return problems if marked else ["no marked number found"]


if __name__ == "__main__":
    project.run(lambda root: check_links(root) + check_values(root))
