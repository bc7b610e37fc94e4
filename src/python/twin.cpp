// SPDX-License-Identifier: BSD-3-Clause
#include <pybind11/stl.h>

#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "base/number_text.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "python/configuration.hpp"
#include "python/in_use.hpp"
#include "python/surface_source.hpp"
#include "python/tooth_values.hpp"

namespace hjt
{
/// One row of a run: all outputs and readings of an instant. Names as in the columns of `joint_twin simulate`.
struct StepRow
{
  std::int64_t stamp;
  double time;
  double motor_angle;
  double motor_velocity;
  double output_angle;
  double output_velocity;
  double motor_torque;
  double load_torque;
  double temperature;
  double housing_temperature;
  double wave_generator_torque;
  double joint_torque;
  double friction_torque;
  double torsional_stiffness;
  double energy_residual;
  double dissipated_energy;
  double released_energy;
  double residual;
  double phase_advance;
  double motor_angle_encoder;
  double motor_velocity_encoder;
  double output_angle_encoder;
  double output_velocity_encoder;
  double motor_torque_reading;
  std::int64_t motor_count;
  std::uint32_t output_count;
  std::uint32_t iterations;
  std::uint32_t substeps;
  bool brake;
  bool converged;
  bool on_surface;
};

namespace
{
constexpr double LARGEST_TIME = 9e9;  // that a stamp can hold [s]

void fill(const Twin& twin, StepRow& row) noexcept
{
  const JointOutputs& o = twin.outputs();
  const EncoderReadings e = twin.encoders();
  row = { o.stamp,
          toSeconds(o.stamp),
          o.motor_angle,
          o.motor_velocity,
          o.output_angle,
          o.output_velocity,
          o.motor_torque,
          o.load_torque,
          o.temperature,
          o.housing_temperature,
          o.wave_generator_torque,
          o.joint_torque,
          o.friction_torque,
          o.torsional_stiffness,
          o.energy_residual,
          o.dissipated_energy,
          o.released_energy,
          o.residual,
          o.phase_advance,
          e.motor_angle,
          e.motor_velocity,
          e.output_angle,
          e.output_velocity,
          twin.motorTorqueReading(),
          e.motor_count,
          e.output_count,
          o.iterations,
          o.substeps,
          o.brake_engaged,
          o.converged,
          twin.onSurface() };
}

/// An input of a run: none, a number for all steps, or an array with one for each.
class InputColumn
{
public:
  /// `steps`: empty, and set by the first array. @throws InputError.
  InputColumn(InputKind kind, const char* name, const py::object& given, std::optional<py::ssize_t>& steps)
    : kind_(kind), given_(!given.is_none())
  {
    if (!given_)
    {
      return;
    }
    values_ = py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(given);
    if (!values_)
    {
      throw InputError(std::string(name) + " is neither a number nor an array of numbers");
    }
    const auto text = [&](py::ssize_t i)
    { return std::string(name) + (single() ? "" : "[" + std::to_string(i) + "]"); };
    if (values_.ndim() > 1)
    {
      throw InputError(std::string(name) + " has " + std::to_string(values_.ndim()) +
                       " dimensions, allowed: a number, or an array of shape (steps,)");
    }
    if (!single() && values_.size() != steps.value_or(values_.size()))
    {
      throw InputError(std::string(name) + " has " + std::to_string(values_.size()) + " values for " +
                       std::to_string(*steps) + " steps");
    }
    for (py::ssize_t i = 0; i < values_.size(); ++i)
    {
      if (!std::isfinite(values_.data()[i]))
      {
        throw InputError(text(i) + " = " + numberText(values_.data()[i]) + " is not a finite number");
      }
    }
    if (!single())
    {
      steps = values_.size();
    }
    data_ = values_.data();
    stride_ = single() ? 0 : 1;
  }

  bool given() const { return given_; }

  /// Only the motor's torque times out and is commanded at every step; a brake commanded again would wait again.
  void push(Twin& twin, Stamp stamp, py::ssize_t step) noexcept
  {
    const double value = data_[stride_ * step];
    if (kind_ == InputKind::MOTOR_TORQUE || step == 0 || value != last_)
    {
      twin.push({ stamp, kind_, value, {} });
      last_ = value;
    }
  }

private:
  bool single() const { return values_.ndim() == 0; }

