// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "fmu/unit.hpp"

namespace hjt::fmu
{
/// Variables of a drive in a unit, and the inputs that its twin has got.
class DrivePart
{
public:
  /// The drive whose variables begin at `first` with this prefix. `variables` must outlive this object.
  DrivePart(const std::vector<FmuVariable>& variables, std::size_t first, const std::string& prefix);

  std::size_t end() const noexcept { return end_; }  ///< value reference after the drive's last one

  /// `base` with the set values, and with the set faults from the start. @throws ParameterError.
  Parameters parameters(const Parameters& base, const Values& values) const;

  /// Sets the inputs of the first step: the load is ignored, the brake is set.
  void begin(const Values& values, bool brake_engaged);

  /// Commands the inputs that have changed, except the motor's torque, from this instant.
  void giveInputs(Stamp instant, const Values& values, Twin& twin);
  double motorTorque(const Values& values) const noexcept { return values[first_ + MOTOR_TORQUE].numbers[0]; }

  void moved() noexcept { teeth_known_ = false; }  ///< marks the teeth's values as outdated after a step
  bool read(std::size_t reference, Twin& twin, Values& values);
  bool marks(std::size_t reference, const Twin& twin) const;  ///< see Simulation::marks

private:
  const ScalarOutput& scalar(std::size_t reference) const { return scalarOutputs()[reference - first_ - FIRST_OUTPUT]; }
  bool readTeeth(Twin& twin, Values& values);
  void changeFaults(const Values& values, Parameters& parameters) const;

  const std::vector<FmuVariable>* variables_;
  std::size_t first_;
  std::size_t end_;
  std::size_t prefix_size_;
  std::vector<double> given_;  // inputs that the twin has got
  bool teeth_known_{};
  std::optional<ToothForces> forces_;
};

/// Parses parameters from the resources of a unit in `folder`. @throws InputError, ParameterError.
Parameters readParameters(const std::string& text, const std::string& folder);

/// Source of response surfaces for all instances of the process.
SurfaceSource unitSurfaces(const Notice& notice);
}  // namespace hjt::fmu
