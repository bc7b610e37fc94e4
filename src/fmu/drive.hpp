// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "fmu/fmi3.hpp"
#include "fmu/variables.hpp"
#include "harmonic_joint_twin/twin/twin.hpp"

namespace hjt::fmu
{
/// A call that FMI does not allow, or one of its arguments. The drive stays as it was.
struct CallError : std::runtime_error
{
  using std::runtime_error::runtime_error;
};

/// Where an instance of FMI is.
enum class Mode
{
  INSTANTIATED,
  INITIALIZATION,
  STEP,
  TERMINATED
};

/// One instance of the drive behind FMI's functions: its values by reference, its mode, its twin. The twin is made when
/// the initialisation ends, or when an output is asked for in it. Every function throws CallError, and ParameterError
/// where the parameters have no twin.
class Drive
{
public:
  /// `resources`: where PARAMETER_FILE lies. @throws InputError.
  Drive(const std::string& resources, const std::string& token, void* environment, LogMessage log);

  /// To the instance's user; errors and warnings always.
  void log(Status status, const char* category, const std::string& message) const noexcept;

  void enterInitialization(double start, std::optional<double> stop);
  void exitInitialization();
  void terminate();
  void reset();

  /// Of one type; an array's values in a row. `count`: values in all.
  template <class Put>
  void get(Type type, const ValueReference* references, std::size_t references_count, std::size_t count,
           const Put& put);
  template <class Take>
  void set(Type type, const ValueReference* references, std::size_t references_count, std::size_t count,
           const Take& take);

  /// From `at` on by `length` [s]. @returns false if a step found no equilibrium and held the last good state.
  bool step(double at, double length);
  double time() const noexcept { return state_.time; }  ///< [s]

  /// All that `step` depends on.
  struct State
  {
    Mode mode{};
    double start{};
    double time{};  // [s]
    std::optional<double> stop;
    std::vector<Value> values;
    std::optional<Twin> twin;
    std::vector<double> given;  // inputs that the twin has
  };
  const State& state() const noexcept { return state_; }
  void takeUp(const State& state);

private:
  const FmuVariable& variable(ValueReference reference, Type type) const;
  void requireMode(bool allowed, const char* call, const char* what = "") const;
  void requireSettable(const FmuVariable& variable) const;
  void check(const FmuVariable& variable, std::size_t element, double value) const;
  void requireCount(Type type, const ValueReference* references, std::size_t references_count, std::size_t count) const;
  const Value& value(ValueReference reference);
  void makeTwin();
  Parameters parameters() const;
  void giveInputs(Stamp instant);
  void readOutput(ValueReference reference);
  void readTeeth();

  void* environment_;
  LogMessage log_;
  Parameters base_;
  std::vector<FmuVariable> variables_;
  State state_;
  bool teeth_known_{};
  std::optional<ToothForces> forces_;
};

template <class Put>
void Drive::get(Type type, const ValueReference* references, std::size_t references_count, std::size_t count,
                const Put& put)
{
  requireCount(type, references, references_count, count);
  std::size_t place = 0;
  for (std::size_t i = 0; i < references_count; ++i)
  {
    const Value& found = value(references[i]);
    if (type == Type::STRING)
    {
      put(place++, 0.0, found.text);
      continue;
    }
    for (const double number : found.numbers)
    {
      put(place++, number, found.text);
    }
  }
}

/// All values are looked at before the first is taken.
template <class Take>
void Drive::set(Type type, const ValueReference* references, std::size_t references_count, std::size_t count,
                const Take& take)
{
  requireCount(type, references, references_count, count);
  std::vector<Value> taken;
  std::size_t place = 0;
  for (std::size_t i = 0; i < references_count; ++i)
  {
    const FmuVariable& target = variable(references[i], type);
    requireSettable(target);
    taken.push_back(state_.values[references[i]]);
    for (std::size_t k = 0; k < (type == Type::STRING ? 1 : taken.back().numbers.size()); ++k)
    {
      take(place++, taken.back(), k);
      if (type != Type::STRING)
      {
        check(target, k, taken.back().numbers[k]);
      }
    }
  }
  for (std::size_t i = 0; i < references_count; ++i)
  {
    state_.values[references[i]] = std::move(taken[i]);
  }
  // Before the start the twin is another one with other values; later inputs go to it with the next step.
  if (state_.mode != Mode::STEP)
  {
    state_.twin.reset();
    teeth_known_ = false;
  }
}
}  // namespace hjt::fmu
