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
/// Values at one position of the wave generator in a quasi-static turn.
struct TurnValues
{
  double wave_generator_angle;
  double output_angle;
  double kinematic_error;
  double wave_generator_torque;
  double housing_torque;
};

/// Losses at one speed and load. The fields have the names of `joint_twin losses --json`.
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
/// Adds to a Python class a property: an array that is a view of the vector `values`.
template <class Class, class Values>
void addArray(Class& type, const char* name, std::vector<double> Values::*values, const char* meaning)
{
  type.def_property_readonly(
      name, [values](const py::object& self) { return viewOf(self.cast<const Values&>().*values, self); }, meaning);
}

/// Index of the place of a stress by its name. @throws InputError for an unknown name.
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

/// Parameters for an analysis. @throws ParameterError if a configured fault has no effect in this analysis.
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
                                      "Values of every tooth in one equilibrium: arrays of shape (teeth,), index = "
                                      "tooth. The arrays are views of the result's memory and keep it alive.");
  addArray(teeth, "tooth_x", &ToothTable::tooth_x, "x of the tooth point [m]");
  addArray(teeth, "tooth_y", &ToothTable::tooth_y, "y of the tooth point [m]");
  addArray(teeth, "radius", &ToothTable::radius, "distance of the tooth point from the axis [m]");
  addArray(teeth, "angle_deviation", &ToothTable::angle_deviation,
           "angle of the tooth point minus its angle at rest [rad]");
  addArray(teeth, "wave_generator_force", &ToothTable::wave_generator_force, "force of the wave generator [N]");
  addArray(teeth, "rim_tension", &ToothTable::rim_tension, "tension of the rim to the next tooth [N]");
  addArray(teeth, "bending_force", &ToothTable::bending_force, "bending force of the segment to the next tooth [N]");
  addArray(teeth, "mesh_force", &ToothTable::mesh_force,
           "normal force on the flank, > 0 leading, < 0 trailing flank [N]");
  addArray(teeth, "stress_tooth_space", &ToothTable::stress_tooth_space,
           "nominal normal stress in the tooth space [Pa]");
  addArray(teeth, "stress_transition", &ToothTable::stress_transition,
           "nominal normal stress where the rim meets the cup [Pa]");
  addArray(teeth, "stress_flange", &ToothTable::stress_flange, "nominal normal stress at the flange [Pa]");
  addArray(teeth, "across", &ToothTable::across,
           "position of the tooth across its space; empty without circular spline [m]");
  addArray(teeth, "depth", &ToothTable::depth, "depth of the tooth in its space; empty without circular spline [m]");
  addArray(teeth, "tilt", &ToothTable::tilt,
           "angle of the tooth against the axis of the space; empty without circular spline [rad]");
  addArray(teeth, "gap", &ToothTable::gap,
           "distance from the tooth to the nearer flank; empty without circular spline [m]");
  addText(teeth);
}

