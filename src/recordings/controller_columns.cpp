// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/controller_columns.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <set>
#include <utility>

#include "recordings/recording_options.hpp"

namespace hjt
{
namespace
{
constexpr const char* TIME = "timestamp";

bool holds(const std::vector<std::string>& header, const std::string& name)
{
  return std::find(header.begin(), header.end(), name) != header.end();
}

bool beginsWith(const std::string& text, const std::string& begin)
{
  return text.compare(0, begin.size(), begin) == 0;
}

/// TOPIC/NAME/quantity; other names stay.
std::string ofPlotJuggler(const std::string& column)
{
  static const std::array<std::pair<const char*, const char*>, 3> QUANTITIES{
    { { "position", "actual_q_" }, { "velocity", "actual_qd_" }, { "effort", "actual_current_" } }
  };
  const std::size_t last = column.rfind('/');
  const std::size_t before = last == std::string::npos || last == 0 ? last : column.rfind('/', last - 1);
  if (before == std::string::npos || last == 0)
  {
    return column;
  }
  for (const auto& [quantity, controllers] : QUANTITIES)
  {
    if (column.substr(last + 1) != quantity)
    {
      continue;
    }
    std::string name = column.substr(before + 1, last - before - 1);
    // A driver puts a prefix before the name.
    for (std::size_t at = 0; at != std::string::npos; at = name.find('_', at + 1))
    {
      const std::optional<UrJoint> joint = findUrJoint(at == 0 ? name : name.substr(at + 1));
      if (joint && joint->name == (at == 0 ? name : name.substr(at + 1)))
      {
        return controllers + std::to_string(joint->number);
      }
    }
  }
  return column;
}
}  // namespace

std::vector<std::string> controllerColumns(std::vector<std::string> header)
{
  static const std::set<std::string> TIMES{ "time", "Time", "t", "__time" };
  const auto is_time = [&](const std::string& name) { return TIMES.count(name) != 0; };
  if (!holds(header, TIME) && std::count_if(header.begin(), header.end(), is_time) == 1)
  {
    *std::find_if(header.begin(), header.end(), is_time) = TIME;
  }
  std::transform(header.begin(), header.end(), header.begin(), ofPlotJuggler);
  return header;
}

std::string foreignTable(const std::vector<std::string>& header)
{
  if (std::any_of(header.begin(), header.end(), [](const std::string& name) { return beginsWith(name, "field."); }))
  {
    return "it is a table of `rostopic echo -p`, which the joints' names and the unit of the time leave unclear; give "
           "the bag itself, or record one: `rosbag record /joint_states`";
  }
  if (holds(header, "header.seq") || holds(header, "header.stamp.secs") || holds(header, "header.stamp.sec"))
  {
    return "it is a table of messages, as bagpy makes of a bag; give the bag itself";
  }
  if (holds(header, "position") && holds(header, "effort"))
  {
    return "it has lists in its cells; each joint needs columns of its own, or give the bag that it was made of";
  }
  return {};
}
}  // namespace hjt
