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
/// Error of a call or of an argument that FMI does not allow. The instance does not change.
struct CallError : std::runtime_error
{
  using std::runtime_error::runtime_error;
};

/// The variables that a call names, and the number of values that the call has for them.
struct References
{
  const ValueReference* references;
  std::size_t size;
  std::size_t values;
  Version version;
};

/// Mode of an instance, by which FMI allows or forbids calls.
enum class Mode
{
  INSTANTIATED,
  INITIALIZATION,
  STEP,
  TERMINATED
};

/// An instance of a unit, which the functions of FMI use: its values, its mode and its simulation. The simulation is
/// made at the end of the initialisation, or when an output is read before this end. Every function throws CallError,
/// and also ParameterError if the parameters are invalid for a twin.
class Instance
{
public:
  /// `resources`: directory of the unit's resources. @throws InputError.
  Instance(const std::string& resources, const std::string& token, bool logs, Log log);

  /// Sends a message to the importer's log, if logging is on. `status`: status of the call, or OK for information.
  void log(Status status, const std::string& message) const noexcept;

  /// Switches the logging of `categories` on. Without `on`: switches all logging off. No category means all categories.
  void setLogging(bool on, std::size_t count, const char* const* categories);

  void setUp(double start, std::optional<double> stop);
  void enterInitialization();
  void exitInitialization();
  void terminate();
  void reset();

  /// Passes the values of variables of one type to `put`. Values of an array are consecutive. @returns false if some
  /// values are those of an earlier instant.
  template <class Put>
  bool get(Type type, const References& of, const Put& put);
  void setNumbers(Type type, const References& of, const std::function<double(std::size_t)>& number);
  void setTexts(const References& of, const char* const* texts);

  /// Steps from time `at` by `length` [s]. @returns false if a step had no equilibrium, so that the twin kept its last
  /// converged state.
  bool step(double at, double length);
  double time() const noexcept { return state_.time; }  ///< present time [s]

  /// All data that determine the results of later steps.
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
    double time{};  // present time [s]
    std::optional<double> stop;
    Values values;
    Journal journal;                   // journal of the simulation
    std::shared_ptr<const Unit> unit;  // unit of the simulation; a state may outlive its instance
    std::unique_ptr<Simulation> simulation;
  };
  const State& state() const noexcept { return state_; }
  void takeUp(const State& state) { state_ = state; }

  /// A state as bytes, which another process with the same unit can read. `deserialised` detects damage, not forgery.
  /// @throws InputError.
  std::string serialised(const State& state) const;
  /// A state from bytes of `serialised`. The function repeats the simulation from the start. @throws InputError.
  std::unique_ptr<State> deserialised(std::string_view bytes) const;

private:
  /// Elements `begin` to `end` of a variable, which a reference denotes.
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
