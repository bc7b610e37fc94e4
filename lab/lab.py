# SPDX-License-Identifier: BSD-3-Clause
"""What the programs of the laboratory share: the measured part of a page that is written by hand otherwise, between
`<!-- NAME:begin -->` and `<!-- NAME:end -->`, and the drawing style of the package's own figures."""
import pathlib
import sys

CHECKOUT = pathlib.Path(__file__).resolve().parent.parent

sys.path.append(str(CHECKOUT / "scripts"))
from drawing import BLUE, GREEN, GREY, ORANGE, PURPLE, RED, STYLE, plt  # noqa: E402, F401  (after its folder)


def write(path, name, lines):
    begin, end = f"<!-- {name}:begin -->", f"<!-- {name}:end -->"
    with open(path, encoding="utf-8") as page:
        before, rest = page.read().split(begin)
    after = rest.split(end)[1]
    with open(path, "w", encoding="utf-8") as page:
        page.write(before + "\n".join([begin, "", *lines, "", end]) + after)


def write_or_print(docs, page, name, lines):
    """Into `page` of the folder `docs`; without a folder, printed."""
    if docs:
        write(docs / page, name, lines)
    else:
        print("\n".join(lines))
