// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <pybind11/stl.h>

#include "base/number_text.hpp"
#include "base/range.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "harmonic_joint_twin/twin/twin.hpp"
#include "python/bindings.hpp"
#include "python/configuration.hpp"
#include "python/surface_source.hpp"

namespace hjt
{
/// Checks an input. `load_torque_limit`: that of the twin [N.m]; `name`: returns the name of the value. @throws
/// InputError for a load or temperature that a twin would clamp. A motor torque may exceed motor.torque_limit: twin and
/// real drive clamp such a torque, and the twin counts the steps.
template <class Name>
void requireInput(InputKind kind, double value, double load_torque_limit, const Name& name)
{
  const auto refuse = [&](const char* unit, const Range& range)
  {
    if (!isWithin(value, range))
    {
      throw InputError(outOfRangeText(name(), value, unit, range));
    }
  };
  if (!std::isfinite(value))
  {
    throw InputError(name() + " = " + numberText(value) + " is not a finite number");
  }
  if (kind == InputKind::LOAD_TORQUE)
  {
    refuse("N.m", { -load_torque_limit, load_torque_limit });
  }
  if (kind == InputKind::TEMPERATURE)
  {
    refuse("degC", { MIN_TEMPERATURE, MAX_TEMPERATURE });
  }
  if (kind == InputKind::BRAKE)
  {
    refuse("-", { 0.0, 1.0 });
  }
}

struct RunShape
{
  /// Axes that an array may have: a value for each step, for each twin, or for each step of each twin.
  enum class Axes
  {
    STEPS,
    TWINS,
    TWINS_AND_STEPS
  };

  Axes axes{};
  double load_torque_limit{};  ///< output.load_torque_limit; the largest one of several twins [N.m]
  py::ssize_t twins{ 1 };
  std::optional<py::ssize_t> steps;  ///< number of steps; empty: the first array with a value for each step sets it
};

/// An input of a run: None, a number, or an array.
class InputColumn
{
public:
  /// @throws InputError.
  InputColumn(InputKind kind, const char* name, const py::object& given, RunShape& shape)
    : kind_(kind), given_(!given.is_none()), name_(name)
  {
    if (!given_)
    {
      return;
    }
    // Accepts truth values, whole numbers and real numbers, also as Python objects. Refuses times and complex numbers.
    const py::array array = py::array::ensure(given);
    const bool is_real = array && std::string("biufO").find(array.dtype().kind()) != std::string::npos;
    const py::handle taken = is_real ? py::handle(array) : py::handle();
    values_ = py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(taken);
    if (!values_)
    {
      throw InputError(name_ + " must be a number or an array of numbers");
    }
    takeAxes(shape);
    for (py::ssize_t i = 0; i < values_.size(); ++i)
    {
      requireInput(kind, values_.data()[i], shape.load_torque_limit, [&] { return name_ + placeText(i); });
    }
    data_ = values_.data();
  }

  bool given() const { return given_; }

  /// Gives the twin the value of this step if it is new. A motor torque is given at each step, so it does not time out.
  void push(Twin& twin, Stamp stamp, py::ssize_t step, py::ssize_t twin_number) const noexcept
  {
    const double* value = data_ + twin_stride_ * twin_number + step_stride_ * step;
    if (kind_ == InputKind::MOTOR_TORQUE || step == 0 || *value != *(value - step_stride_))
    {
      twin.push({ stamp, kind_, *value });
    }
  }

private:
  void takeAxes(RunShape& shape)
  {
    using Axes = RunShape::Axes;
    const py::ssize_t axes = values_.ndim();
    if (axes > (shape.axes == Axes::TWINS_AND_STEPS ? 2 : 1))
    {
      const char* allowed = shape.axes == Axes::STEPS ? "an array of shape (steps,)" :
                            shape.axes == Axes::TWINS ? "an array of shape (twins,)" :
                                                        "an array of shape (steps,), (twins, 1) or (twins, steps)";
      throw InputError(name_ + " has " + std::to_string(axes) + " dimensions, allowed: a number, or " + allowed);
    }
    if (axes == 2 || (axes == 1 && shape.axes == Axes::TWINS))
    {
      requireCount(values_.shape(0), shape.twins, "twins");
      twin_stride_ = axes == 2 ? values_.shape(1) : 1;
    }
    if (axes == 2 ? values_.shape(1) != 1 : axes == 1 && shape.axes != Axes::TWINS)
    {
      const py::ssize_t count = values_.shape(axes - 1);
      requireCount(count, shape.steps.value_or(count), "steps");
      shape.steps = count;
      step_stride_ = 1;
    }
  }

  void requireCount(py::ssize_t count, py::ssize_t expected, const char* what) const
  {
    if (count != expected)
    {
      throw InputError(name_ + " has " + std::to_string(count) + " values for " + std::to_string(expected) + ' ' +
                       what);
    }
  }

  /// Index of a value as Python writes it, for error texts.
  std::string placeText(py::ssize_t i) const
  {
    switch (values_.ndim())
    {
      case 0:
        return "";
      case 1:
        return '[' + std::to_string(i) + ']';
      default:
        return '[' + std::to_string(i / values_.shape(1)) + ", " + std::to_string(i % values_.shape(1)) + ']';
    }
  }

