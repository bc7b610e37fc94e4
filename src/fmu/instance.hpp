// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <iterator>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "fmu/fmi.hpp"
#include "fmu/journal.hpp"
#include "fmu/unit.hpp"

namespace hjt::fmu
{
/// A call that FMI does not allow, or one of its arguments. The instance stays as it was.
struct CallError : std::runtime_error
{
  using std::runtime_error::runtime_error;
};

/// The variables that a call names, and how many values it has for them.
struct References
{
  const ValueReference* references;
  std::size_t size;
  std::size_t values;
  Version version;
};

/// Where an instance of FMI is.
enum class Mode
{
  INSTANTIATED,
  INITIALIZATION,
  STEP,
  TERMINATED
};

/// One instance behind FMI's functions: its values by reference, its mode, what it simulates. That is made when the
/// initialisation ends, or when an output is asked for in it. Every function throws CallError, and ParameterError where
/// the parameters have no twin.
class Instance
{
public:
  /// `resources`: folder of the unit's. @throws InputError.
  Instance(const std::string& resources, const std::string& token, bool logs, Log log);

  /// To the instance's user, if he wants it. `status`: what the call returns, or OK where it only tells.
  void log(Status status, const std::string& message) const noexcept;

  /// On: for these categories alone, for all if none is named. Off: for all.
  void setLogging(bool on, std::size_t count, const char* const* categories);

  void setUp(double start, std::optional<double> stop);
  void enterInitialization();
  void exitInitialization();
  void terminate();
  void reset();

  /// Of one type; an array's values in a row. @returns false if some are of the last instant that had them.
  template <class Put>
  bool get(Type type, const References& of, const Put& put);
  void setNumbers(Type type, const References& of, const std::function<double(std::size_t)>& number);
  void setTexts(const References& of, const char* const* texts);

  /// From `at` on by `length` [s]. @returns false if a step found no equilibrium and held the last good state.
  bool step(double at, double length);
  double time() const noexcept { return state_.time; }  ///< [s]

  /// All that `step` depends on.
  struct State
  {
    State() = default;
    State(const State& other);
    State& operator=(const State& other);
    State(State&&) noexcept = default;
    State& operator=(State&&) noexcept = default;
    ~State() = default;

    Mode mode{};
    double start{};
    double time{};  // [s]
    std::optional<double> stop;
    Values values;
    Journal journal;                   // of the simulation
    std::shared_ptr<const Unit> unit;  // that the simulation refers to; a state may outlive the instance it was of
    std::unique_ptr<Simulation> simulation;
  };
  const State& state() const noexcept { return state_; }
  void takeUp(const State& state) { state_ = state; }

  /// For another process with this unit, too. Guarded against damage, not against malice. @throws InputError.
  std::string serialised(const State& state) const;
  /// Does all that the state has behind it once more. @throws InputError.
  std::unique_ptr<State> deserialised(std::string_view bytes) const;

private:
  /// Elements of a variable that a reference means.
  struct Elements
  {
    std::size_t variable;
    std::size_t begin;
    std::size_t end;
  };
  Elements elements(Type type, const References& of, std::size_t place) const;
  void requireMode(bool allowed, const char* call, const char* what = "") const;
  void requireSettable(const FmuVariable& variable) const;
  static void check(const FmuVariable& variable, std::size_t element, double value);
  void requireCount(Type type, const References& of) const;
  bool update(std::size_t reference);
  Notice notice() const;
  void start();
  void changed(bool differs);

  std::array<bool, std::size(LOG_CATEGORIES)> logs_;
  Log log_;
  std::string token_;
  std::shared_ptr<const Unit> unit_;
  State state_;
};

template <class Put>
bool Instance::get(Type type, const References& of, const Put& put)
{
  requireCount(type, of);
  std::size_t place = 0;
  bool is_present = true;
  for (std::size_t i = 0; i < of.size; ++i)
  {
    const Elements asked = elements(type, of, i);
    is_present = update(asked.variable) && is_present;
    const Value& found = state_.values[asked.variable];
    for (std::size_t k = asked.begin; k < asked.end; ++k)
    {
      put(place++, found.numbers.empty() ? 0.0 : found.numbers[k], found.text);
    }
  }
  return is_present;
}
}  // namespace hjt::fmu
