// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/number_text.hpp"
#include "base/range_check.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "harmonic_joint_twin/twin/twin.hpp"
#include "python/bindings.hpp"

namespace hjt
{
/// `load_torque_limit`: of the twin; `name`: makes the text of the value's place. @throws InputError for what a twin
/// would clamp; a motor's drive clamps its torque, too, and counts it.
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

/// What the inputs of a run are for.
struct RunShape
{
  /// Axes that an array may have beside none: one value for a step, for a twin, or for a step of each twin.
  enum class Axes
  {
    STEPS,
    TWINS,
    TWINS_AND_STEPS
  };

  Axes axes{};
  double load_torque_limit{};  ///< of twins that differ the largest [N.m]
  py::ssize_t twins{ 1 };
  std::optional<py::ssize_t> steps;  ///< empty: set by the first array that has as many
};

/// An input of a run: none, a number, or an array.
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
    // Truth values, whole and real numbers, objects that are such; no times, no complex numbers.
    const py::array array = py::array::ensure(given);
    const bool is_real = array && std::string("biufO").find(array.dtype().kind()) != std::string::npos;
    const py::handle taken = is_real ? py::handle(array) : py::handle();
    values_ = py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(taken);
    if (!values_)
    {
      throw InputError(name_ + " is neither a number nor an array of numbers");
    }
    takeAxes(shape);
    for (py::ssize_t i = 0; i < values_.size(); ++i)
    {
      requireInput(kind, values_.data()[i], shape.load_torque_limit, [&] { return name_ + placeText(i); });
    }
    data_ = values_.data();
  }

  bool given() const { return given_; }

  /// Only the motor's torque times out and is commanded at every step.
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

  /// Of a value, by its number, as Python writes it.
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

/// Inputs of a run as Python gives them: None, numbers or arrays.
struct GivenInputs
{
  py::object motor_torque = py::none();
  py::object load_torque = py::none();
  py::object brake = py::none();
  py::object temperature = py::none();
};

/// What a run is given beside its steps.
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

  /// One step of a twin with its inputs.
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

/// @returns how many steps. @throws InputError.
inline py::ssize_t requireSteps(const std::optional<py::ssize_t>& steps, py::ssize_t every)
{
  if (!steps)
  {
    throw InputError("steps is missing: give it, or an input as an array with a value for each step");
  }
  requireAtLeast("steps", *steps, 0);
  requireAtLeast("every", every, 1);
  return *steps;
}
}  // namespace hjt
