// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "harmonic_joint_twin/surface/surface_source.hpp"
#include "harmonic_joint_twin/twin/twin.hpp"

namespace hjt
{
/// Choice of an arm, its faults and its initial state.
struct ArmOptions
{
  std::string arm{ "ur5" };         ///< name of a shipped arm, or path of its file
  std::string config_dir;           ///< the package's folder config; empty: found automatically
  std::string identified;           ///< directory of overlays that `joint_twin identify --arm` wrote; empty: none
  std::vector<std::string> faults;  ///< JOINT:KIND:SEVERITY[:PLACE[:ONSET]]
  std::vector<double> start;        ///< initial angles of the joints, which their brakes hold; empty: all 0 [rad]
  SurfaceSource surface_source{ surfaceCacheDirectory() };  ///< where the drives' response surfaces come from
};

/// All drives of an arm without a controller. The links couple the drives. The caller commands the motors' torques, as
/// with a single Twin. The library harmonic_joint_twin_arm contains the class. After construction nothing throws or
/// allocates.
class ArmDrives
{
public:
  /// Builds the drives' response surfaces or reads them from the cache. @throws ParameterError.
  explicit ArmDrives(const ArmOptions& options);
  ~ArmDrives();
  ArmDrives(ArmDrives&&) noexcept;

  const std::vector<std::string>& names() const noexcept;  ///< names of the joints, as in the messages
  std::size_t joints() const noexcept { return names().size(); }
  /// Drive of one joint. The caller commands and reads the drive, but must not step it.
  Twin& drive(std::size_t joint) noexcept;
  double startAngle(std::size_t joint) const noexcept;  ///< angle of this joint at which its encoders read 0 [rad]

  bool reset(Stamp stamp) noexcept;  ///< returns all drives to the initial state, as Twin::reset does
  bool step(Stamp until) noexcept;   ///< advances all drives by one solver step, as Twin::step does
  Stamp stamp() const noexcept;

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};
}  // namespace hjt
