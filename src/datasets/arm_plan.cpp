// SPDX-License-Identifier: BSD-3-Clause
#include "datasets/arm_plan.hpp"

#include <filesystem>
#include <iostream>

#include "arm/arm_configuration.hpp"
#include "arm/set_points.hpp"
#include "base/hash.hpp"
#include "base/whole_file.hpp"
#include "params/configuration_files.hpp"

namespace hjt
{
namespace
{
namespace fs = std::filesystem;

/// Path of `name` in the plan's directory if it exists there, else `name`. `folder`: whether a directory is sought.
std::string beside(const std::string& directory, const std::string& name, bool folder)
{
  const fs::path path = fs::path(directory) / name;
  std::error_code error;
  return fs::exists(path, error) && fs::is_directory(path, error) == folder ? path.string() : name;
}
}  // namespace

void setFaults(const std::vector<RunFault>& faults, std::size_t joint, const std::string& origin, ParameterMap& map)
{
  eraseFaults(map);
  int count = 0;
  for (const RunFault& growing : faults)
  {
    for (const Fault& fault : growing.joint == joint ? growing.steps() : std::vector<Fault>())
    {
      const std::string key = std::string(FAULTS) + "." + std::to_string(count++) + ".";
      map[key + "kind"] = { std::string(describe(fault.kind).name), origin };
      map[key + "severity"] = { fault.severity, origin };
      map[key + "place"] = { static_cast<std::int64_t>(fault.place), origin };
      map[key + "onset"] = { fault.onset, origin };
    }
  }
}

std::vector<RunFault> configuredFaults(const Parameters& drive, std::size_t joint)
{
  std::vector<RunFault> faults;
  for (const Fault& fault : drive.faults)
  {
    faults.push_back({ { fault, 0.0 }, joint });
  }
  return faults;
}

ArmPlan::ArmPlan(const PlanNode& root, const std::string& directory, const ConfigurationOptions& options)
{
  if (root.find("lives") != nullptr)
  {
    root.find("lives")->refuse("is not allowed in a plan of arms, because each life is simulated for a single drive");
  }
  const PlanValues values;
  const std::string identified = values.text(root, "identified", "");
  const std::string folder = identified.empty() ? "" : beside(directory, identified, true);
  arm_ = readArmDescription(findArm(beside(directory, values.text(root, "arm"), false), configDirectory(options)));
  arm_text_ = readFile(arm_.origin);
  addIdentifiedGains(folder, arm_);
  drives_ = armDriveMaps(arm_, options, folder);
  for (const auto& [number, duty] : required(root, "duty", PlanNode::Kind::LIST).entries)
  {
    for (const std::string& file : textsOf(duty, "motion"))
    {
      const std::string path = (fs::path(directory) / file).string();
      std::vector<ArmSetPoint> points = readSetPoints(path, arm_);
      if (const double change = straightenTimes(points); change > 0.0)
      {
        std::cerr << "warning: " << path << ": " << straightenedText(change) << '\n';
      }
      motions_[file] = { std::make_shared<const std::vector<ArmSetPoint>>(std::move(points)),
                         std::to_string(textHash(readFile(path, MAX_BINARY))) };
    }
  }
}

std::size_t ArmPlan::jointOf(const PlanNode& fault, const PlanValues& values) const
{
  const std::optional<std::size_t> joint = findJoint(arm_, values.text(fault, "joint"));
  if (!joint)
  {
    required(fault, "joint").refuse("is not a joint of the arm; its joints are " + shortNames(arm_));
  }
  return *joint;
}

ArmSpec ArmPlan::read(const PlanNode& duty, const PlanValues& values, const ParameterMap& settings,
                      const std::vector<RunFault>* faults, const std::string& faults_origin) const
{
  allowOnly(duty, { "name", "motion", "payload" });
  ArmSpec spec{ arm_, {}, motions_.at(values.text(duty, "motion")).points };
  spec.arm.payload.mass = values.number(duty, "payload", "kg", PAYLOAD_MASS, arm_.payload.mass);
  for (std::size_t joint = 0; joint < drives_.size(); ++joint)
  {
    ParameterMap map = drives_[joint];
    putOver(settings, map);
    if (faults != nullptr)
    {
      setFaults(*faults, joint, faults_origin, map);
    }
    spec.drives.push_back(parseParameters(map));
  }
  giveOwnSeeds(spec.drives);
  return spec;
}

OrderedJson ArmPlan::configuration() const
{
  OrderedJson json = OrderedJson::object();
  json["arm"] = arm_text_;
  json["urdf"] = arm_.urdf;
  json["base"] = arm_.base;
  json["tip"] = arm_.tip;
  json["gravity"] = arm_.gravity;
  json["payload"] = { arm_.payload.mass, arm_.payload.centre[0], arm_.payload.centre[1], arm_.payload.centre[2] };
  json["state_rate"] = arm_.state_rate;
  for (std::size_t joint = 0; joint < drives_.size(); ++joint)
  {
    OrderedJson& drive = json[arm_.joints[joint].short_name] = OrderedJson::object();
    for (const auto& [key, value] : drives_[joint])
    {
      drive[key] = jsonOf(value);
    }
    drive["limits"] = { arm_.joints[joint].speed_limit, arm_.joints[joint].torque_limit,
                        arm_.joints[joint].feedback_limit };
    if (const auto& gains = arm_.joints[joint].gains)
    {
      drive["controller"] = { gains->position, gains->speed, gains->integral_time, gains->coulomb, gains->viscous };
    }
  }
  return json;
}

OrderedJson ArmPlan::motions() const
{
  OrderedJson json = OrderedJson::object();
  for (const auto& [file, motion] : motions_)
  {
    json[file] = motion.hash;
  }
  return json;
}
}  // namespace hjt