void bindInsertion(py::module& module)
{
  auto result = py::class_<InsertionResult>(
      module, "InsertionResult", "Equilibrium after the wave generator's insertion, without circular spline.");
  result.def_readonly("wave_generator_force_max", &InsertionResult::wave_generator_force_max, "[N]")
      .def_readonly("wave_generator_force_min", &InsertionResult::wave_generator_force_min, "[N]")
      .def_readonly("wave_generator_force_sum", &InsertionResult::wave_generator_force_sum, "[N]")
      .def_readonly("teeth_in_contact", &InsertionResult::teeth_in_contact,
                    "number of teeth in contact with the wave generator [-]")
      .def_readonly("tension_min", &InsertionResult::tension_min, "least tension of the rim [N]")
      .def_readonly("tension_max", &InsertionResult::tension_max, "largest tension of the rim [N]")
      .def_readonly("radius_major_axis", &InsertionResult::radius_major_axis,
                    "distance of tooth 0 from the axis of the drive [m]")
      .def_readonly("radius_minor_axis", &InsertionResult::radius_minor_axis,
                    "distance of tooth N/4, of N teeth, from the axis of the drive [m]")
      .def_readonly("bending_force_max", &InsertionResult::bending_force_max, "[N]")
      .def_readonly("teeth", &InsertionResult::teeth, "ToothTable");
  addText(result);
  module.def("analyse_insertion", &insertion, py::arg("parameters"),
             "Computes the static equilibrium after the insertion, without circular spline. Returns InsertionResult. "
             "Raises NotConverged.");

  auto check = py::class_<FitCheck>(module, "FitCheck", "Check whether the teeth fit into each other without load.");
  check.def_readonly("teeth_loaded", &FitCheck::teeth_loaded, "number of teeth that carry mesh force without load [-]")
      .def_readonly("wave_generator_force", &FitCheck::wave_generator_force,
                    "sum of the wave generator's forces over the teeth, without load [N]")
      .def_readonly("wave_generator_force_insertion", &FitCheck::wave_generator_force_insertion,
                    "sum of the wave generator's forces over the teeth, without circular spline [N]")
      .def_property_readonly("jams", &FitCheck::jams,
                             "whether the teeth load the wave generator more than the bent rim does");
  addText(check);
  module.def("check_fit", &fit, py::arg("parameters"),
             "Checks whether the teeth fit into each other without load. Use this check after each change of a gear. "
             "Returns FitCheck. Raises NotConverged.");
}

/// Parameters of the designed gear, and for each derived parameter the rule that gave its value.
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
      "Designs a gear by size (5 ... 100) and ratio with the circular spline held (30 ... 320), as `joint_twin gear` "
      "does (docs/own_gear.md). parameters: Parameters of HFUS-25-2SH (size 25, ratio 100), or of a variant. "
      "bore_radius and rim_thickness of the flexspline, face_width of the teeth [m], if known. From your catalogue: "
      "stiffness K1, K2, K3 [N.m/rad], breakpoints T1, T2, ratings (rated, average, repeated peak, momentary peak), "
      "starting_torque, no_load_torque [N.m].\n\n"
      "Returns Parameters of the whole joint and a dict of the derived parameters: key to rule. Raises "
      "ParameterError.");
  module.def(
      "gear_warnings",
      [](const Configuration& parameters)
      { return withoutLock([&, values = parameters.values()] { return gearWarnings(values); }); },
      py::arg("parameters"),
      "Returns the tool's warnings about inconsistent values of the gear: list of str, each with key, value and "
      "expected value.");
}

void bindStiffness(py::module& module)
{
  auto row =
      py::class_<StiffnessRow>(module, "StiffnessRow", "State of the gear under a load with locked wave generator.");
  row.def_readonly("torque", &StiffnessRow::torque,
                   "load on the circular spline; > 0 turns the output towards negative angles [N.m]")
      .def_readonly("output_angle", &StiffnessRow::output_angle, "angle of the output relative to zero load [rad]")
      .def_readonly("wave_generator_torque", &StiffnessRow::wave_generator_torque,
                    "torque of the flexspline on the wave generator [N.m]")
      .def_readonly("housing_torque", &StiffnessRow::housing_torque, "torque of the housing on the flexspline [N.m]")
      .def_readonly("cup_rotation", &StiffnessRow::cup_rotation, "mean rotation of the teeth from rest [rad]")
      .def_readonly("teeth_loaded", &StiffnessRow::teeth_loaded, "[-]")
      .def_readonly("mesh_force_max", &StiffnessRow::mesh_force_max, "[N]")
      .def_readonly("wave_generator_force_sum", &StiffnessRow::wave_generator_force_sum, "[N]")
      .def_property_readonly(
          "residual", [](const StiffnessRow& self) { return self.status.residual; },
          "largest out-of-balance force on a tooth [N]")
      .def_readonly("stress", &StiffnessRow::stress, "nominal stresses without notch factor: ToothStress")
      .def_readonly("teeth", &StiffnessRow::teeth, "ToothTable");
  addArray(row, "ball_force", &StiffnessRow::ball_force,
           "force on each ball of the bearing, shape (balls,); empty unless contact.support = single_balls [N]");
  addText(row);
  module.def("analyse_stiffness", &stiffness, py::arg("parameters"), py::arg("torques"), py::arg("angle") = 0.0,
             "Computes the torsion under load without friction. The wave generator is locked at angle [rad]; torques "
             "are loads on the circular spline [N.m]. Returns a list of StiffnessRow, one for each torque. Raises "
             "NotConverged.");
  module.def(
      "endurance_share",
      [](const Configuration& parameters, const std::string& place, const StressCycle& cycle) {
        return FatigueLaw(parameters.values().life, parameters.values().stress)
            .enduranceShare(stressPlace(place), cycle);
      },
      py::arg("parameters"), py::arg("place"), py::arg("cycle"),
      "Returns the equivalent amplitude of a StressCycle over the endurance limit [-], by Goodman and Peterson "
      "(docs/life.md): float. place of the notch: 'tooth space', 'transition' or 'flange'.");
}