  InputKind kind_;
  bool given_;
  py::array_t<double, py::array::c_style | py::array::forcecast> values_;
  const double* data_{};
  py::ssize_t stride_{};
  double last_{};
};

/// What a run is given beside its steps.
struct RunInputs
{
  RunInputs(const py::object& motor_torque, const py::object& load_torque, const py::object& brake,
            const py::object& temperature, std::optional<py::ssize_t>& steps)
  {
    add(InputColumn(InputKind::MOTOR_TORQUE, "motor_torque", motor_torque, steps));
    add(InputColumn(InputKind::LOAD_TORQUE, "load_torque", load_torque, steps));
    add(InputColumn(InputKind::BRAKE, "brake", brake, steps));
    add(InputColumn(InputKind::TEMPERATURE, "temperature", temperature, steps));
  }

  std::vector<InputColumn> columns;

private:
  void add(InputColumn column)
  {
    if (column.given())
    {
      columns.push_back(std::move(column));
    }
  }
};

/// A twin, and the arrays of its teeth.
class TwinObject
{
public:
  TwinObject(const Configuration& parameters, const std::optional<std::string>& cache, const py::object& progress)
    : TwinObject(makeTwin(parameters.values(), cache, progress), parameters)
  {
  }

  TwinObject(Twin twin, const Configuration& parameters)
    : twin_(std::move(twin))
    , forces_(std::make_shared<ToothForces>(twin_.makeToothForces()))
    , stress_(std::make_shared<ToothStress>(parameters.values().gear.teeth_flexspline))
    , parameters_(parameters)
  {
  }

  /// @throws std::runtime_error while another thread runs it.
  Twin& twin()
  {
    in_use_.refuse();
    return twin_;
  }

  const Configuration& parameters() const { return parameters_; }

  py::array_t<StepRow> run(const std::optional<py::ssize_t>& given_steps, const py::object& motor_torque,
                           const py::object& load_torque, const py::object& brake, const py::object& temperature,
                           py::ssize_t every, const py::object& out)
  {
    std::optional<py::ssize_t> steps = given_steps;
    RunInputs inputs(motor_torque, load_torque, brake, temperature, steps);
    if (!steps)
    {
      throw InputError("steps is missing: give it, or an input as an array with a value for each step");
    }
    if (*steps < 0 || every < 1)
    {
      throw InputError("steps = " + std::to_string(*steps) + ", every = " + std::to_string(every) +
                       " [-] out of range, allowed: steps >= 0, every >= 1");
    }
    py::array_t<StepRow> rows = rowsFor(*steps / every, out);
    march(inputs, *steps, every, rows.mutable_data());
    return rows;
  }

  std::shared_ptr<ToothForces> toothForces()
  {
    if (!twin().toothForces(*forces_))
    {
      throw NotConverged("no equilibrium found for the teeth at this instant");
    }
    return forces_;
  }

  std::shared_ptr<ToothStress> toothStress()
  {
    if (!twin().toothStress(*stress_))
    {
      throw NotConverged("no equilibrium found for the teeth at this instant");
    }
    return stress_;
  }

private:
  /// The user's array, or a new one. @throws InputError.
  static py::array_t<StepRow> rowsFor(py::ssize_t count, const py::object& out)
  {
    if (out.is_none())
    {
      return py::array_t<StepRow>(count);
    }
    if (!py::isinstance<py::array_t<StepRow>>(out))
    {
      throw InputError("out must be an array of dtype STEP_DTYPE");
    }
    auto rows = py::reinterpret_borrow<py::array_t<StepRow>>(out);
    if (rows.ndim() == 1 && rows.strides(0) != py::ssize_t{ sizeof(StepRow) })
    {
      throw InputError("out must be contiguous");
    }
    if (rows.ndim() != 1 || rows.size() != count || !rows.writeable())
    {
      throw InputError("out has " + std::to_string(rows.size()) + " rows in " + std::to_string(rows.ndim()) +
                       " dimensions, expected: " + std::to_string(count) + " writable in one");
    }
    return rows;
  }

  static Twin makeTwin(Parameters parameters, const std::optional<std::string>& cache, const py::object& progress)
  {
    SurfaceSourceOf source(cache, progress);
    Twin twin = withoutLock([&] { return Twin(parameters, source.source()); });
    source.warn();
    return twin;
  }

  void march(RunInputs& inputs, py::ssize_t steps, py::ssize_t every, StepRow* row)
  {
    const InUse::Hold hold = in_use_.hold();
    const Stamp length = twin_.stepLength();
    withoutLock(
        [&]
        {
          InterruptCheck check;
          py::ssize_t until_row = every;
          for (py::ssize_t step = 0; step < steps; ++step)
          {
            const Stamp instant = twin_.stamp() + length;
            for (InputColumn& column : inputs.columns)
            {
              column.push(twin_, instant, step);
            }
            twin_.step(instant);
            if (--until_row == 0)
            {
              fill(twin_, *row++);
              until_row = every;
            }
            if (step % 64 == 63)
            {
              check();
            }
          }
        });
  }

