# SPDX-License-Identifier: BSD-3-Clause
"""What the system tells of a process."""
import os


def processor_time(pid):
    """Of all its threads so far [s]."""
    with open(f"/proc/{pid}/stat", encoding="ascii", errors="replace") as file:
        fields = file.read().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")
