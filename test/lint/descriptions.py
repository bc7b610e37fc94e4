# SPDX-License-Identifier: BSD-3-Clause
"""What describes the package agrees with it: licences, versions, messages, launch files, tables that were copied."""
import os
import re
import sys
import xml.etree.ElementTree as xml

import project
import yaml

sys.path.append(os.path.join(project.ROOT, "lab"))
import assessment_counts  # noqa: E402  (its folder is known now)

LICENCE = "SPDX-License-Identifier: BSD-3-Clause"
# Files that say their licence otherwise, that are read as they are, or that have no comments.
EXEMPT_NAMES = {"LICENSE", "README.md", "CHANGELOG.rst", "package.xml", "py.typed", ".gitignore"}
EXEMPT_SUFFIXES = (".csv", ".ipynb", ".json", ".md", ".patch", ".png", ".supp", ".svg")
LINES_SEARCHED = 3  # after a shebang or an XML declaration

FIELD = re.compile(r"\s*[\w/]+(\[\d*\])?\s+\w+\s*(?P<constant>=[^#]*)?(#(?P<comment>.*))?$")
UNIT = re.compile(r"\[[^\]]+\]")

MESSAGE, REASON, LEVEL, NAMES = ("msg/Verdict.msg", "src/tracking/reason.hpp", "src/tracking/verdict.hpp",
                                 "src/tracking/verdict_text.cpp")


def spdx(root):
    """The licence line stands on top of every file that can carry a comment."""
    problems = []
    for path in project.files(root):
        if os.path.basename(path) in EXEMPT_NAMES or path.endswith(EXEMPT_SUFFIXES):
            continue
        if not any(LICENCE in line for _, line in project.lines(root, path)[:LINES_SEARCHED]):
            problems.append(f"{path}:1: no line with {LICENCE}")
    return problems


def citation(root):
    """CITATION.cff names version, licence and authors as package.xml does, and CHANGELOG.rst's day of the version."""
    cited = yaml.safe_load(project.text(root, "CITATION.cff"))
    package = xml.parse(os.path.join(root, "package.xml"))
    version = package.findtext("version")
    released = re.search(rf"^{re.escape(version)} \((\S+)\)$", project.text(root, "CHANGELOG.rst"), re.MULTILINE)
    wanted = {"version": version, "license": package.findtext("license"),
              "authors": [{"name": author.text} for author in package.iter("author")],
              "date-released": released and released.group(1)}
    return [f"CITATION.cff: {key} is {cited.get(key)}, but {value} in package.xml and CHANGELOG.rst"
            for key, value in wanted.items() if str(cited.get(key)) != str(value)]


def launch_docs(root):
    """Every argument that can be given to a launch file says what it is for; a node with parameters clears those that
    an earlier launch has left below its name."""
    problems = []
    paths = project.files(root, "launch", [".launch"])
    for path in paths:
        tree = xml.parse(os.path.join(root, path))
        handed_on = {arg for include in tree.iter("include") for arg in include.iter("arg")}
        for arg in tree.iter("arg"):
            constant = arg.get("value") is not None
            if arg not in handed_on and not constant and not arg.get("doc", "").strip():
                problems.append(f"{path}: argument '{arg.get('name')}' has no doc")
        for node in tree.iter("node"):
            has_parameters = node.find("param") is not None or node.find("rosparam") is not None
            if has_parameters and node.get("clear_params") != "true":
                problems.append(f"{path}: node '{node.get('name')}' has parameters and no clear_params=\"true\"")
    return problems if paths else ["launch: no launch files found"]


def message_comments(root):
    """Each field of a message has a comment with its unit in [..], each constant a comment."""
    problems = []
    paths = project.files(root, "msg", [".msg"])
    for path in paths:
        for number, line in project.lines(root, path):
            if not line.strip() or line.lstrip().startswith("#"):
                continue
            field = FIELD.match(line)
            comment = (field.group("comment") or "").strip() if field else ""
            if not field:
                problems.append(f"{path}:{number}: not understood: {line}")
            elif field.group("constant") and not comment:
                problems.append(f"{path}:{number}: constant without a comment")
            elif not field.group("constant") and not UNIT.search(comment):
                problems.append(f"{path}:{number}: field without a [unit] in its comment")
    return problems if paths else ["msg: no messages found"]


def enumeration(text, name):
    body = re.search(rf"enum class {name} : std::uint8_t\s*{{(.*?)}};", text, re.DOTALL)
    return re.findall(r"(\w+) = (\d+)", body.group(1)) if body else []


def verdict_reasons(root):
    """Levels and reasons of a verdict: Verdict.msg, the enumerations and the names of the reasons are the same."""
    constants = re.findall(r"^uint8 (\w+)=(\d+)", project.text(root, MESSAGE), re.MULTILINE)
    levels = enumeration(project.text(root, LEVEL), "VerdictLevel")
    reasons = enumeration(project.text(root, REASON), "Reason")
    listed = re.search(r"REASONS{(.*?)};", project.text(root, NAMES), re.DOTALL)
    names = re.findall(r'"(\w+)"', listed.group(1)) if listed else []
    problems = []
    if constants != levels + reasons:
        odd = sorted(set(constants) ^ set(levels + reasons))
        problems.append(f"{MESSAGE}: not the constants of {LEVEL} and {REASON}, in their order: {odd}")
    if names != [name for name, _ in reasons] or [int(number) for _, number in reasons] != list(range(len(reasons))):
        problems.append(f"{NAMES}: REASONS are not the names in {REASON}, numbered from 0 on")
    return problems if levels and reasons else [f"{LEVEL}, {REASON}: no enumeration found"]


def life_counts(root):
    """The counts that forecasts of life use are those of docs/health.md."""
    texts = [project.text(root, file) for file in (assessment_counts.PAGE, assessment_counts.TABLE)]
    if project.text(root, assessment_counts.HEADER) == assessment_counts.header(*texts):
        return []
    return [f"{assessment_counts.HEADER}: not what {assessment_counts.PAGE} says; run lab/run assessment_counts"]


if __name__ == "__main__":
    project.run(lambda root: [problem for check in (spdx, citation, launch_docs, message_comments, verdict_reasons,
                                                    life_counts) for problem in check(root)])
