// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <set>
#include <string>
#include <vector>

#include "harmonic_joint_twin/params/parameter_map.hpp"

namespace hjt
{
/// Parameters of an arm's node beside those of its drives: name or file of the arm; directory of overlays that
/// `joint_twin identify --arm` wrote; reports of the sound arm that `joint_twin compare --arm` wrote, directories or
/// files in them, with commas between them; name of the parameter that holds another URDF of it; what stands around the
/// names; faults of an arm without a robot, JOINT:KIND:SEVERITY[:PLACE[:ONSET]], with commas between them; name of its
/// controller, below which its action stands.
constexpr const char* ARM = "arm";
constexpr const char* IDENTIFIED = "identified";
constexpr const char* REFERENCE = "reference";
constexpr const char* DESCRIPTION = "description";
constexpr const char* PREFIX = "prefix";  ///< before the arm's names of the joints in the messages
constexpr const char* SUFFIX = "suffix";  ///< behind them
constexpr const char* FAULT = "fault";
constexpr const char* CONTROLLER = "controller";
/// Section of what an arm's launch file sets, launch/input/mode: counts where nothing else says it. Of a user's file
/// with `input: 3` roslaunch would make `input: {mode: ...}`, were it input/mode.
constexpr const char* LAUNCH = "launch";

/// Reads every other parameter below `parameter_namespace` (`section/key`) from the server; types are kept as they
/// are. Nothing is left out, so that `parseParameters` finds unknown keys; nothing is defaulted.
/// @throws ParameterError on a value that no parameter can have, e.g. a list with a text in it.
ParameterMap readParameterServer(const std::string& parameter_namespace);

/// Puts all parameters below `parameter_namespace`, each section in place of that of its name.
void writeParameterServer(const std::string& parameter_namespace, const ParameterMap& map);

/// Parameters that a node finds on the server and that its start did not set: a server outlives its nodes, so they may
/// be those of an earlier launch.
class FoundParameters
{
public:
  /// Argument of a node whose launch file says clear_params="true": what it finds is of its own launch.
  static constexpr const char* CLEARED = "--params-cleared";
  static constexpr std::size_t MAX_NAMED = 12;

  /// The command line, before ros::init takes `_section/key:=value` out of it.
  FoundParameters(int argc, const char* const* argv);

  /// Whether the command line gave all of `map`.
  bool areGiven(const ParameterMap& map) const;

  /// `section/key = value` of those that depart from one of `shipped`, the first MAX_NAMED by name; empty: none.
  std::string departures(const std::string& parameter_namespace, const std::vector<ParameterMap>& shipped) const;

private:
  bool is_cleared_ = false;
  std::set<std::string> given_;  // keys on the command line
};
}  // namespace hjt
