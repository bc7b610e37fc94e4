# SPDX-License-Identifier: BSD-3-Clause
"""CITATION.cff names version, licence and authors as package.xml does, and the day of the version in CHANGELOG.rst."""
import os
import re
import xml.etree.ElementTree as xml

import project
import yaml


def check(root):
    citation = yaml.safe_load(project.text(root, "CITATION.cff"))
    package = xml.parse(os.path.join(root, "package.xml"))
    version = package.findtext("version")
    released = re.search(rf"^{re.escape(version)} \((\S+)\)$", project.text(root, "CHANGELOG.rst"), re.MULTILINE)
    wanted = {"version": version, "license": package.findtext("license"),
              "authors": [{"name": author.text} for author in package.iter("author")],
              "date-released": released and released.group(1)}
    return [f"CITATION.cff: {key} is {citation.get(key)}, but {value} in package.xml and CHANGELOG.rst"
            for key, value in wanted.items() if str(citation.get(key)) != str(value)]


if __name__ == "__main__":
    project.run(check)
