# SPDX-License-Identifier: BSD-3-Clause
"""Markdown pages: relative links and images lead to files of the package, anchors to headings, `folder/name` to
sources; no page holds a temporary path.

Addresses of the web are not tried.
"""
import os
import re

import project

# [text](target), ![text](target) and an image inside a link, whose target stands after the image's own.
MARKDOWN_TARGET = re.compile(r"\]\(([^()\s]+)\)")
HTML_TARGET = re.compile(r"""<(?:img|a)\s[^>]*?(?:src|href)=["']([^"']+)["']""")
CODE_SPAN = re.compile(r"`[^`]*`")
SOURCE = re.compile(r"`(\w+/\w+)`")  # without its ending: `elements/rim_tension`
TEMPORARY_PATH = re.compile(r"(?<![\w.])/tmp/\S*")


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


def check(root):
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


if __name__ == "__main__":
    project.run(check)
