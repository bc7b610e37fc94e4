# SPDX-License-Identifier: BSD-3-Clause
"""The measured part of a page that is written by hand otherwise: between `<!-- NAME:begin -->` and `<!-- NAME:end
-->`."""


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
