# SPDX-License-Identifier: BSD-3-Clause
"""A small package that the lint checks are tried on."""
import os
import tempfile
import unittest


class Tree(unittest.TestCase):
    """A package of a few files in a temporary folder."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = folder.name

    def write(self, path, content):
        full = os.path.join(self.root, path)
        os.makedirs(os.path.dirname(full), exist_ok=True)
        with open(full, "w", encoding="utf-8") as file:
            file.write(content)
        return full

    def assert_fault(self, check, *words):
        """Exactly one problem, that names all `words`."""
        problems = check(self.root)
        self.assertEqual(len(problems), 1, problems)
        for word in words:
            self.assertIn(word, problems[0])

    def assert_clean(self, check):
        self.assertEqual(check(self.root), [])
