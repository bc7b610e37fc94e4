// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/controller_table.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "base/csv_table.hpp"
#include "base/statistics.hpp"
#include "base/text.hpp"
#include "recordings/recording_options.hpp"

namespace hjt
{
namespace
{
constexpr const char* TIME = "timestamp";

bool beginsWith(const std::string& text, const std::string& begin)
{
  return text.compare(0, begin.size(), begin) == 0;
}

/// Converts a PlotJuggler name of a column, TOPIC/NAME/quantity, to a controller's name. Other names are not changed.
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
    // A driver may put a prefix before the name of a joint.
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

constexpr std::size_t JOINTS = 6;
constexpr std::size_t COLUMNS = 4 * JOINTS;

/// Index of the first column of each quantity in a row. A quantity has one column for each joint.
enum Column : std::size_t
{
  CURRENT = 0,
  MOMENT = JOINTS,
  TARGET_SPEED = 2 * JOINTS,
  SPEED = 3 * JOINTS
};

NumberTable<COLUMNS>::Names columnNames()
{
  NumberTable<COLUMNS>::Names names;
  for (std::size_t joint = 0; joint < JOINTS; ++joint)
  {
    const std::string number = std::to_string(joint);
    names[CURRENT + joint] = "target_current_" + number;
    names[MOMENT + joint] = "target_moment_" + number;
    names[TARGET_SPEED + joint] = "target_qd_" + number;
    names[SPEED + joint] = "actual_qd_" + number;
  }
  return names;
}

/// Whether the arm is at rest, according to the target speeds or, if these are not recorded, to the measured speeds.
bool isAtRest(const std::array<double, COLUMNS>& row)
{
  constexpr double STILL = 1e-3;  // largest speed at rest [rad/s]
  for (std::size_t joint = 0; joint < JOINTS; ++joint)
  {
    const double target = row[TARGET_SPEED + joint];
    if (!(std::abs(std::isnan(target) ? row[SPEED + joint] : target) < STILL))
    {
      return false;
    }
  }
  return true;
}

/// Median of the ratios; NaN if the ratios disagree, or if too few of the `rows` rows at rest have a ratio.
double agreedRatio(std::vector<double>& ratios, std::size_t rows)
{
  constexpr std::size_t LEAST = 10;
  constexpr std::size_t SHARE = 5;  // largest number of rows at rest for each row with a ratio
  // Largest median deviation of the ratios over their median [-]; a controller computes both columns with one gain.
  constexpr double AGREE = 0.005;
  if (ratios.size() < std::max(LEAST, rows / SHARE))
  {
    return std::numeric_limits<double>::quiet_NaN();
  }
  const double middle = upperMedian(ratios.begin(), ratios.end());
  for (double& ratio : ratios)
  {
    ratio = std::abs(ratio - middle);
  }
  return middle > 0.0 && upperMedian(ratios.begin(), ratios.end()) < AGREE * middle ?
             middle :
             std::numeric_limits<double>::quiet_NaN();
}

std::vector<double> readStatedGains(const MotionSource& source)
{
  constexpr int ROWS = 50000;             // number of rows that are read: 100 s at 500 Hz
  constexpr double LEAST_CURRENT = 0.01;  // least current [A] whose recorded digits are precise enough for a ratio
  constexpr double WIDEST = 100.0;        // largest plausible ratio of torque to current [N.m/A]
  NumberTable<COLUMNS> table(source.path, columnNames(), COLUMNS, COLUMNS, controllerColumns);
  if (!table.hasColumn(CURRENT) || !table.hasColumn(MOMENT))
  {
    return {};
  }
  table.allowCutOff();
  table.allowUneven();
  std::array<double, COLUMNS> row;
  row.fill(std::numeric_limits<double>::quiet_NaN());
  std::array<std::vector<double>, JOINTS> ratios;
  std::size_t at_rest = 0;
  for (int i = 0; i < ROWS && table.read(row); ++i)
  {
    if (!isAtRest(row))
    {
      continue;
    }
    ++at_rest;
    for (std::size_t joint = 0; joint < JOINTS; ++joint)
    {
      const double ratio = row[MOMENT + joint] / row[CURRENT + joint];
      if (std::abs(row[CURRENT + joint]) > LEAST_CURRENT && std::abs(ratio) < WIDEST)
      {
        ratios[joint].push_back(ratio);
      }
    }
  }
  std::vector<double> gains(JOINTS);
  for (std::size_t joint = 0; joint < JOINTS; ++joint)
  {
    gains[joint] = agreedRatio(ratios[joint], at_rest);
  }
  return gains;
}

std::optional<Payload> readStatedPayload(const MotionSource& source)
{
  constexpr std::size_t VALUES = 4;
  using Row = std::array<double, VALUES>;
  NumberTable<VALUES> table(source.path, { "payload", "payload_cog_0", "payload_cog_1", "payload_cog_2" }, VALUES,
                            VALUES);
  if (!table.hasColumn(0))
  {
    return std::nullopt;
  }
  table.allowCutOff();
  table.allowUneven();
  std::optional<Row> stated;
  Row row{};
  while (table.read(row))
  {
    const bool is_whole = std::all_of(row.begin(), row.end(), [](double value) { return std::isfinite(value); });
    if (is_whole && stated && row != *stated)
    {
      return std::nullopt;
    }
    stated = is_whole ? row : stated;
  }
  if (!stated)
  {
    return std::nullopt;
  }
  const Payload payload{ (*stated)[0], { (*stated)[1], (*stated)[2], (*stated)[3] } };
  return payloadErrors(payload).empty() ? std::make_optional(payload) : std::nullopt;
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
    return "it is a table of `rostopic echo -p`, in which joint names and the unit of the time are unclear; give "
           "the bag itself, or record one: `rosbag record /joint_states`";
  }
  if (holds(header, "header.seq") || holds(header, "header.stamp.secs") || holds(header, "header.stamp.sec"))
  {
    return "it is a table of messages, as bagpy makes of a bag; give the bag itself";
  }
  if (holds(header, "position") && holds(header, "effort"))
  {
    return "it has lists in its cells; give a table with columns for each joint, or the bag that it was made from";
  }
  return {};
}

RecordedStatements readStatements(const MotionSource& source, bool of_arm)
{
  RecordedStatements stated{ recordsLoad(source), {}, {} };
  if (of_arm && isCsv(source))
  {
    stated.gains = readStatedGains(source);
    stated.payload = readStatedPayload(source);
  }
  return stated;
}
}  // namespace hjt
