// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "fmu/unit.hpp"

namespace hjt::fmu
{
/// Part of a unit that belongs to one drive: its variables, and the inputs that its twin has received.
class DrivePart
{
public:
  /// Part of the drive whose variables begin at index `first` and with `prefix`. `variables` must outlive this object.
  DrivePart(const std::vector<FmuVariable>& variables, std::size_t first, const std::string& prefix);

  std::size_t end() const noexcept { return end_; }  ///< value reference after the last variable of the drive

  /// `base`, changed by the parameters and faults that the importer has set. @throws ParameterError.
  Parameters parameters(const Parameters& base, const Values& values) const;

  /// Notes before the first step that the twin has all inputs but the load. `brake_engaged`: state of the twin's brake.
  void begin(const Values& values, bool brake_engaged);

  /// Gives the twin the changed inputs, except the motor torque. The inputs act from `instant` on.
  void giveInputs(Stamp instant, const Values& values, Twin& twin);
  double motorTorque(const Values& values) const noexcept { return values[first_ + MOTOR_TORQUE].numbers[0]; }

  void moved() noexcept { teeth_known_ = false; }  ///< marks the teeth's values as outdated; to call after a step
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
  std::vector<double> given_;  // inputs that the twin has received
  bool teeth_known_{};
  std::optional<ToothForces> forces_;
};

/// Reads parameters from `text`. Files that they name are in `folder`. @throws InputError, ParameterError.
Parameters readParameters(const std::string& text, const std::string& folder);

/// Source of response surfaces, which all instances of this process share.
SurfaceSource unitSurfaces(const Notice& notice);
}  // namespace hjt::fmu
