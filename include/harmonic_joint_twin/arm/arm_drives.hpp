// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "harmonic_joint_twin/surface/surface_source.hpp"
#include "harmonic_joint_twin/twin/twin.hpp"

namespace hjt
{
/// Which arm, and how it begins.
struct ArmOptions
{
  std::string arm{ "ur5" };         ///< name or file
  std::string config_dir;           ///< the package's folder config; empty: found by itself
  std::string identified;           ///< directory of overlays by `joint_twin identify --arm`; empty: none
  std::vector<std::string> faults;  ///< JOINT:KIND:SEVERITY[:PLACE[:ONSET]]
  std::vector<double> start;        ///< angles of the joints, where it stands in its brakes; empty: 0 [rad]
  SurfaceSource surface_source{ surfaceCacheDirectory() };  ///< of its drives' response surfaces
};

/// All drives of an arm, coupled by its links, without a controller: the motors' torques are commanded, as those of a
/// single Twin. In the library harmonic_joint_twin_arm. After construction no member throws or allocates.
class ArmDrives
{
public:
  /// Builds the drives' response surfaces, or takes them from the cache. @throws ParameterError.
  explicit ArmDrives(const ArmOptions& options);
  ~ArmDrives();
  ArmDrives(ArmDrives&&) noexcept;

  const std::vector<std::string>& names() const noexcept;  ///< of the joints, as in the messages
  std::size_t joints() const noexcept { return names().size(); }
  Twin& drive(std::size_t joint) noexcept;              ///< to command and to read; not to step
  double startAngle(std::size_t joint) const noexcept;  ///< joint angle where the drive's encoders read 0 [rad]

  bool reset(Stamp stamp) noexcept;  ///< to the start, as Twin::reset
  bool step(Stamp until) noexcept;   ///< all drives, as Twin::step
  Stamp stamp() const noexcept;

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};
}  // namespace hjt
