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

    def fails(self, assignments, rows, sections):
        chosen = [word for section in sections for word in ("--section", section)]
        wrong = [word for assignment in assignments for word in ("--set", assignment)]
        code, failing, text = validate(*wrong, *chosen)
        self.assertEqual(code, 1, text)
        self.assertLessEqual(set(rows), failing, text)

    def test_every_fast_row_holds(self):
        code, failing, text = validate()
        self.assertEqual((code, failing), (0, set()), text)
        self.assertRegex(text, r"\d+ rows, \d+ hold, 0 fail")

    def test_stiffer_contact_fails_the_insertion(self):
        self.fails(["contact.stiffness=1.1e+8"],
                   ["thesis.force_max", "thesis.independent_operation_wave_generator_force", "thesis.locked_angle",
                    "thesis.locked_bearing"], ["thesis"])

    def test_doubled_friction_fails_the_slips(self):
        self.fails(["contact.friction_coefficient=0.14"], ["catalogue.interface_slip"], ["catalogue"])
        self.fails(["mesh.friction_static=0.2", "mesh.friction_kinetic=0.12"], ["catalogue.flank_slip"], ["catalogue"])

    def test_other_grease_fails_the_friction(self):
        self.fails(["bearing.viscosity=300.0e-6"],
                   ["catalogue.no_load", "catalogue.efficiency", "drives.ur5e.elbow.3.2", "size14.no_load"],
                   ["catalogue", "drives", "size14"])

    def test_softer_teeth_fail_the_stress(self):
        self.fails(["mesh.stiffness=4.0e+7"], ["stress.tooth_space_highest_150"], ["stress"])

    @unittest.skipUnless(os.path.isdir(os.path.join(RECORDINGS, "ur10e")), "no recordings")
    def test_a_preloaded_race_fails_the_loss_by_load(self):
        self.fails(["contact.fit=3.84e-6", "bearing.race_preload=600.0"],
                   ["drives.ur10e.load_loss.shoulder.1", "drives.ur10e.load_loss.shoulder.2"], ["drives"])

    def test_another_oil_fails_its_viscosity(self):
        self.fails(["bearing.viscosity_slope=3.5"], ["catalogue.oil.40", "catalogue.oil.100"], ["catalogue"])

    def test_a_housing_cooled_twice_as_well_fails_the_warm_up(self):
        self.fails(["thermal.ambient_conductance=2.2"], ["heat.time_constant.size_25", "heat.time_constant.size_14"],
                   ["heat"])

    def test_cup_as_stiff_as_the_whole_gear_fails_the_torsion(self):
        self.fails(["cup.torsion_stiffness=[31.0e+3, 50.0e+3, 57.0e+3]"],
                   ["catalogue.torsion.14", "catalogue.torsion.150"], ["catalogue"])

    def test_coarser_teeth_fail_the_kinematic_error(self):
        self.fails(["manufacture.circular_spline_pitch_deviation=30.0e-6"],
                   ["manufacture.perfect", "manufacture.flexspline_not_the_other", "manufacture.as_built_order_2",
                    "manufacture.circular_spline_order_4"], ["manufacture"])

    def test_other_flanks_fail_the_teeth(self):
        self.fails(["mesh.stiffness=1.0e+8"], ["teeth.involute_in_mesh", "teeth.double_arc_in_mesh_150"], ["teeth"])
        self.fails(["mesh.flank_angle=0.2"], ["teeth.no_interference_trapezoid", "teeth.interference_free"], ["teeth"])
        self.fails(["gear.wave_amplitude=0.33e-3"], ["teeth.no_interference_double_arc"], ["teeth"])

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
