# SPDX-License-Identifier: BSD-3-Clause
"""Ends the program that makes the page of a report as one that has made it: for tests that read the data alone."""
raise SystemExit
