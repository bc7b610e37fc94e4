# SPDX-License-Identifier: BSD-3-Clause
"""Reads files of signatures (config/signatures/), and replaces what is fitted to many gears in them."""
import re

import yaml


def number_text(value):
    """Spelt so that every YAML reader takes it for a number; the shortest that reads back the same."""
    text = repr(float(value))
    return text if "." in text else text.replace("e", ".0e")


def read(path):
    """The file as a dict; "signatures": rows of words."""
    content = yaml.safe_load(path.read_text(encoding="utf-8"))
    content["signatures"] = [row.split() for row in content["signatures"].splitlines()]
    return content


def replace(path, key, values):
    """A mapping of numbers, or of lists of them."""
    lines = []
    for name, value in values.items():
        text = f"[{', '.join(map(number_text, value))}]" if isinstance(value, list) else number_text(value)
        lines.append(f"  {name}: {text}\n")
    text = path.read_text(encoding="utf-8")
    path.write_text(re.sub(rf"^{key}:\n(  .*\n)*", f"{key}:\n" + "".join(lines), text, flags=re.MULTILINE),
                    encoding="utf-8")