  InputKind kind_;
  bool given_;
  std::string name_;
  py::array_t<double, py::array::c_style | py::array::forcecast> values_;
  const double* data_{};
  py::ssize_t twin_stride_{};
  py::ssize_t step_stride_{};
};

struct GivenInputs
{
  py::object motor_torque = py::none();
  py::object load_torque = py::none();
  py::object brake = py::none();
  py::object temperature = py::none();
};

class RunInputs
{
public:
  /// @throws InputError.
  RunInputs(const GivenInputs& given, RunShape& shape)
  {
    add(InputColumn(InputKind::MOTOR_TORQUE, "motor_torque", given.motor_torque, shape));
    add(InputColumn(InputKind::LOAD_TORQUE, "load_torque", given.load_torque, shape));
    add(InputColumn(InputKind::BRAKE, "brake", given.brake, shape));
    add(InputColumn(InputKind::TEMPERATURE, "temperature", given.temperature, shape));
  }

  void step(Twin& twin, py::ssize_t step, py::ssize_t twin_number) const noexcept
  {
    const Stamp begin = twin.stamp();
    for (const InputColumn& column : columns_)
    {
      column.push(twin, begin, step, twin_number);
    }
    twin.step(begin + twin.stepLength());
  }

private:
  void add(InputColumn column)
  {
    if (column.given())
    {
      columns_.push_back(std::move(column));
    }
  }

  std::vector<InputColumn> columns_;
};

/// @returns the number of steps. @throws InputError if `steps` is missing or negative, or if `every` is below 1.
inline py::ssize_t requireSteps(const std::optional<py::ssize_t>& steps, py::ssize_t every)
{
  if (!steps)
  {
    throw InputError("steps is missing; give the number of steps, or an input as an array with a value for each step");
  }
  requireAtLeast("steps", *steps, 0);
  requireAtLeast("every", every, 1);
  return *steps;
}

/// A row of a run: all outputs and readings of an instant. The columns of `joint_twin simulate` have the same names.
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

inline StepRow rowOf(const Twin& twin) noexcept
{
  const JointOutputs& o = twin.outputs();
  const EncoderReadings e = twin.encoders();
  return { o.stamp,
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

using StepRows = py::array_t<StepRow>;

/// The array `out` of the user for the rows of a run, or a new array. @throws InputError if `out` does not fit.
inline StepRows rowsFor(const std::vector<py::ssize_t>& shape, const py::object& out)
{
  if (out.is_none())
  {
    return StepRows(shape);
  }
  if (!py::isinstance<StepRows>(out))
  {
    throw InputError("out must be an array of dtype STEP_DTYPE");
  }
  auto rows = py::reinterpret_borrow<StepRows>(out);
  const py::object expected = py::tuple(py::cast(shape));
  if (!py::object(rows.attr("shape")).equal(expected) || !rows.writeable())
  {
    throw InputError("out has shape " + py::cast<std::string>(py::str(rows.attr("shape"))) +
                     (rows.writeable() ? "" : ", not writeable") +
                     ", expected: " + py::cast<std::string>(py::str(expected)) + ", writeable");
  }
  if ((rows.flags() & py::array::c_style) == 0)
  {
    throw InputError("out must be contiguous");
  }
  return rows;
}

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
    , parameters_(parameters.frozen())
  {
  }

  /// The twin. @throws std::runtime_error while another thread uses the twin.
  Twin& twin()
  {
    in_use_.refuse();
    return twin_;
  }

  const Configuration& parameters() const { return parameters_; }

  InUse& inUse() { return in_use_; }

  StepRows run(const std::optional<py::ssize_t>& given_steps, const GivenInputs& given, py::ssize_t every = 1,
               const py::object& out = py::none(), const py::object& progress = py::none())
  {
    RunShape shape{ RunShape::Axes::STEPS, parameters_.values().output.load_torque_limit, 1, given_steps };
    const RunInputs inputs(given, shape);
    const py::ssize_t steps = requireSteps(shape.steps, every);
    StepRows rows = rowsFor({ steps / every }, out);
    march(inputs, steps, every, rows.mutable_data(), progress);
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
  static Twin makeTwin(Parameters parameters, const std::optional<std::string>& cache, const py::object& progress)
  {
    SurfaceSourceOf source(cache, progress);
    Twin twin = withoutLock([&] { return Twin(parameters, source.source()); });
    source.warn();
    return twin;
  }

  void march(const RunInputs& inputs, py::ssize_t steps, py::ssize_t every, StepRow* row, const py::object& progress)
  {
    const InUse::Hold hold = in_use_.hold();
    withoutLock(
        [&]
        {
          RunCheck check(progress);
          py::ssize_t until_row = every;
          for (py::ssize_t step = 0; step < steps; ++step)
          {
            inputs.step(twin_, step, 0);
            if (--until_row == 0)
            {
              *row++ = rowOf(twin_);
              until_row = every;
            }
            if (step % 64 == 63)
            {
              check(step + 1, steps);
            }
          }
          check.end();
        });
  }

  Twin twin_;
  std::shared_ptr<ToothForces> forces_;
  std::shared_ptr<ToothStress> stress_;
  Configuration parameters_;
  InUse in_use_{ "twin" };
};

py::dict namedCounters(const TwinCounters& counters);
}  // namespace hjt
