// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "fmu/variables.hpp"
#include "harmonic_joint_twin/base/stamp.hpp"

namespace hjt::fmu
{
using Values = std::vector<Value>;  ///< values of all variables of a unit
using Notice = std::function<void(const std::string&)>;

constexpr Stamp EPOCH = 1'000'000'000'000'000'000;  ///< stamp of time 0, as in `joint_twin simulate`

constexpr double LARGEST_TIME = 1e9;  ///< largest magnitude of a time that an importer may give [s]

inline Stamp stampAt(double time)  ///< stamp of a time [s]
{
  return EPOCH + static_cast<Stamp>(std::llround(1e9 * time));
}

/// The simulation of an instance, from its start on.
class Simulation
{
public:
  virtual ~Simulation() = default;

  /// A copy at the present instant. With equal inputs, copy and original give bit-identical results.
  virtual std::unique_ptr<Simulation> copy() const = 0;

  /// Steps with the inputs in `values` to the last instant that is not after `end` [s], without allocation. @returns
  /// false if a step had no equilibrium, so that the twin kept its last converged state.
  virtual bool step(const Values& values, double end) = 0;

  /// Writes the value of an output to `values`. @returns false if the value stays that of an earlier instant.
  virtual bool read(std::size_t reference, Values& values) = 0;

  /// Whether reading this output changes later results.
  virtual bool marks(std::size_t reference) const = 0;

protected:
  Simulation() = default;
  Simulation(const Simulation&) = default;
  Simulation& operator=(const Simulation&) = default;
};

class Unit
{
public:
  virtual ~Unit() = default;
  Unit(const Unit&) = delete;
  Unit& operator=(const Unit&) = delete;

  /// Starts a simulation at the time `start` [s]. `notice` receives messages for the user. The unit must outlive the
  /// simulation. @throws ParameterError if `values` are invalid for a twin.
  virtual std::unique_ptr<Simulation> start(const Values& values, double start, const Notice& notice) const = 0;

  const std::vector<FmuVariable>& variables() const { return variables_; }

protected:
  Unit() = default;

  std::vector<FmuVariable> variables_;
};

/// Opens the FMU's unit, a drive or an arm, from the directory `resources` of the FMU. @throws InputError if a file is
/// invalid, or if `token` is not that of this library and these resources.
std::unique_ptr<Unit> openUnit(const std::string& resources, const std::string& token);
}  // namespace hjt::fmu
