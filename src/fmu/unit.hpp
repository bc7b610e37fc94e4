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
using Values = std::vector<Value>;  ///< of all variables of a unit
using Notice = std::function<void(const std::string&)>;

constexpr Stamp EPOCH = 1'000'000'000'000'000'000;  ///< stamp of time 0, as in `joint_twin simulate`

constexpr double LARGEST_TIME = 1e9;  ///< either way [s]

inline Stamp stampAt(double time)  ///< [s]
{
  return EPOCH + static_cast<Stamp>(std::llround(1e9 * time));
}

/// The simulated object of an instance, from its start on.
class Simulation
{
public:
  virtual ~Simulation() = default;

  /// At the same instant; with the same values both go on with the same bits.
  virtual std::unique_ptr<Simulation> copy() const = 0;

  /// To the last of its instants not after `end` [s], with these values of the inputs; does not allocate. False: a step
  /// found no equilibrium and held the last good state.
  virtual bool step(const Values& values, double end) = 0;

  /// Writes the value of an output. False: it is of the last instant that had one.
  virtual bool read(std::size_t reference, Values& values) = 0;

  /// Whether a read of this output would change what comes.
  virtual bool marks(std::size_t reference) const = 0;

protected:
  Simulation() = default;
  Simulation(const Simulation&) = default;
  Simulation& operator=(const Simulation&) = default;
};

/// Resources of a unit.
class Unit
{
public:
  virtual ~Unit() = default;
  Unit(const Unit&) = delete;
  Unit& operator=(const Unit&) = delete;

  /// `start` [s]; `notice`: what the user must know of it. The unit outlives it. @throws ParameterError where these
  /// values have no twin.
  virtual std::unique_ptr<Simulation> start(const Values& values, double start, const Notice& notice) const = 0;

  const std::vector<FmuVariable>& variables() const { return variables_; }

protected:
  Unit() = default;

  std::vector<FmuVariable> variables_;
};

/// The unit of this library. `resources`: its folder. @throws InputError, also if the token is another.
std::unique_ptr<Unit> openUnit(const std::string& resources, const std::string& token);
}  // namespace hjt::fmu
