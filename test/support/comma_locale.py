#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""comma_locale.py FOLDER makes the locale FOLDER/comma, found by LOCPATH=FOLDER: its LC_NUMERIC has a decimal comma.

Unlike de_DE.UTF-8 it needs no more than the C library's own program.
"""
import os
import subprocess
import sys

SOURCE = '''comment_char %
escape_char /
LC_NUMERIC
decimal_point ","
thousands_sep "."
grouping 3;3
END LC_NUMERIC
'''
CHARACTERS = '''<code_set_name> ASCII
<comment_char> %
<escape_char> /
CHARMAP
<U002C> /x2c COMMA
<U002E> /x2e FULL STOP
<U0030>..<U0039> /x30 DIGIT
END CHARMAP
'''


def make(folder):
    source, characters = os.path.join(folder, "source"), os.path.join(folder, "characters")
    for path, text in ((source, SOURCE), (characters, CHARACTERS)):
        with open(path, "w", encoding="ascii") as file:
            file.write(text)
    # It complains of the categories that are not there and makes the one that is.
    subprocess.run(["localedef", "-c", "-i", source, "-f", characters, os.path.join(folder, "comma")],
                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False)


if __name__ == "__main__":
    make(sys.argv[1])
