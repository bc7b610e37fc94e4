// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <set>
#include <string>
#include <vector>

#include "harmonic_joint_twin/params/parameter_map.hpp"

namespace hjt
{
/// Parameters of an arm's node in addition to those of its drives: name or file of the arm; directory of overlays from
/// `joint_twin identify --arm`; reports of the sound arm from `joint_twin compare --arm`, as directories or files
/// separated by commas; name of the parameter with another URDF; affixes of the joint names; faults of an arm without a
/// robot, JOINT:KIND:SEVERITY[:PLACE[:ONSET]], separated by commas; name of the controller, the namespace of its
/// action.
constexpr const char* ARM = "arm";
constexpr const char* IDENTIFIED = "identified";
constexpr const char* REFERENCE = "reference";
constexpr const char* DESCRIPTION = "description";
constexpr const char* PREFIX = "prefix";  ///< precedes the arm's joint names in the messages
constexpr const char* SUFFIX = "suffix";  ///< follows the arm's joint names in the messages
constexpr const char* FAULT = "fault";
constexpr const char* CONTROLLER = "controller";
/// Section of an arm's launch file, with input/mode as a default. It is separate because roslaunch would merge
/// input/mode into a user's invalid `input: 3`, which would hide the error.
constexpr const char* LAUNCH = "launch";

/// Reads all other parameters in `parameter_namespace` (`section/key`) from the server with their types. Unknown keys
/// are included, so that `parseParameters` finds them, and there are no defaults.
/// @throws ParameterError on a value that no parameter can have, for example a list with a text.
ParameterMap readParameterServer(const std::string& parameter_namespace);

/// Writes all parameters in `parameter_namespace`; each section replaces one of its name.
void writeParameterServer(const std::string& parameter_namespace, const ParameterMap& map);

/// Parameters on the server that the node's own start did not set. They may be those of an earlier launch, because a
/// server outlives its nodes.
class FoundParameters
{
public:
  /// Argument from a launch file with clear_params="true": all parameters on the server are of the node's own launch.
  static constexpr const char* CLEARED = "--params-cleared";
  static constexpr std::size_t MAX_NAMED = 12;

  /// Takes the command line, before ros::init removes `_section/key:=value` from it.
  FoundParameters(int argc, const char* const* argv);

  /// Whether the command line sets all of `map`.
  bool areGiven(const ParameterMap& map) const;

  /// Texts `section/key = value` of parameters that differ from all of `shipped`, the first MAX_NAMED by name; empty:
  /// none.
  std::string departures(const std::string& parameter_namespace, const std::vector<ParameterMap>& shipped) const;

private:
  bool is_cleared_ = false;
  std::set<std::string> given_;  // keys on the command line
};
}  // namespace hjt
