// SPDX-License-Identifier: BSD-3-Clause
#include <pybind11/stl.h>

#include <cmath>
#include <memory>
#include <optional>

#include "base/number_text.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "python/twin_object.hpp"

namespace hjt
{
namespace
{
constexpr double LARGEST_TIME = 9e9;  // largest magnitude of a stamp [s]

/// Checks a stamp. @throws InputError if the magnitude of the stamp exceeds MAX_STAMP.
Stamp checked(Stamp stamp)
{
  if (!isStamp(stamp))
  {
    throw InputError("stamp = " + std::to_string(stamp) + " [ns] is out of range, allowed: " +
                     std::to_string(-MAX_STAMP) + " ... " + std::to_string(MAX_STAMP) + " [ns]");
  }
  return stamp;
}

/// Stamp of an input: the given stamp or, without one, the next instant of the twin.
Stamp stampOf(const Twin& twin, const std::optional<Stamp>& stamp)
{
  return checked(stamp.value_or(twin.stamp()));
}

void push(TwinObject& self, InputKind kind, double value, const std::optional<Stamp>& stamp, const char* name)
{
  requireInput(kind, value, self.parameters().values().output.load_torque_limit, [&] { return std::string(name); });
  self.twin().push({ stampOf(self.twin(), stamp), kind, value });
}

void injectFault(TwinObject& self, const py::object& given, const std::optional<Stamp>& stamp)
{
  const Fault fault = faultOf(given, self.parameters().values());
  self.twin().injectFault(stampOf(self.twin(), stamp), fault);
}

StepRows runTo(TwinObject& self, double time, const GivenInputs& given, py::ssize_t every, const py::object& out,
               const py::object& progress)
{
  const Twin& twin = self.twin();
  if (!(std::abs(time) <= LARGEST_TIME) || toStampLength(std::max(time, 0.0)) < twin.stamp())
  {
    throw InputError("time = " + numberText(time) + " [s] is out of range, allowed: " +
                     numberText(toSeconds(twin.stamp())) + " (the present instant) ... 9e9 [s]");
  }
  const Stamp steps = (toStampLength(time) - twin.stamp()) / twin.stepLength();
  return self.run(py::ssize_t{ steps }, given, every, out, progress);
}

std::unique_ptr<TwinObject> copyOf(TwinObject& self)
{
  return std::make_unique<TwinObject>(self.twin(), self.parameters());
}

py::list activeFaults(TwinObject& self)
{
  py::list faults;
  for (const ActiveFault& active : self.twin().activeFaults())
  {
    faults.append(active.fault);
  }
  return faults;
}

py::object lastRow(TwinObject& self)
{
  StepRows rows(1);
  *rows.mutable_data() = rowOf(self.twin());
  return rows[py::int_(0)];
}

void bindInputs(py::class_<TwinObject>& twin)
{
  const auto stamp = py::arg("stamp") = py::none();
  twin.def(
          "command_motor_torque",
          [](TwinObject& self, double torque, const std::optional<Stamp>& at)
          { push(self, InputKind::MOTOR_TORQUE, torque, at, "torque"); },
          py::arg("torque"), stamp,
          "Commands the motor torque from stamp on [N.m]; the torque becomes zero after input.command_timeout. "
          "stamp [ns]: None is the next step. An input in the past acts at once and is counted as late.")
      .def(
          "command_load_torque",
          [](TwinObject& self, double torque, const std::optional<Stamp>& at)
          { push(self, InputKind::LOAD_TORQUE, torque, at, "torque"); },
          py::arg("torque"), stamp,
          "Sets the external torque at the output, within output.load_torque_limit; > 0 resists positive motion [N.m].")
      .def(
          "command_brake",
          [](TwinObject& self, bool engaged, const std::optional<Stamp>& at)
          { push(self, InputKind::BRAKE, engaged ? 1.0 : 0.0, at, "engaged"); },
          py::arg("engaged"), stamp, "Engages (True) or releases the brake. The brake acts brake.delay after stamp.")
      .def(
          "set_temperature",
          [](TwinObject& self, double degrees, const std::optional<Stamp>& at)
          { push(self, InputKind::TEMPERATURE, degrees, at, "degrees"); },
          py::arg("degrees"), stamp,
          "Sets the temperature of the drive, or of its surroundings with thermal.model = two_nodes [degC], -40 ... "
          "150.")
      .def("inject_fault", &injectFault, py::arg("fault"), stamp,
           "Injects a Fault or its text 'KIND:SEVERITY[:PLACE[:ONSET]]'. The fault begins at stamp + onset. Severity 0 "
           "removes the fault. While a fault acts that did not act at the start, each step solves all teeth. Raises "
           "ParameterError.");
}

void bindMarch(py::class_<TwinObject>& twin)
{
  const auto none = [](const char* name) { return py::arg(name) = py::none(); };
  twin.def(
          "step", [](TwinObject& self) { self.run(1, {}, 2); }, "Advances by one step of 1 / solver.rate.")
      .def(
          "run",
          [](TwinObject& self, const std::optional<py::ssize_t>& steps, const py::object& motor_torque,
             const py::object& load_torque, const py::object& brake, const py::object& temperature, py::ssize_t every,
             const py::object& out, const py::object& progress) {
            return self.run(steps, { motor_torque, load_torque, brake, temperature }, every, out, progress);
          },
          none("steps"), none("motor_torque"), none("load_torque"), none("brake"), none("temperature"),
          py::arg("every") = 1, none("out"), none("progress"),
          "Advances by a block of steps without the interpreter's lock. Ctrl-C ends the call; the twin stays at the "
          "step that it had reached.\n\n"
          "steps: number of steps; None: the length of the arrays. motor_torque [N.m], clamped to motor.torque_limit "
          "and counted; load_torque [N.m], within output.load_torque_limit; brake (0 or 1); temperature [degC], -40 "
          "... 150: a number, or an array of shape (steps,) with the value of each step; None: the value that was "
          "commanded before. A given torque does not time out during the run. every: number of steps between two rows. "
          "out: array of an earlier run that is overwritten; None: a new array. progress: called with 0 ... 1, at most "
          "twenty times a second and at the end.\n\n"
          "Returns a structured array of shape (steps // every,) with dtype STEP_DTYPE. Raises InputError.")
      .def(
          "run_to",
          [](TwinObject& self, double time, const py::object& motor_torque, const py::object& load_torque,
             const py::object& brake, const py::object& temperature, py::ssize_t every, const py::object& out,
             const py::object& progress) {
            return runTo(self, time, { motor_torque, load_torque, brake, temperature }, every, out, progress);
          },
          py::arg("time"), none("motor_torque"), none("load_torque"), none("brake"), none("temperature"),
          py::arg("every") = 1, none("out"), none("progress"),
          "Advances as run does, up to the last instant that is not after time [s].");
}

void bindReadings(py::class_<TwinObject>& twin)
{
  twin.def_property_readonly(
          "stamp", [](TwinObject& self) { return self.twin().stamp(); }, "present instant [ns]")
      .def_property_readonly(
          "time", [](TwinObject& self) { return toSeconds(self.twin().stamp()); }, "present instant [s]")
      .def_property_readonly(
          "step_length", [](TwinObject& self) { return self.twin().stepLength(); }, "[ns]")
      .def_property_readonly("outputs", &lastRow,
                             "all outputs and readings of the present instant: one row of dtype STEP_DTYPE")
      .def_property_readonly(
          "on_surface", [](TwinObject& self) { return self.twin().onSurface(); },
          "whether the present instant was computed from the response surface instead of all teeth")
      .def_property_readonly(
          "counters", [](TwinObject& self) { return namedCounters(self.twin().counters()); },
          "counts of events since the last reset, by name: dict of str to int")
      .def_property_readonly("active_faults", &activeFaults,
                             "faults that act at the present instant: list of Fault, ordered by kind and place")
      .def_property_readonly(
          "parameters", [](const TwinObject& self) { return self.parameters(); },
          "Parameters that cannot be changed; set values in a copy and make a Twin of the copy")
      .def("tooth_forces", &TwinObject::toothForces,
           "Returns the forces on every tooth at the present instant as ToothForces, views that the next call "
           "overwrites. On the response surface this solves a full ring. Raises NotConverged.")
      .def("tooth_stress", &TwinObject::toothStress,
           "Returns the stress of the flexspline at every tooth at the present instant as ToothStress, views that the "
           "next call overwrites. Raises NotConverged.")
      .def(
          "health",
          [](TwinObject& self, const std::optional<Stamp>& since)
          { return self.twin().health(since.value_or(std::numeric_limits<Stamp>::min())); },
          py::arg("since") = py::none(),
          "Returns the Health at the present instant. solver_state covers the steps after since [ns]; None: all steps "
          "after the last reset.")
      .def_property(
          "watch_signals", [](TwinObject& self) { return self.twin().watchesSignals(); },
          [](TwinObject& self, bool on) { self.twin().watchSignals(on); },
          "whether indicators and assessment are computed from the sensors' readings; initially False")
      .def_property_readonly(
          "signal_indicators", [](TwinObject& self) { return self.twin().signalIndicators(); },
          "indicators of the last window: SignalIndicators")
      .def_property_readonly(
          "assessment", [](TwinObject& self) { return self.twin().assessment(); },
          "assessment of the drive by its indicators: Assessment");
}
}  // namespace

py::dict namedCounters(const TwinCounters& counters)
{
  py::dict named = stepCounters(counters);
  named["inputs_accepted"] = counters.input.accepted;
  named["inputs_late"] = counters.input.late;
  named["inputs_overflow"] = counters.input.overflow;
  named["faults_accepted"] = counters.faults.accepted;
  named["faults_late"] = counters.faults.late;
  named["faults_no_room"] = counters.faults.no_room;
  return named;
}

void bindTwin(py::module& module)
{
  PYBIND11_NUMPY_DTYPE(StepRow, stamp, time, motor_angle, motor_velocity, output_angle, output_velocity, motor_torque,
                       load_torque, temperature, housing_temperature, wave_generator_torque, joint_torque,
                       friction_torque, torsional_stiffness, energy_residual, dissipated_energy, released_energy,
                       residual, phase_advance, motor_angle_encoder, motor_velocity_encoder, output_angle_encoder,
                       output_velocity_encoder, motor_torque_reading, motor_count, output_count, iterations, substeps,
                       brake, converged, on_surface);
  module.attr("STEP_DTYPE") = py::dtype::of<StepRow>();

  py::class_<TwinObject> twin(
      module, "Twin",
      "Twin of a joint: torques are its inputs; encoder angles, tooth forces and health are its outputs.\n\n"
      "Twin(parameters, cache=None, progress=None) inserts the wave generator; with solver.scene = auto it builds the "
      "response surface (seconds) or reads it from the cache. parameters: Parameters, copied. cache: directory of "
      "response surfaces; None: that of the tool, '': none. progress: called with 0 ... 1 during a build. "
      "Raises ParameterError.\n\n"
      "All steps have equal length. Equal inputs give equal numbers, step by step or in blocks, here, in the tool and "
      "in the node. Only one thread at a time may use a twin; several twins may run in different threads.");
  twin.def(py::init<const Configuration&, const std::optional<std::string>&, const py::object&>(),
           py::arg("parameters"), py::arg("cache") = py::none(), py::arg("progress") = py::none())
      .def(
          "reset", [](TwinObject& self, Stamp stamp) { self.twin().reset(checked(stamp)); }, py::arg("stamp") = 0,
          "Restarts at rest with angles 0 and the configured faults, at the first instant that is not before stamp "
          "[ns].")
      .def("__copy__", &copyOf,
           "Returns a copy at the same instant, with waiting inputs and learned references. Twin and copy give equal "
           "numbers.")
      .def(
          "__deepcopy__", [](TwinObject& self, const py::dict&) { return copyOf(self); }, py::arg("memo"),
          "Returns a copy, as copy.copy does.")
      .def(
          "__reduce__",
          [](TwinObject&) -> py::object
          {
            throw py::type_error(
                "a Twin cannot be pickled; copy.copy(twin) copies its state within this process; for another process "
                "pickle twin.parameters");
          },
          "Raises TypeError, because the state of a twin cannot leave its process.")
      .def("__repr__",
           [](TwinObject& self)
           {
             return "<Twin of joint '" + self.parameters().values().joint.name + "' at " +
                    numberText(toSeconds(self.twin().stamp())) + " s>";
           });
  bindInputs(twin);
  bindMarch(twin);
  bindReadings(twin);
}
}  // namespace hjt
