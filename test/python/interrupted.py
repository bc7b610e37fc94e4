# SPDX-License-Identifier: BSD-3-Clause
"""Programs that are interrupted."""
import signal
import subprocess
import sys
import time


def interrupted(test, program):
    """Words that a program prints after a line 'ready', once SIGINT has come to it while it was at work."""
    with subprocess.Popen([sys.executable, "-c", program], stdout=subprocess.PIPE, text=True) as process:
        test.assertEqual(process.stdout.readline(), "ready\n")
        time.sleep(0.3)
        sent = time.monotonic()
        process.send_signal(signal.SIGINT)
        words = process.stdout.read().split()
        test.assertLess(time.monotonic() - sent, 10.0)
    return words