  Twin twin_;
  std::shared_ptr<ToothForces> forces_;
  std::shared_ptr<ToothStress> stress_;
  Configuration parameters_;
  InUse in_use_{ "twin" };
};

/// @throws InputError beyond +-MAX_STAMP.
Stamp checked(Stamp stamp)
{
  if (!isStamp(stamp))
  {
    throw InputError("stamp = " + std::to_string(stamp) + " [ns] is out of range, allowed: " +
                     std::to_string(-MAX_STAMP) + " ... " + std::to_string(MAX_STAMP) + " [ns]");
  }
  return stamp;
}

/// Stamp of an input: given, or the twin's next instant.
Stamp stampOf(const Twin& twin, const std::optional<Stamp>& stamp)
{
  return checked(stamp.value_or(twin.stamp()));
}

void push(TwinObject& self, InputKind kind, double value, const std::optional<Stamp>& stamp, const char* name)
{
  if (!std::isfinite(value))
  {
    throw InputError(std::string(name) + " = " + numberText(value) + " is not a finite number");
  }
  self.twin().push({ stampOf(self.twin(), stamp), kind, value, {} });
}

void injectFault(TwinObject& self, const py::object& given, const std::optional<Stamp>& stamp)
{
  const Fault fault = faultOf(given, self.parameters().values());
  self.twin().injectFault(stampOf(self.twin(), stamp), fault);
}

py::array_t<StepRow> runTo(TwinObject& self, double time, const py::object& motor_torque, const py::object& load_torque,
                           const py::object& brake, const py::object& temperature, py::ssize_t every,
                           const py::object& out)
{
  const Twin& twin = self.twin();
  if (!(std::abs(time) <= LARGEST_TIME) || toStampLength(std::max(time, 0.0)) < twin.stamp())
  {
    throw InputError("time = " + numberText(time) + " [s] is out of range, allowed: " +
                     numberText(toSeconds(twin.stamp())) + " (the present instant) ... 9e9 [s]");
  }
  const Stamp steps = (toStampLength(time) - twin.stamp()) / twin.stepLength();
  return self.run(py::ssize_t{ steps }, motor_torque, load_torque, brake, temperature, every, out);
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

py::dict countersOf(TwinObject& self)
{
  const TwinCounters& counters = self.twin().counters();
  py::dict named;
  named["steps"] = counters.steps;
  named["solver_failures"] = counters.solver_failures;
  named["step_cuts"] = counters.step_cuts;
  named["jumps"] = counters.jumps;
  named["coarse_steps"] = counters.coarse_steps;
  named["inputs_accepted"] = counters.input.accepted;
  named["inputs_late"] = counters.input.late;
  named["inputs_overflow"] = counters.input.overflow;
  named["faults_accepted"] = counters.faults.accepted;
  named["faults_late"] = counters.faults.late;
  named["faults_no_room"] = counters.faults.no_room;
  named["torque_clamped"] = counters.torque_clamped;
  named["load_clamped"] = counters.load_clamped;
  named["overloads"] = counters.overloads;
  named["speed_limited"] = counters.speed_limited;
  named["command_timeouts"] = counters.command_timeouts;
  return named;
}

py::object lastRow(TwinObject& self)
{
  py::array_t<StepRow> rows(1);
  fill(self.twin(), *rows.mutable_data());
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
          "Motor torque from stamp on [N.m]; it falls back to zero after input.command_timeout. stamp [ns]: None is "
          "the "
          "next step; in the past it counts as late and acts at once.")
      .def(
          "command_load_torque",
          [](TwinObject& self, double torque, const std::optional<Stamp>& at)
          { push(self, InputKind::LOAD_TORQUE, torque, at, "torque"); },
          py::arg("torque"), stamp, "External torque at the output; > 0 resists positive motion [N.m].")
      .def(
          "command_brake",
          [](TwinObject& self, bool engaged, const std::optional<Stamp>& at)
          { push(self, InputKind::BRAKE, engaged ? 1.0 : 0.0, at, "engaged"); },
          py::arg("engaged"), stamp, "Engages or releases the brake, after brake.delay.")
      .def(
          "set_temperature",
          [](TwinObject& self, double degrees, const std::optional<Stamp>& at)
          { push(self, InputKind::TEMPERATURE, degrees, at, "degrees"); },
          py::arg("degrees"), stamp,
          "Of the drive, or with thermal.model = two_nodes of its surroundings [degC]; kept within -40 ... 150.")
      .def("inject_fault", &injectFault, py::arg("fault"), stamp,
           "A Fault, or its text 'KIND:SEVERITY[:PLACE[:ONSET]]'; sets in onset after stamp. Severity 0 takes it away. "
           "While any is active that was not there from the start all teeth are solved at every step. ParameterError.");
}

void bindMarch(py::class_<TwinObject>& twin)
{
  const auto none = [](const char* name) { return py::arg(name) = py::none(); };
  twin.def(
          "step", [](TwinObject& self) { self.run(1, py::none(), py::none(), py::none(), py::none(), 2, py::none()); },
          "One step of 1 / solver.rate.")
      .def("run", &TwinObject::run, none("steps"), none("motor_torque"), none("load_torque"), none("brake"),
           none("temperature"), py::arg("every") = 1, none("out"),
           "A block of steps, without the interpreter's lock; Ctrl-C gets through and leaves the twin at the step it "
           "had "
           "reached.\n\n"
           "steps: how many; None: as many as the arrays have. motor_torque, load_torque [N.m], brake (0 or 1), "
           "temperature [degC]: a number, or an array of shape (steps,) with the value of each step; None: what was "
           "commanded before. A given torque does not time out during the run. every: steps from one row to the next. "
           "out: an "
           "array of an earlier run, to be overwritten; None: a new one.\n\n"
           "Returns a structured array of shape (steps // every,) with dtype STEP_DTYPE. InputError.")
      .def("run_to", &runTo, py::arg("time"), none("motor_torque"), none("load_torque"), none("brake"),
           none("temperature"), py::arg("every") = 1, none("out"),
           "As run, up to the last instant not after time [s].");
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
          "the present instant comes from the response surface, not from all teeth")
      .def_property_readonly("counters", &countersOf, "since reset, by name: dict of str to int")
      .def_property_readonly("active_faults", &activeFaults, "list of Fault, by kind and place")
      .def_property_readonly(
          "parameters", [](const TwinObject& self) { return self.parameters(); }, "a copy: Parameters")
      .def("tooth_forces", &TwinObject::toothForces,
           "Forces on every tooth at the present instant: ToothForces, views that the next call overwrites. On the "
           "response surface this solves a full ring. NotConverged.")
      .def("tooth_stress", &TwinObject::toothStress,
           "Stress of the flexspline at every tooth at the present instant: ToothStress, views that the next call "
           "overwrites. NotConverged.")
      .def(
          "health",
          [](TwinObject& self, const std::optional<Stamp>& since)
          { return self.twin().health(since.value_or(std::numeric_limits<Stamp>::min())); },
          py::arg("since") = py::none(),
          "Health at the present instant: Health. since [ns]: the solver's state is that of the steps after it; None: "
          "of "
          "all since reset.")
      .def_property(
          "watch_signals", [](TwinObject& self) { return self.twin().watchesSignals(); },
          [](TwinObject& self, bool on) { self.twin().watchSignals(on); },
          "whether indicators and assessment are made of the sensors' readings; False at first")
      .def_property_readonly(
          "signal_indicators", [](TwinObject& self) { return self.twin().signalIndicators(); },
          "of the last window: SignalIndicators")
      .def_property_readonly(
          "assessment", [](TwinObject& self) { return self.twin().assessment(); },
          "what the indicators say of the drive: Assessment");
}
}  // namespace

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
      "The joint's twin: torques in, encoder angles, tooth forces and health out.\n\n"
      "Twin(parameters, cache=None, progress=None) inserts the wave generator; with solver.scene = auto it builds the "
      "response surface (seconds) or takes it from the cache. parameters: Parameters, copied. cache: directory of "
      "response surfaces; None: the tool's, '': none. progress: called with 0 ... 1 while one is built. "
      "ParameterError.\n\n"
      "Time is counted in steps of one length: the same inputs give the same numbers, step by step or in blocks, and "
      "as "
      "the tool and the node. A twin belongs to one thread at a time; several twins run side by side in threads.");
  twin.def(py::init<const Configuration&, const std::optional<std::string>&, const py::object&>(),
           py::arg("parameters"), py::arg("cache") = py::none(), py::arg("progress") = py::none())
      .def(
          "reset", [](TwinObject& self, Stamp stamp) { self.twin().reset(checked(stamp)); }, py::arg("stamp") = 0,
          "Restarts at rest, zero angles, at the first instant not before stamp [ns], with the configured faults.")
      .def("__copy__", &copyOf,
           "A twin at the same instant, with what waits and what was learned: both go on with the same numbers.")
      .def(
          "__deepcopy__", [](TwinObject& self, const py::dict&) { return copyOf(self); }, py::arg("memo"),
          "As copy.copy.")
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
