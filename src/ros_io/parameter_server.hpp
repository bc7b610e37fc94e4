// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <set>
#include <string>
#include <vector>

#include "harmonic_joint_twin/params/parameter_map.hpp"

namespace hjt
{
/// Names of the parameters that an arm's node has in addition to those of its drives: name or file of the arm;
/// directory of overlays from `joint_twin identify --arm`; reports of the sound arm from `joint_twin compare --arm`
/// (directories or files with commas between them); parameter with another URDF; prefix and suffix of the joint names;
/// faults of an arm without a robot (JOINT:KIND:SEVERITY[:PLACE[:ONSET]], with commas between them); name of the
/// controller, which is the namespace of the action.
constexpr const char* ARM = "arm";
constexpr const char* IDENTIFIED = "identified";
constexpr const char* REFERENCE = "reference";
constexpr const char* DESCRIPTION = "description";
constexpr const char* PREFIX = "prefix";  ///< precedes the arm's joint names in the messages
constexpr const char* SUFFIX = "suffix";  ///< follows the arm's joint names in the messages
constexpr const char* FAULT = "fault";
constexpr const char* CONTROLLER = "controller";
/// Section in which arm.launch gives input/mode a default. The section is separate, because roslaunch would merge
/// input/mode into a user's invalid `input: 3` and so hide the error.
constexpr const char* LAUNCH = "launch";

/// Reads all other parameters `section/key` in `parameter_namespace` from the server, with their types and without
/// defaults. Unknown keys are included, so that `parseParameters` refuses them.
/// @throws ParameterError on a value that no parameter can have, for example a list with a text.
ParameterMap readParameterServer(const std::string& parameter_namespace);

/// Writes all parameters to `parameter_namespace`. A section of `map` replaces the section of equal name on the server.
void writeParameterServer(const std::string& parameter_namespace, const ParameterMap& map);

/// Parameters on the server that the start of this node did not set. Such a parameter may be that of an earlier launch,
/// because the server outlives its nodes.
class FoundParameters
{
public:
  /// Argument that a launch file with clear_params="true" gives: all parameters on the server are of this launch.
  static constexpr const char* CLEARED = "--params-cleared";
  static constexpr std::size_t MAX_NAMED = 12;

  /// Must be called before ros::init, which removes `_section/key:=value` from the command line.
  FoundParameters(int argc, const char* const* argv);

  /// Whether the command line sets all of `map`.
  bool areGiven(const ParameterMap& map) const;

  /// Text `section/key = value` of each parameter that differs from all of `shipped`. Only the first MAX_NAMED by name
  /// are in the text. Empty if no parameter differs.
  std::string departures(const std::string& parameter_namespace, const std::vector<ParameterMap>& shipped) const;

private:
  bool is_cleared_ = false;
  std::set<std::string> given_;  // keys that the command line sets
};
}  // namespace hjt
