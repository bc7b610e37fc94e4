# SPDX-License-Identifier: BSD-3-Clause
"""`lab/run validate`: every fast row holds as shipped, and a wrong parameter makes the rows fail that it should."""
import os
import subprocess
import sys
import tempfile
import unittest

CHECKOUT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(CHECKOUT, "lab", "validation"))
import page as validation_page  # noqa: E402

RECORDINGS = os.environ.get("HJT_TELEMETRY_DIR", os.path.join(CHECKOUT, "..", "shared", "telemetry"))


def validate(*arguments):
    """Exit code, failing rows, and everything printed."""
    command = [sys.executable, os.path.join(CHECKOUT, "lab", "validation", "validate.py"), "--tool", Validate.tool,
               "--docs", os.path.join(CHECKOUT, "docs"), "--telemetry", RECORDINGS, "--fast", *arguments]
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True,
                          check=False, env={**os.environ, "OPENBLAS_NUM_THREADS": "1"})  # as lab/run validate
    failing = {line.split()[1].rstrip(":") for line in done.stdout.splitlines() if line.startswith("FAILS")}
    return done.returncode, failing, done.stdout


class Validate(unittest.TestCase):
    tool = None

    def test_every_fast_row_holds(self):
        code, failing, text = validate()
        self.assertEqual((code, failing), (0, set()), text)
        self.assertRegex(text, r"\d+ rows, \d+ hold, 0 fail")

    def test_wrong_parameters_fail_the_rows_that_they_should(self):
        for assignments, sections, rows in (
                (("contact.stiffness=1.1e+8",), ["thesis"],
                 {"thesis.force_max", "thesis.independent_operation_wave_generator_force", "thesis.locked_angle",
                  "thesis.locked_bearing"}),
                # Of three parameters that no row shares.
                (("contact.friction_coefficient=0.14", "bearing.viscosity_slope=3.5",
                  "cup.torsion_stiffness=[31.0e+3, 50.0e+3, 57.0e+3]"), ["catalogue"],
                 {"catalogue.interface_slip", "catalogue.oil.40", "catalogue.oil.100", "catalogue.torsion.14",
                  "catalogue.torsion.150"}),
                (("mesh.friction_static=0.2", "mesh.friction_kinetic=0.12"), ["catalogue"], {"catalogue.flank_slip"}),
                (("bearing.viscosity=300.0e-6",), ["drives", "size14"], {"drives.ur5e.elbow.3.2", "size14.no_load"}),
                (("mesh.stiffness=4.0e+7",), ["stress"], {"stress.tooth_space_highest_150"}),
                (("thermal.ambient_conductance=2.2",), ["heat"],
                 {"heat.time_constant.size_25", "heat.time_constant.size_14"}),
                (("manufacture.circular_spline_pitch_deviation=30.0e-6",), ["manufacture"],
                 {"manufacture.perfect", "manufacture.flexspline_not_the_other", "manufacture.as_built_order_2",
                  "manufacture.circular_spline_order_4"}),
                (("gear.wave_amplitude=0.33e-3",), ["teeth"], {"teeth.no_interference_double_arc"})):
            with self.subTest(assignments):
                chosen = [word for section in sections for word in ("--section", section)]
                chosen += [word for assignment in assignments for word in ("--set", assignment)]
                code, failing, text = validate(*chosen)
                self.assertEqual(code, 1, text)
                self.assertLessEqual(rows, failing, text)

    def test_page_and_exit_codes(self):
        with tempfile.TemporaryDirectory() as out:
            code, _, text = validate("--section", "catalogue", "--out", out)
            self.assertEqual(code, 0, text)
            with open(os.path.join(out, "validation.md"), encoding="utf-8") as page:
                self.assertIn("`catalogue.torsion.48`", page.read())
        self.assertEqual(validate("--section", "nonsense")[0], 2)
        self.assertEqual(validate("--config", "/no/such/file.yaml")[0], 2)
        code, _, text = validate("--section", "catalogue", "--set", "gear.wings=2")
        self.assertEqual(code, 1, text)
        self.assertIn("gear.wings", text)

    def test_printed_commands_hold_no_temporary_path(self):
        with tempfile.TemporaryDirectory() as work:
            page = validation_page.Page("any",
                                        validation_page.Settings(tool="/bin/true", out=work, work=work, telemetry=""))
            page.run("manufacture", "--flexspline-csv", page.scratch("flexspline.csv"))
        self.assertEqual(page.commands, ["joint_twin manufacture --flexspline-csv $PWD/flexspline.csv"])


if __name__ == "__main__":
    Validate.tool = sys.argv.pop(1)
    unittest.main(verbosity=2)
