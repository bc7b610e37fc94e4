#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Every notebook of docs/notebooks runs from a fresh kernel and leaves its picture. Arguments: the tool; optionally a
folder that gets the pictures, as docs/images/notebooks."""
import os
import shutil
import sys
import tempfile
import unittest

try:
    import nbformat
    from nbclient import NotebookClient
except ImportError as error:
    print(f"skipped: {error}")
    sys.exit(77)

TOOL = sys.argv.pop(1)
PICTURES = os.path.abspath(sys.argv.pop(1)) if len(sys.argv) > 1 and os.path.isdir(sys.argv[1]) else None
FOLDER = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "docs", "notebooks")


class Notebooks(unittest.TestCase):
    def execute(self, name):
        notebook = nbformat.read(os.path.join(FOLDER, name + ".ipynb"), as_version=4)
        self.assertFalse(any(cell.get("outputs") for cell in notebook.cells), "kept without its outputs")
        os.environ.update(MPLBACKEND="agg", PYDEVD_DISABLE_FILE_VALIDATION="1")
        with tempfile.TemporaryDirectory() as folder:
            NotebookClient(notebook, timeout=600, kernel_name="python3",
                           resources={"metadata": {"path": folder}}).execute()
            picture = os.path.join(folder, name + ".png")
            self.assertGreater(os.path.getsize(picture), 20000)
            if PICTURES:
                shutil.copy(picture, PICTURES)
        for cell in notebook.cells:
            for output in cell.get("outputs", []):
                print(output.get("text", ""), end="")

    def test_each(self):
        names = sorted(name[:-len(".ipynb")] for name in os.listdir(FOLDER) if name.endswith(".ipynb"))
        self.assertEqual(names, ["data_set_to_verdict", "fault_in_tooth_forces", "gear_study", "recording_compared"])
        for name in names:
            with self.subTest(name):
                self.execute(name)


if __name__ == "__main__":
    unittest.main(verbosity=2)
