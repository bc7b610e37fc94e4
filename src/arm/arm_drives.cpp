// SPDX-License-Identifier: BSD-3-Clause
#include "harmonic_joint_twin/arm/arm_drives.hpp"

#include "arm/arm_configuration.hpp"
#include "arm/arm_twin.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "twin/options.hpp"

namespace hjt
{
namespace
{
ArmTwin makeTwin(const ArmDescription& arm, const ConfigurationOptions& configuration, const ArmOptions& options)
{
  std::vector<double> start = options.start;
  start.resize(start.empty() ? arm.joints.size() : start.size());
  if (start.size() != arm.joints.size())
  {
    throw ParameterError(arm.origin + ": " + std::to_string(start.size()) + " start angles are given for " +
                         std::to_string(arm.joints.size()) + " joints");
  }
  const std::vector<Parameters> drives = armDrives(arm, configuration, options.identified, options.faults);
  return ArmTwin(arm, drives, start, options.surface_source);
}
}  // namespace

struct ArmDrives::Impl
{
  explicit Impl(const ArmOptions& options)
    : configuration{ options.config_dir, {}, {}, {}, {} }
    , arm(readArmDescription(findArm(options.arm, configDirectory(configuration))))
    , names(jointNames(arm))
    , twin(makeTwin(arm, configuration, options))
  {
  }

  ConfigurationOptions configuration;
  ArmDescription arm;
  std::vector<std::string> names;
  ArmTwin twin;
};

ArmDrives::ArmDrives(const ArmOptions& options) : impl_(std::make_unique<Impl>(options)) {}
ArmDrives::~ArmDrives() = default;
ArmDrives::ArmDrives(ArmDrives&&) noexcept = default;

const std::vector<std::string>& ArmDrives::names() const noexcept
{
  return impl_->names;
}

Twin& ArmDrives::drive(std::size_t joint) noexcept
{
  return impl_->twin.drive(joint);
}

double ArmDrives::startAngle(std::size_t joint) const noexcept
{
  return impl_->twin.startAngle(joint);
}

bool ArmDrives::reset(Stamp stamp) noexcept
{
  return impl_->twin.reset(stamp);
}

bool ArmDrives::step(Stamp until) noexcept
{
  return impl_->twin.step(until);
}

Stamp ArmDrives::stamp() const noexcept
{
  return impl_->twin.stamp();
}
}  // namespace hjt
