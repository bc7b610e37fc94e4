// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/recorded_arms.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <system_error>

#include "arm/arm_configuration.hpp"
#include "bags/recorded_messages.hpp"
#include "base/csv_table.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "recordings/controller_columns.hpp"

namespace hjt
{
namespace
{
namespace fs = std::filesystem;

bool holds(const std::vector<std::string>& names, const std::string& name)
{
  return std::find(names.begin(), names.end(), name) != names.end();
}

CheckedContents readTableContents(const MotionSource& source)
{
  CheckedContents contents;
  contents.is_csv = true;
  const std::string temperatures = "joint_temperatures_";
  const CsvRows table(source.path);
  if (const std::string foreign = foreignTable(table.header()); !foreign.empty())
  {
    throw InputError(source.path + ": " + foreign);
  }
  for (const std::string& name : table.header())
  {
    contents.temperature =
        name.compare(0, temperatures.size(), temperatures) == 0 ? temperatures + "N" : contents.temperature;
  }
  return contents;
}

CheckedContents contentsOf(const std::vector<std::vector<MotionRow>>& rows)
{
  CheckedContents contents;
  contents.is_csv = true;
  const bool has_temperature =
      std::any_of(rows.begin(), rows.end(),
                  [](const std::vector<MotionRow>& joints)
                  {
                    return std::any_of(joints.begin(), joints.end(),
                                       [](const MotionRow& row) { return std::isfinite(row.temperature); });
                  });
  contents.temperature = has_temperature ? "temperature" : "";
  return contents;
}

/// @throws InputError where no name tells a joint.
void requireNames(const std::string& topic, const std::vector<std::string>& names)
{
  const auto all = [&](const auto& is) { return !names.empty() && std::all_of(names.begin(), names.end(), is); };
  if (all([](const std::string& name) { return name.empty(); }))
  {
    throw InputError(topic + ": the joints have no names (each name is empty), so whose the values are is not known");
  }
  const auto names_quantity = [](const std::string& name)
  {
    const std::string quantity = name.substr(name.rfind('/') + 1);
    return quantity != name && (quantity == "position" || quantity == "velocity" || quantity == "effort");
  };
  if (all(names_quantity))
  {
    throw InputError(
        topic + ": the names carry the quantity (" + names.front() +
        "); a message has to name each joint once, with its position, velocity and effort in these fields");
  }
}

CheckedContents readMessageContents(const MotionSource& source)
{
  constexpr int MESSAGES = 1000;  // after so many messages every publisher of the topic was heard
  CheckedContents contents;
  const std::unique_ptr<RecordedMessages> recording = RecordedMessages::open(source.path);
  recording->requireStates(source.topic);
  for (const auto& [name, topic] : recording->topics())
  {
    contents.temperature = topic.type == TEMPERATURE_TYPE ? name : contents.temperature;
  }
  int read = 0;
  recording->visit(
      { source.topic }, false,
      [&](const RecordedMessage& message)
      {
        if (message.state == nullptr)
        {
          return true;
        }
        const sensor_msgs::JointState& state = *message.state;
        contents.has_angles = contents.has_angles || !state.position.empty();
        for (std::size_t i = 0; i < state.name.size(); ++i)
        {
          if (!holds(contents.named, state.name[i]))
          {
            contents.named.push_back(state.name[i]);
          }
          if (i < std::min(state.position.size(), state.effort.size()) && !holds(contents.usable, state.name[i]))
          {
            contents.usable.push_back(state.name[i]);
          }
        }
        // Efforts may come later than angles.
        return ++read < MESSAGES || contents.usable.size() < contents.named.size();
      },
      [](double) {});
  requireNames(source.topic, contents.named);
  contents.named = withoutMotors(contents.named);
  contents.usable = withoutMotors(contents.usable);
  return contents;
}

/// Of the joints at hand those of an arm that is not complete; all of them if there is none.
void takeParts(const std::vector<std::string>& names, const CheckedContents& contents, CheckedArm& arm)
{
  for (const std::string& name : names)
  {
    (holds(contents.usable, arm.affixes(name)) ? arm.joints_at_hand : arm.missing).push_back(arm.affixes(name));
  }
}

CheckedArm withoutArm(const std::vector<fs::path>& files, const CheckedContents& contents)
{
  CheckedArm none;
  for (const fs::path& file : files)
  {
    const std::vector<std::string> names = jointNames(readArmDescription(file.string()));
    const auto at_hand =
        std::count_if(names.begin(), names.end(), [&](const std::string& name) { return holds(contents.named, name); });
    if (2 * static_cast<std::size_t>(at_hand) > names.size())
    {
      takeParts(names, contents, none);
      return none;
    }
  }
  none.joints_at_hand = contents.usable;
  return none;
}

/// How a recording may name the joints of an arm.
std::vector<JointAffixes> affixesOf(const ArmDescription& arm, const RecordingOptions& options,
                                    const CheckedContents& contents)
{
  return contents.is_csv || !options.affixes.empty() ? std::vector<JointAffixes>{ options.affixes } :
                                                       findAffixes(jointNames(arm), contents.named);
}

bool namesAll(const CheckedContents& contents, const std::vector<std::string>& names, const JointAffixes& affixes)
{
  return contents.is_csv || std::all_of(names.begin(), names.end(),
                                        [&](const std::string& name) { return holds(contents.named, affixes(name)); });
}

CheckedArm armWith(const JointAffixes& affixes)
{
  CheckedArm arm;
  arm.affixes = affixes;
  return arm;
}

/// Those of the configuration, one for each way of naming the joints.
std::vector<CheckedArm> armsOfConfiguration(const std::vector<fs::path>& files, const RecordingOptions& options,
                                            const CheckedContents& contents)
{
  std::vector<CheckedArm> arms;
  for (const fs::path& file : files)
  {
    const ArmDescription description = readArmDescription(file.string());
    for (const JointAffixes& affixes : affixesOf(description, options, contents))
    {
      const bool has_all = options.rows ? options.rows->front().size() == description.joints.size() :
                                          namesAll(contents, jointNames(description), affixes);
      if (!has_all)
      {
        continue;
      }
      auto arm = std::find_if(arms.begin(), arms.end(), [&](const CheckedArm& one) { return one.affixes == affixes; });
      if (arm == arms.end())
      {
        arm = arms.insert(arms.end(), armWith(affixes));
      }
      arm->fitting.push_back(file.stem().string());
    }
  }
  return arms;
}

/// The arm that the options name, as often as the recording names its joints; `known` has what else fits.
std::vector<CheckedArm> armsGiven(const std::vector<CheckedArm>& known, const RecordingOptions& options,
                                  const CheckedContents& contents)
{
  const ArmDescription given = readArmDescription(findArm(options.arm, configDirectory(options)));
  std::vector<CheckedArm> arms;
  for (const JointAffixes& affixes : affixesOf(given, options, contents))
  {
    const auto same =
        std::find_if(known.begin(), known.end(), [&](const CheckedArm& one) { return one.affixes == affixes; });
    arms.push_back(same == known.end() ? armWith(affixes) : *same);
    arms.back().taken = options.arm;
  }
  if (arms.empty())
  {
    arms.emplace_back();
    takeParts(jointNames(given), contents, arms.back());
  }
  return arms;
}

/// An arm whose joints have no angle or no effort cannot be read as one.
void leaveOutIncomplete(const RecordingOptions& options, const CheckedContents& contents, CheckedArm& arm)
{
  const std::string name = arm.taken.empty() ? (arm.fitting.empty() ? "" : arm.fitting.front()) : arm.taken;
  if (name.empty() || contents.is_csv)
  {
    return;
  }
  takeParts(jointNames(readArmDescription(findArm(name, configDirectory(options)))), contents, arm);
  if (!arm.missing.empty())
  {
    arm.taken.clear();
    arm.fitting.clear();
  }
}
}  // namespace

CheckedContents readCheckedContents(const MotionSource& source)
{
  return source.rows   ? contentsOf(*source.rows) :
         isCsv(source) ? readTableContents(source) :
                         readMessageContents(source);
}

std::vector<CheckedArm> findArms(const RecordingOptions& options, const CheckedContents& contents)
{
  const std::vector<fs::path> files = armFiles(configDirectory(options));
  std::vector<CheckedArm> arms = armsOfConfiguration(files, options, contents);
  if (!options.arm.empty())
  {
    arms = armsGiven(arms, options, contents);
  }
  if (arms.empty() && options.rows)
  {
    throw InputError(options.recording + " has " + std::to_string(options.rows->front().size()) +
                     " joints, which no arm in config/arms has; give your own (docs/arm.md)");
  }
  if (arms.empty())
  {
    arms.push_back(withoutArm(files, contents));
  }
  for (CheckedArm& arm : arms)
  {
    leaveOutIncomplete(options, contents, arm);
  }
  return arms;
}
}  // namespace hjt