void bindSlowMotion(py::module& module)
{
  PYBIND11_NUMPY_DTYPE(TurnValues, wave_generator_angle, output_angle, kinematic_error, wave_generator_torque,
                       housing_torque);
  PYBIND11_NUMPY_DTYPE(LossValues, motor_speed, load_torque, load_reduced, bearing, interface, flexing, mesh, cup,
                       damping, output, motor, gear_loss, gear_efficiency);
  module.def(
      "analyse_turn", &turn, py::arg("parameters"), py::arg("load"), py::arg("angle_range"), py::arg("steps"),
      "Turns the wave generator quasi-statically from 0 to angle_range [rad] under a constant load [N.m], without "
      "friction.\n\n"
      "Returns a structured array of shape (steps + 1,): wave_generator_angle, output_angle, kinematic_error "
      "[rad], wave_generator_torque, housing_torque [N.m]. Raises NotConverged.");
  module.def(
      "analyse_losses", &losses, py::arg("parameters"), py::arg("speeds"), py::arg("loads"), py::arg("positions") = 16,
      "Computes friction and efficiency at constant motor speeds [rad/s] and loads [N.m]; positions: number of wave "
      "generator angles per tooth pitch, over which torques are averaged.\n\n"
      "Returns a structured array of shape (loads, speeds): motor_speed [rad/s], load_torque, load_reduced [N.m]; "
      "bearing, interface, flexing, mesh, cup, damping, output, motor, gear_loss: torques at the motor shaft "
      "[N.m]; gear_efficiency [-]. Raises NotConverged.");

  auto result = py::class_<Breakaway>(module, "Breakaway",
                                      "Torques at which the gear begins to move, without friction of the motor.");
  result.def_readonly("starting", &Breakaway::starting, "torque at the wave generator, without load [N.m]")
      .def_readonly("back_driving", &Breakaway::back_driving, "load at the output, with the wave generator free [N.m]");
  addText(result);
  module.def("analyse_breakaway", &breakaway, py::arg("parameters"), py::arg("positions") = 16,
             "Computes the torques at which the gear begins to move. Returns Breakaway. Raises NotConverged.");

  auto loop =
      py::class_<TorsionLoop>(module, "TorsionLoop", "Torsion under a cycling load, with the friction of the teeth.");
  loop.def_property_readonly("torque", &pointsOf<&TorsionPoint::torque>,
                             "loads, from +amplitude to -amplitude and back, shape (points,) [N.m]")
      .def_property_readonly(
          "output_angle", &pointsOf<&TorsionPoint::output_angle>,
          "output angles relative to the position without load, > 0 in the load's direction, shape (points,) [rad]")
      .def_readonly("hysteresis", &TorsionLoop::hysteresis, "width of the loop at zero load [rad]")
      .def_readonly("lost_motion", &TorsionLoop::lost_motion,
                    "angle between the middles of the loop at + and - lost_motion_torque [rad]");
  addText(loop);
  module.def(
      "analyse_torsion_loop", &torsionLoop, py::arg("parameters"), py::arg("amplitude"), py::arg("lost_motion_torque"),
      py::arg("steps") = 200,
      "Computes the torsion with locked wave generator for a load that cycles slowly between plus and minus amplitude "
      "[N.m]. steps: number of angles from one end of the cycle to the other. lost_motion_torque: load at which the "
      "lost motion is measured, for example 4 % of the rated torque [N.m]. Returns TorsionLoop. Raises NotConverged.");
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
      "Forces on every tooth of the flexspline at one instant, as in ContactForces.msg: arrays of shape (teeth,), "
      "index = tooth, counter-clockwise from the flexspline's x axis. The arrays are views of the twin's memory: the "
      "next call of Twin.tooth_forces() overwrites them. copy() returns arrays that stay.");
  addArray(forces, "wave_generator_force", &ToothForces::wave_generator_force,
           "normal force of the wave generator on the flexspline, >= 0 [N]");
  addArray(forces, "rim_tension", &ToothForces::rim_tension, "tension of the rim to the next tooth; > 0 pulls [N]");
  addArray(forces, "bending_force", &ToothForces::bending_force,
           "restoring force of the bending couple of the segment to the next tooth [N]");
  addArray(forces, "mesh_force", &ToothForces::mesh_force,
           "normal force of the circular spline on the flank; > 0 leading, < 0 trailing flank [N]");
  addArray(forces, "tooth_x", &ToothForces::tooth_x, "x of the tooth point on the inner rim [m]");
  addArray(forces, "tooth_y", &ToothForces::tooth_y, "y of the tooth point on the inner rim [m]");
  forces.def(
      "copy", [](const ToothForces& self) { return std::make_shared<ToothForces>(self); },
      "Returns ToothForces with equal values in separate memory.");
  addText(forces);

  auto cycle = py::class_<StressCycle>(
      module, "StressCycle",
      "Nominal stress (without notch factor) at one place of the flexspline over a turn of the wave generator.");
  cycle.def_readonly("lowest", &StressCycle::lowest, "least normal stress [Pa]")
      .def_readonly("highest", &StressCycle::highest, "largest normal stress [Pa]")
      .def_readonly("shear", &StressCycle::shear, "shear stress, constant over the turn [Pa]")
      .def_property_readonly("amplitude", &StressCycle::amplitude, "half of the difference highest - lowest [Pa]")
      .def_property_readonly("mean", &StressCycle::mean, "mean of highest and lowest [Pa]")
      .def_property_readonly("largest", &StressCycle::largest, "largest equivalent stress by von Mises [Pa]");
  addText(cycle);

  auto stress = py::class_<ToothStress, std::shared_ptr<ToothStress>>(
      module, "ToothStress",
      "Nominal stress of the flexspline (without notch factor), as in Stress.msg: arrays of shape (teeth,). The arrays "
      "are views of memory that the next call of Twin.tooth_stress() overwrites. copy() returns arrays that stay.");
  stress
      .def_property_readonly("tooth_space", &stressView<0>,
                             "normal stress around the rim in the spaces beside each tooth [Pa]")
      .def_property_readonly("transition", &stressView<1>,
                             "normal stress along the axis, at the end of the toothed rim [Pa]")
      .def_property_readonly("flange", &stressView<2>, "normal stress along the axis, at the flange of the cup [Pa]")
      .def_property_readonly(
          "shear", [](const ToothStress& self) { return py::tuple(py::cast(self.shear)); },
          "shear stress at each place, constant around the circumference [Pa]: tuple of 3, for tooth space, "
          "transition, flange")
      .def(
          "cycle", [](const ToothStress& self, const std::string& place) { return self.cycle(stressPlace(place)); },
          py::arg("place"),
          "Returns the StressCycle of one tooth over a turn of the motor, for equal teeth. place: 'tooth space', "
          "'transition' or 'flange'. The stress at the notch is larger by the factor stress.concentration.")
      .def(
          "worst_tooth",
          [](const ToothStress& self, const std::string& place) { return self.worstTooth(stressPlace(place)); },
          py::arg("place"), "Returns the tooth with the largest magnitude of the normal stress: int.")
      .def(
          "copy", [](const ToothStress& self) { return std::make_shared<ToothStress>(self); },
          "Returns ToothStress with equal values in separate memory.");
  addText(stress);
}
}  // namespace hjt
