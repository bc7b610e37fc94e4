// SPDX-License-Identifier: BSD-3-Clause
#include <pybind11/stl.h>

#include <cmath>
#include <optional>
#include <vector>

#include "base/number_text.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "harmonic_joint_twin/statics/loss_analysis.hpp"
#include "harmonic_joint_twin/statics/static_analysis.hpp"
#include "harmonic_joint_twin/statics/torsion_loop.hpp"
#include "harmonic_joint_twin/twin/twin.hpp"
#include "python/bindings.hpp"
#include "python/configuration.hpp"
#include "statics/flexspline_stress.hpp"
#include "statics/gear_design.hpp"
#include "statics/gear_rules.hpp"

namespace hjt
{
/// One row of quasi-static turning.
struct TurnValues
{
  double wave_generator_angle;
  double output_angle;
  double kinematic_error;
  double wave_generator_torque;
  double housing_torque;
};

/// One row of the losses. Names as in `joint_twin losses --json`.
struct LossValues
{
  double motor_speed;
  double load_torque;
  double load_reduced;
  double bearing;
  double interface;
  double flexing;
  double mesh;
  double cup;
  double damping;
  double output;
  double motor;
  double gear_loss;
  double gear_efficiency;
};

namespace
{
/// Adds a vector of a class as an array that is a view of it.
template <class Class, class Values>
void addArray(Class& type, const char* name, std::vector<double> Values::*values, const char* meaning)
{
  type.def_property_readonly(
      name, [values](const py::object& self) { return viewOf(self.cast<const Values&>().*values, self); }, meaning);
}

/// By its name. @throws InputError.
std::size_t stressPlace(const std::string& name)
{
  std::string names;
  for (std::size_t place = 0; place < STRESS_PLACES; ++place)
  {
    if (name == STRESS_PLACE_NAMES[place])
    {
      return place;
    }
    names += (place > 0 ? ", '" : "'") + std::string(STRESS_PLACE_NAMES[place]) + "'";
  }
  throw InputError("place = '" + name + "' must be one of " + names);
}

/// @throws InputError.
void requireFinite(const char* name, const std::vector<double>& values)
{
  for (const double value : values)
  {
    if (!std::isfinite(value))
    {
      throw InputError(std::string(name) + " = " + numberText(value) + " is not a finite number");
    }
  }
}

/// The parameters, for an analysis that honours their faults. @throws ParameterError if one cannot act in it.
Parameters analysed(const Configuration& parameters, Analysis analysis)
{
  requireFaultsAct(parameters.values(), analysis);
  return parameters.values();
}

std::string valueWithUnit(double value, const char* unit)
{
  return numberText(value) + ' ' + unit;
}

InsertionResult insertion(const Configuration& parameters)
{
  InsertionResult result =
      withoutLock([given = analysed(parameters, Analysis::INSERTION)] { return analyseInsertion(given); });
  if (!result.status.ok())
  {
    throw NotConverged("the insertion", result.status);
  }
  return result;
}

FitCheck fit(const Configuration& parameters)
{
  FitCheck check = withoutLock([given = analysed(parameters, Analysis::RING)] { return checkFit(given); });
  if (!check.status.ok())
  {
    throw NotConverged("the gear without load", check.status);
  }
  return check;
}

std::vector<StiffnessRow> stiffness(const Configuration& parameters, const std::vector<double>& torques, double angle)
{
  requireFinite("torques", torques);
  requireFinite("angle", { angle });
  std::vector<StiffnessRow> rows;
  withoutLock(
      [&, given = analysed(parameters, Analysis::RING)]
      {
        InterruptCheck check;
        // No row depends on another.
        for (const double torque : torques)
        {
          rows.push_back(std::move(analyseStiffness(given, angle, { torque }).front()));
          check();
        }
      });
  for (const StiffnessRow& row : rows)
  {
    if (!row.status.ok())
    {
      throw NotConverged("the row of torque " + valueWithUnit(row.torque, "N.m"), row.status);
    }
  }
  return rows;
}

py::array_t<TurnValues> turn(const Configuration& parameters, double load, double angle_range, int steps)
{
  requireFinite("load", { load });
  requireFinite("angle_range", { angle_range });
  const std::vector<TurnRow> rows = withoutLock(
      [&, given = analysed(parameters, Analysis::RING)]
      {
        InterruptCheck check;
        return analyseTurn(given, load, angle_range, steps, [&](int) { check(); });
      });
  py::array_t<TurnValues> values(static_cast<py::ssize_t>(rows.size()));
  TurnValues* next = values.mutable_data();
  for (const TurnRow& row : rows)
  {
    if (!row.status.ok())
    {
      throw NotConverged("the row of wave generator angle " + valueWithUnit(row.wave_generator_angle, "rad"),
                         row.status);
    }
    *next++ = { row.wave_generator_angle, row.output_angle, row.kinematic_error, row.wave_generator_torque,
                row.housing_torque };
  }
  return values;
}

py::array_t<LossValues> losses(const Configuration& parameters, const std::vector<double>& speeds,
                               const std::vector<double>& loads, int positions)
{
  requireFinite("speeds", speeds);
  requireFinite("loads", loads);
  const std::vector<LossRow> rows = withoutLock(
      [&, given = analysed(parameters, Analysis::WITH_FRICTION)]
      {
        InterruptCheck check;
        return analyseLosses(given, speeds, loads, positions, [&](int) { check(); });
      });
  py::array_t<LossValues> values({ loads.size(), speeds.size() });
  LossValues* next = values.mutable_data();
  for (const LossRow& row : rows)
  {
    if (!row.status.ok())
    {
      throw NotConverged("the load of " + valueWithUnit(row.load_torque, "N.m"), row.status);
    }
    const LossShares& loss = row.loss;
    *next++ = { row.motor_speed, row.load_torque, row.load_reduced,   loss.bearing, loss.interface,
                loss.flexing,    loss.mesh,       loss.cup,           loss.damping, loss.output,
                loss.motor,      loss.gear(),     row.gear_efficiency };
  }
  return values;
}

Breakaway breakaway(const Configuration& parameters, int positions)
{
  Breakaway result = withoutLock([given = analysed(parameters, Analysis::WITH_FRICTION), positions]
                                 { return analyseBreakaway(given, positions); });
  if (!result.status.ok())
  {
    throw NotConverged("the load that drives the gear back", result.status);
  }
  return result;
}

TorsionLoop torsionLoop(const Configuration& parameters, double amplitude, double lost_motion_torque, int steps)
{
  requireFinite("amplitude", { amplitude });
  TorsionLoop loop = withoutLock([&, given = analysed(parameters, Analysis::WITH_FRICTION)]
                                 { return analyseTorsionLoop(given, amplitude, lost_motion_torque, steps); });
  if (!loop.status.ok())
  {
    throw NotConverged("the torsion loop", loop.status);
  }
  return loop;
}

/// One value of all points of a loop.
template <double TorsionPoint::*VALUE>
py::array_t<double> pointsOf(const TorsionLoop& loop)
{
  py::array_t<double> values(static_cast<py::ssize_t>(loop.points.size()));
  double* next = values.mutable_data();
  for (const TorsionPoint& point : loop.points)
  {
    *next++ = point.*VALUE;
  }
  return values;
}

void bindTeeth(py::module& module)
{
  auto teeth = py::class_<ToothTable>(module, "ToothTable",
                                      "Every tooth of one equilibrium: arrays of shape (teeth,), index = tooth, views "
                                      "of the result's memory, which they "
                                      "keep alive.");
  addArray(teeth, "tooth_x", &ToothTable::tooth_x, "of the tooth point [m]");
  addArray(teeth, "tooth_y", &ToothTable::tooth_y, "of the tooth point [m]");
  addArray(teeth, "radius", &ToothTable::radius, "of the tooth point [m]");
  addArray(teeth, "angle_deviation", &ToothTable::angle_deviation, "of the tooth point's angle from rest [rad]");
  addArray(teeth, "wave_generator_force", &ToothTable::wave_generator_force, "[N]");
  addArray(teeth, "rim_tension", &ToothTable::rim_tension, "to the next tooth [N]");
  addArray(teeth, "bending_force", &ToothTable::bending_force, "of the segment to the next tooth [N]");
  addArray(teeth, "mesh_force", &ToothTable::mesh_force,
           "normal force on the flank, > 0 leading, < 0 trailing flank [N]");
  addArray(teeth, "stress_tooth_space", &ToothTable::stress_tooth_space, "nominal normal stress [Pa]");
  addArray(teeth, "stress_transition", &ToothTable::stress_transition, "nominal normal stress [Pa]");
  addArray(teeth, "stress_flange", &ToothTable::stress_flange, "nominal normal stress [Pa]");
  addArray(teeth, "across", &ToothTable::across, "place in its space of the circular spline; empty without one [m]");
  addArray(teeth, "depth", &ToothTable::depth, "likewise [m]");
  addArray(teeth, "tilt", &ToothTable::tilt, "likewise [rad]");
  addArray(teeth, "gap", &ToothTable::gap, "to the nearer flank; likewise [m]");
  addText(teeth);
}

void bindInsertion(py::module& module)
{
  auto result = py::class_<InsertionResult>(
      module, "InsertionResult", "Equilibrium after the wave generator's insertion, circular spline left out.");
  result.def_readonly("wave_generator_force_max", &InsertionResult::wave_generator_force_max, "[N]")
      .def_readonly("wave_generator_force_min", &InsertionResult::wave_generator_force_min, "[N]")
      .def_readonly("wave_generator_force_sum", &InsertionResult::wave_generator_force_sum, "[N]")
      .def_readonly("teeth_in_contact", &InsertionResult::teeth_in_contact, "with the wave generator [-]")
      .def_readonly("tension_min", &InsertionResult::tension_min, "of the rim [N]")
      .def_readonly("tension_max", &InsertionResult::tension_max, "of the rim [N]")
      .def_readonly("radius_major_axis", &InsertionResult::radius_major_axis, "of tooth 0 [m]")
      .def_readonly("radius_minor_axis", &InsertionResult::radius_minor_axis, "of tooth N/4 [m]")
      .def_readonly("bending_force_max", &InsertionResult::bending_force_max, "[N]")
      .def_readonly("teeth", &InsertionResult::teeth, "ToothTable");
  addText(result);
  module.def("analyse_insertion", &insertion, py::arg("parameters"),
             "Static equilibrium after the insertion, without circular spline: InsertionResult. NotConverged.");

  auto check = py::class_<FitCheck>(module, "FitCheck", "Whether the teeth have room where the gear carries no load.");
  check.def_readonly("teeth_loaded", &FitCheck::teeth_loaded, "without load [-]")
      .def_readonly("wave_generator_force", &FitCheck::wave_generator_force, "sum over the teeth, without load [N]")
      .def_readonly("wave_generator_force_insertion", &FitCheck::wave_generator_force_insertion,
                    "the same without the circular spline [N]")
      .def_property_readonly("jams", &FitCheck::jams, "the teeth press harder on the wave generator than the bent rim");
  addText(check);
  module.def("check_fit", &fit, py::arg("parameters"),
             "Whether the teeth have room: FitCheck; worth a look after every change of a gear. NotConverged.");
}

/// The parameters of the gear wanted, and by what rule each of its parameters follows.
py::tuple design(const Configuration& parameters, double size, int ratio, const std::optional<double>& bore_radius,
                 const std::optional<double>& rim_thickness, const std::optional<double>& face_width,
                 const std::vector<double>& stiffness, const std::vector<double>& breakpoints,
                 const std::vector<double>& ratings, const std::optional<double>& starting_torque,
                 const std::optional<double>& no_load_torque)
{
  const GearRequest request{ size,      ratio,       bore_radius, rim_thickness,   face_width,
                             stiffness, breakpoints, ratings,     starting_torque, no_load_torque };
  const GearDesign designed = withoutLock([&] { return designGear(parameters.map(), request, gearFigures(request)); });
  py::dict rules;
  for (const DesignedParameter& parameter : designed.parameters)
  {
    rules[parameter.key.c_str()] = parameter.rule;
  }
  return py::make_tuple(parameters.with(designed.map), rules);
}

void bindDesign(py::module& module)
{
  module.def(
      "design_gear", &design, py::arg("parameters"), py::arg("size"), py::arg("ratio") = 100,
      py::arg("bore_radius") = py::none(), py::arg("rim_thickness") = py::none(), py::arg("face_width") = py::none(),
      py::arg("stiffness") = std::vector<double>(), py::arg("breakpoints") = std::vector<double>(),
      py::arg("ratings") = std::vector<double>(), py::arg("starting_torque") = py::none(),
      py::arg("no_load_torque") = py::none(),
      "A whole gear of the family by size (25: that of parameters, 5 ... 100) and ratio (circular spline held, 30 ... "
      "320), as the tool's gear (docs/own_gear.md). parameters: Parameters of HFUS-25-2SH, ratio 100, or a variant. "
      "bore_radius and rim_thickness of the flexspline, face_width of the teeth: where they are known [m]. Of a "
      "catalogue of your own: "
      "stiffness K1, K2, K3 [N.m/rad], breakpoints T1, T2, ratings (rated, average, repeated peak, momentary peak), "
      "starting_torque, no_load_torque [N.m].\n\n"
      "Returns Parameters, all of the joint included, and a dict of the parameters that were derived: key to rule. "
      "ParameterError.");
  module.def(
      "gear_warnings",
      [](const Configuration& parameters)
      { return withoutLock([&, values = parameters.values()] { return gearWarnings(values); }); },
      py::arg("parameters"),
      "What of the gear does not go with the rest, as the tool warns at the start: list of str, each with key, value "
      "and "
      "what it should be near.");
}

void bindStiffness(py::module& module)
{
  auto row = py::class_<StiffnessRow>(module, "StiffnessRow", "The gear under one load, wave generator locked.");
  row.def_readonly("torque", &StiffnessRow::torque, "load; > 0 turns the output backwards [N.m]")
      .def_readonly("output_angle", &StiffnessRow::output_angle, "relative to zero load [rad]")
      .def_readonly("wave_generator_torque", &StiffnessRow::wave_generator_torque,
                    "of the flexspline on the wave generator [N.m]")
      .def_readonly("housing_torque", &StiffnessRow::housing_torque, "of the housing on the flexspline [N.m]")
      .def_readonly("cup_rotation", &StiffnessRow::cup_rotation, "mean rotation of the teeth from rest [rad]")
      .def_readonly("teeth_loaded", &StiffnessRow::teeth_loaded, "[-]")
      .def_readonly("mesh_force_max", &StiffnessRow::mesh_force_max, "[N]")
      .def_readonly("wave_generator_force_sum", &StiffnessRow::wave_generator_force_sum, "[N]")
      .def_property_readonly(
          "residual", [](const StiffnessRow& self) { return self.status.residual; },
          "largest out-of-balance force on a tooth [N]")
      .def_readonly("stress", &StiffnessRow::stress, "nominal, without the notch: ToothStress")
      .def_readonly("teeth", &StiffnessRow::teeth, "ToothTable");
  addArray(row, "ball_force", &StiffnessRow::ball_force,
           "of each ball of the bearing, shape (balls,); empty unless contact.support = single_balls [N]");
  addText(row);
  module.def(
      "analyse_stiffness", &stiffness, py::arg("parameters"), py::arg("torques"), py::arg("angle") = 0.0,
      "Torsion under load, wave generator locked at angle [rad], friction left out: list of StiffnessRow, one for "
      "each of the torques, loads on the circular spline [N.m]. NotConverged.");
  module.def(
      "endurance_share",
      [](const Configuration& parameters, const std::string& place, const StressCycle& cycle) {
        return FatigueLaw(parameters.values().life, parameters.values().stress)
            .enduranceShare(stressPlace(place), cycle);
      },
      py::arg("parameters"), py::arg("place"), py::arg("cycle"),
      "Share of the endurance limit that a StressCycle uses at the notch of 'tooth space', 'transition' or 'flange', "
      "by "
      "Goodman and Peterson [-] (docs/life.md): float.");
}

void bindSlowMotion(py::module& module)
{
  PYBIND11_NUMPY_DTYPE(TurnValues, wave_generator_angle, output_angle, kinematic_error, wave_generator_torque,
                       housing_torque);
  PYBIND11_NUMPY_DTYPE(LossValues, motor_speed, load_torque, load_reduced, bearing, interface, flexing, mesh, cup,
                       damping, output, motor, gear_loss, gear_efficiency);
  module.def("analyse_turn", &turn, py::arg("parameters"), py::arg("load"), py::arg("angle_range"), py::arg("steps"),
             "Quasi-static turning from 0 to angle_range [rad] at a constant load [N.m], friction left out.\n\n"
             "Returns a structured array of shape (steps + 1,): wave_generator_angle, output_angle, kinematic_error "
             "[rad], wave_generator_torque, housing_torque [N.m]. NotConverged.");
  module.def(
      "analyse_losses", &losses, py::arg("parameters"), py::arg("speeds"), py::arg("loads"), py::arg("positions") = 16,
      "Friction and efficiency of steady turning at motor speeds [rad/s] against loads [N.m]; positions: wave "
      "generator angles per tooth pitch.\n\n"
      "Returns a structured array of shape (loads, speeds): motor_speed [rad/s], load_torque, load_reduced [N.m]; "
      "bearing, interface, flexing, mesh, cup, damping, output, motor, gear_loss: torques at the motor shaft "
      "[N.m]; gear_efficiency [-]. NotConverged.");

  auto result = py::class_<Breakaway>(module, "Breakaway",
                                      "Torques at which the gear without its motor's friction begins to move.");
  result.def_readonly("starting", &Breakaway::starting, "at the wave generator, no load [N.m]")
      .def_readonly("back_driving", &Breakaway::back_driving, "at the output, wave generator free [N.m]");
  addText(result);
  module.def("analyse_breakaway", &breakaway, py::arg("parameters"), py::arg("positions") = 16,
             "Torques at which the gear begins to move: Breakaway. NotConverged.");

  auto loop = py::class_<TorsionLoop>(module, "TorsionLoop", "Torsion to and fro with the friction of the teeth.");
  loop.def_property_readonly("torque", &pointsOf<&TorsionPoint::torque>,
                             "loads, from +amplitude to -amplitude and back, shape (points,) [N.m]")
      .def_property_readonly("output_angle", &pointsOf<&TorsionPoint::output_angle>,
                             "from the place without load, > 0 with the load, shape (points,) [rad]")
      .def_readonly("hysteresis", &TorsionLoop::hysteresis, "width of the loop at no load [rad]")
      .def_readonly("lost_motion", &TorsionLoop::lost_motion,
                    "between the middles of the loop at plus and minus the lost motion torque [rad]");
  addText(loop);
  module.def("analyse_torsion_loop", &torsionLoop, py::arg("parameters"), py::arg("amplitude"),
             py::arg("lost_motion_torque"), py::arg("steps") = 200,
             "Wave generator locked, load swept slowly between plus and minus amplitude [N.m]; steps: of a sweep; "
             "lost_motion_torque: e.g. 4 % of the rated torque [N.m]. Returns TorsionLoop. NotConverged.");
}

template <std::size_t PLACE>
py::array_t<double> stressView(const py::object& self)
{
  return viewOf(self.cast<const ToothStress&>().normal[PLACE], self);
}
}  // namespace

void bindStatics(py::module& module)
{
  bindTeeth(module);
  bindInsertion(module);
  bindDesign(module);
  bindStiffness(module);
  bindSlowMotion(module);
}

void bindToothValues(py::module& module)
{
  auto forces = py::class_<ToothForces, std::shared_ptr<ToothForces>>(
      module, "ToothForces",
      "Forces on every tooth of the flexspline at one instant, as ContactForces.msg. Arrays of shape (teeth,), "
      "index = tooth, counter-clockwise from the flexspline's x axis. They are views of the twin's memory: the next "
      "call of Twin.tooth_forces() overwrites them; copy() keeps them.");
  addArray(forces, "wave_generator_force", &ToothForces::wave_generator_force,
           "normal force of the wave generator on the flexspline, >= 0 [N]");
  addArray(forces, "rim_tension", &ToothForces::rim_tension, "tension to the next tooth, pull > 0 [N]");
  addArray(forces, "bending_force", &ToothForces::bending_force,
           "restoring force of the bending couple of the segment to the next tooth [N]");
  addArray(forces, "mesh_force", &ToothForces::mesh_force,
           "normal force of the circular spline on the flank; > 0 leading, < 0 trailing flank [N]");
  addArray(forces, "tooth_x", &ToothForces::tooth_x, "of the tooth point on the inner rim [m]");
  addArray(forces, "tooth_y", &ToothForces::tooth_y, "of the tooth point on the inner rim [m]");
  forces.def(
      "copy", [](const ToothForces& self) { return std::make_shared<ToothForces>(self); },
      "The same values in memory of their own: ToothForces.");
  addText(forces);

  auto cycle = py::class_<StressCycle>(
      module, "StressCycle",
      "What one place of the flexspline goes through in a turn of the wave generator, nominal: without the notch.");
  cycle.def_readonly("lowest", &StressCycle::lowest, "normal stress [Pa]")
      .def_readonly("highest", &StressCycle::highest, "normal stress [Pa]")
      .def_readonly("shear", &StressCycle::shear, "constant over the turn [Pa]")
      .def_property_readonly("amplitude", &StressCycle::amplitude, "half of highest less lowest [Pa]")
      .def_property_readonly("mean", &StressCycle::mean, "mean of highest and lowest [Pa]")
      .def_property_readonly("largest", &StressCycle::largest, "largest equivalent stress after von Mises [Pa]");
  addText(cycle);

  auto stress = py::class_<ToothStress, std::shared_ptr<ToothStress>>(
      module, "ToothStress",
      "Nominal stress of the flexspline, without the notch, as Stress.msg. Arrays of shape (teeth,) are views: those "
      "of "
      "a twin are overwritten by the next call of Twin.tooth_stress(); copy() keeps them.");
  stress
      .def_property_readonly("tooth_space", &stressView<0>,
                             "normal stress around the rim in the spaces beside each tooth [Pa]")
      .def_property_readonly("transition", &stressView<1>, "along the axis where the toothed rim ends [Pa]")
      .def_property_readonly("flange", &stressView<2>, "along the axis where the cup is held [Pa]")
      .def_property_readonly(
          "shear", [](const ToothStress& self) { return py::tuple(py::cast(self.shear)); },
          "by place, the same all around [Pa]: tuple of 3, in the order tooth space, transition, flange")
      .def(
          "cycle", [](const ToothStress& self, const std::string& place) { return self.cycle(stressPlace(place)); },
          py::arg("place"),
          "What one tooth goes through in a turn, all teeth being alike: StressCycle. place: 'tooth space', "
          "'transition' or 'flange'. At the notch it is larger by stress.concentration.")
      .def(
          "worst_tooth",
          [](const ToothStress& self, const std::string& place) { return self.worstTooth(stressPlace(place)); },
          py::arg("place"), "Where the normal stress is largest in magnitude: int.")
      .def(
          "copy", [](const ToothStress& self) { return std::make_shared<ToothStress>(self); },
          "The same values in memory of their own: ToothStress.");
  addText(stress);
}
}  // namespace hjt
