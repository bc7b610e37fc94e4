// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "base/csv_table.hpp"
#include "base/text.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "recordings/controller_table.hpp"
#include "recordings/motion_readers.hpp"
#include "tracking/drive_temperature.hpp"
#include "tracking/telemetry_rows.hpp"

namespace hjt
{
namespace
{
constexpr std::size_t JOINTS = 6;
constexpr double LATEST = 9e9;  // largest time that a stamp can have [s]

/// Quantities of a joint that have a column. Angle and current are required.
enum Quantity : std::size_t
{
  ANGLE,
  CURRENT,
  MOMENT,
  VELOCITY,
  TEMPERATURE,
  TARGET_CURRENT,
  QUANTITIES
};

constexpr std::array<const char*, QUANTITIES> NAMES{ "actual_q_",  "actual_current_",     "target_moment_",
                                                     "actual_qd_", "joint_temperatures_", "target_current_" };

/// Columns of COUNT joints in a controller's table.
template <std::size_t COUNT>
class JointTable
{
public:
  static constexpr std::size_t COLUMNS = 1 + QUANTITIES * COUNT;

  explicit JointTable(const MotionSource& source)
    // A value that is not a number makes its row useless, but not the file.
    : names_(names(source)), table_(source.path, names_, COLUMNS - 1 - 2 * COUNT, COLUMNS, controllerColumns)
  {
    table_.allowCutOff();
    table_.allowUneven();
    values_.fill(std::nan(""));
    std::fill_n(values_.begin() + column(MOMENT, 0), COUNT, 0.0);
  }

  bool read()
  {
    if (!table_.read(values_))
    {
      return false;
    }
    for (std::size_t i = 0; i < COUNT; ++i)
    {
      values_[column(CURRENT, i)] = is_silent_[i] ? 0.0 : values_[column(CURRENT, i)];
    }
    for (std::size_t i = 0; i < column(VELOCITY, 0); ++i)
    {
      was_finite_[i] = was_finite_[i] || std::isfinite(values_[i]);
    }
    return true;
  }
  double time() const { return values_[0]; }
  double value(Quantity quantity, std::size_t joint) const { return values_[column(quantity, joint)]; }
  bool has(Quantity quantity, std::size_t joint) const { return table_.hasColumn(column(quantity, joint)); }
  const std::string& name(Quantity quantity, std::size_t joint) const { return names_[column(quantity, joint)]; }
  std::string place() const { return table_.place(); }
  bool wasCutOff() const { return table_.wasCutOff(); }
  std::string unevenText() const { return table_.unevenText(); }

  bool isWhole() const
  {
    const auto is_finite = [](double value) { return std::isfinite(value); };
    return std::all_of(values_.begin(), values_.begin() + column(VELOCITY, 0), is_finite);
  }

  /// Sets the currents of these joints to 0 in all rows that are read from now on.
  void silence(const std::array<bool, COUNT>& joints) { is_silent_ = joints; }

  /// Names of required columns without a number in any row.
  std::vector<std::string> neverFinite() const
  {
    std::vector<std::string> never;
    for (std::size_t i = 0; i < column(VELOCITY, 0); ++i)
    {
      if (!was_finite_[i])
      {
        never.push_back("'" + names_[i] + "'");
      }
    }
    return never;
  }

  /// Adds 1 to the entry in `missing` of each required column without a number in the present row.
  void addMissing(std::map<std::string, std::uint64_t>& missing) const
  {
    for (std::size_t i = 0; i < column(VELOCITY, 0); ++i)
    {
      missing[names_[i]] += std::isfinite(values_[i]) ? 0 : 1;
    }
  }

  bool isWithoutCurrent() const
  {
    const auto is_zero = [](double value) { return value == 0.0; };
    return std::all_of(values_.begin() + column(CURRENT, 0), values_.begin() + column(MOMENT, 0), is_zero);
  }

private:
  static constexpr std::size_t column(std::size_t quantity, std::size_t joint) { return 1 + quantity * COUNT + joint; }

  static typename NumberTable<COLUMNS>::Names names(const MotionSource& source)
  {
    typename NumberTable<COLUMNS>::Names names{ "timestamp" };
    for (std::size_t joint = 0; joint < COUNT; ++joint)
    {
      for (std::size_t quantity = 0; quantity < QUANTITIES; ++quantity)
      {
        names[column(quantity, joint)] =
            NAMES[quantity] + std::to_string(COUNT == 1 ? source.csv_joint : static_cast<int>(joint));
      }
    }
    return names;
  }

  typename NumberTable<COLUMNS>::Names names_;
  NumberTable<COLUMNS> table_;
  std::array<double, COLUMNS> values_{};
  std::array<bool, COLUMNS> was_finite_{};
  std::array<bool, COUNT> is_silent_{};
};

/// Properties of a table's currents, from all rows of the table.
template <std::size_t COUNT>
struct CurrentsSeen
{
  explicit CurrentsSeen(const MotionSource& source)
  {
    if (COUNT == 1)
    {
      return;
    }
    JointTable<COUNT> table(source);
    is_silent.fill(true);
    while (table.read() && !(has_any && isComplete()))
    {
      has_any = has_any || !table.isWithoutCurrent();
      for (std::size_t i = 0; i < COUNT; ++i)
      {
        is_silent[i] = is_silent[i] && !std::isfinite(table.value(CURRENT, i));
      }
    }
    if (std::all_of(is_silent.begin(), is_silent.end(), [](bool silent) { return silent; }))
    {
      is_silent.fill(false);  // no row is readable if no joint has a current
    }
  }

  bool isComplete() const
  {
    return std::none_of(is_silent.begin(), is_silent.end(), [](bool silent) { return silent; });
  }

  /// Whether at least one row has a current other than zero; rows without currents are then failed readings. False for
  /// one joint.
  bool has_any{};
  std::array<bool, COUNT>
      is_silent{};  ///< whether the joint's effort is never a number, while the efforts of other joints are numbers
};

template <std::size_t COUNT>
class TableMotion
{
public:
  explicit TableMotion(const MotionSource& source)
    : source_(source), table_(source), angles_(COUNT), rows_(COUNT), temperatures_(COUNT)
  {
  }

  MotionCount read(const VisitMotionRows& visit)
  {
    const CurrentsSeen<COUNT> seen(source_);
    table_.silence(seen.is_silent);
    bool more = true;
    while (more && table_.read())
    {
      if (!table_.isWhole() || (seen.has_any && table_.isWithoutCurrent()))
      {
        ++count_.corrupt;
        table_.addMissing(missing_);
        continue;
      }
      more = take(visit);
    }
    if (count_.rows == 0)
    {
      throw InputError(source_.path + " has no rows" + whyNone());
    }
    finish();
    std::vector<std::string> silent;
    for (std::size_t i = 0; i < COUNT; ++i)
    {
      if (seen.is_silent[i])
      {
        silent.push_back(table_.name(CURRENT, i));
      }
    }
    count_.remark(silentText(silent));
    return count_;
  }

private:
  bool take(const VisitMotionRows& visit)
  {
    const double seconds = source_.time_scale * table_.time();
    const Stamp stamp = std::llround(1e9 * std::clamp(seconds, -LATEST, LATEST));
    if (count_.rows++ == 0)
    {
      count_.start = stamp;
      first_ = table_.time();
    }
    // In the first round of RowTime, times are differences of the file's numbers, without rounding to nanoseconds.
    const double by_stamps = times_.at(stamp);
    const double time = times_.rounds() == 1 ? source_.time_scale * (table_.time() - first_) : by_stamps;
    order_.add(seconds);
    count_.duration = std::max(count_.duration, time);
    for (std::size_t i = 0; i < COUNT; ++i)
    {
      rows_[i] = { time, angles_[i].take(time, table_.value(ANGLE, i)),
                   source_.current_per_effort * table_.value(CURRENT, i), table_.value(MOMENT, i) };
      rows_[i].received = time;
      rows_[i].recorded_velocity = table_.value(VELOCITY, i);
      rows_[i].target_current = source_.current_per_effort * table_.value(TARGET_CURRENT, i);
      if (table_.has(TEMPERATURE, i))
      {
        temperatures_[i].push(time, table_.value(TEMPERATURE, i));
        rows_[i].temperature = temperatures_[i].at(time);
      }
    }
    return visit(rows_);
  }

  std::string whyNone() const
  {
    if (count_.corrupt == 0)
    {
      return {};
    }
    const std::vector<std::string> never = table_.neverFinite();
    const std::string uneven = table_.unevenText();
    if (never.size() > 2 * COUNT && !uneven.empty())  // all columns of time, angle and current
    {
      return "; " + uneven;
    }
    const std::string rows = "; none of " + std::to_string(count_.corrupt) + " rows holds ";
    return never.empty() ? rows + "finite numbers in all columns of time, angle and current" :
                           rows + "a finite number in " + joined(never) +
                               (never.front() == "'timestamp'" ? ": the time has to be a number, in s" : "");
  }

  void finish()
  {
    for (const TemperatureRecord& temperatures : temperatures_)
    {
      count_.refused_temperatures += temperatures.refused();
    }
    if (table_.wasCutOff())
    {
      count_.remark("the last line is cut off and was skipped (" + table_.place() + ")");
    }
    count_.remark(missingText(missing_, count_));
    remarkOnRounds(angles_, times_.rounds(), count_);
    count_.misfit = { Reason::STAMPS, order_.text() };
  }

  const MotionSource& source_;
  JointTable<COUNT> table_;
  std::vector<UnfoldedAngle> angles_;
  std::vector<MotionRow> rows_;
  std::vector<TemperatureRecord> temperatures_;
  std::map<std::string, std::uint64_t> missing_;  // number of rows without a number, by the name of the column
  RowTime times_;
  RowOrder order_;
  double first_{};
  MotionCount count_;
};
}  // namespace

void remarkOnRounds(const std::vector<UnfoldedAngle>& angles, std::uint64_t rounds, MotionCount& count)
{
  std::uint64_t folds = 0;
  for (const UnfoldedAngle& angle : angles)
  {
    folds += angle.folds();
  }
  if (folds > 0)
  {
    count.remark("angles are folded into one turn; " + std::to_string(folds) + " jumps of 2 pi were removed");
  }
  if (rounds > 1)
  {
    count.remark("stamps jump back, or ahead by days, " + std::to_string(rounds - 1) +
                 " times, as in a recording that was played in a loop; the " + std::to_string(rounds) +
                 " rounds are read one after the other");
  }
}

std::string missingText(const std::map<std::string, std::uint64_t>& missing, const MotionCount& count)
{
  constexpr double NOTEWORTHY = 0.02;  // least share of affected rows that a remark needs [-]
  const auto all = static_cast<double>(count.rows + count.corrupt);
  std::vector<std::string> names;
  for (const auto& [name, rows] : missing)
  {
    if (static_cast<double>(rows) > NOTEWORTHY * all)
    {
      names.push_back(name + " in " + std::to_string(rows));
    }
  }
  return names.empty() ? std::string() :
                         "rows without a number were skipped: " + joined(names) + " of " +
                             std::to_string(count.rows + count.corrupt) + " rows";
}

std::string silentText(const std::vector<std::string>& joints)
{
  return joints.empty() ? std::string() :
                          "the effort of " + joined(joints) +
                              " is never a number, so it counts as 0, and only the other joints are judged";
}

MotionCount readTableMotion(const MotionSource& source, std::size_t joints, const VisitMotionRows& visit,
                            const std::function<void(double)>& progress)
{
  if (joints != 1 && joints != JOINTS)
  {
    throw InputError(source.path + ": a controller's CSV recording has " + std::to_string(JOINTS) +
                     " joints, the arm has " + std::to_string(joints));
  }
  if (source.csv_joint == NO_COLUMNS)
  {
    throw InputError(source.path +
                     ": the joints of a controller's CSV recording are base, shoulder, elbow, wrist_1, "
                     "wrist_2, wrist_3, or 0 to 5, not '" +
                     source.joint + "'");
  }
  const MotionCount count = joints == 1 ? TableMotion<1>(source).read(visit) : TableMotion<JOINTS>(source).read(visit);
  progress(1.0);
  return count;
}

bool tableRecordsLoad(const MotionSource& source)
{
  const CsvRows rows(source.path);  // the reader of the rows reports a missing file
  const std::string foreign = foreignTable(rows.header());
  if (!foreign.empty())
  {
    throw InputError(source.path + ": " + foreign);
  }
  const std::string name = NAMES[MOMENT] + std::to_string(source.csv_joint);
  return std::find(rows.header().begin(), rows.header().end(), name) != rows.header().end();
}

MotionCount readArrayMotion(const MotionSource& source, std::size_t joints, const VisitMotionRows& visit,
                            const std::function<void(double)>& progress)
{
  MotionCount count;
  std::vector<UnfoldedAngle> angles(joints);
  RowTime times;
  RowOrder order;
  SourceWatch sources;
  std::vector<MotionRow> rows;
  for (const std::vector<MotionRow>& row : *source.rows)
  {
    if (row.size() != joints)
    {
      throw InputError(source.path + " has " + std::to_string(row.size()) +
                       " joints, expected: " + std::to_string(joints));
    }
    progress(static_cast<double>(++count.rows) / static_cast<double>(source.rows->size()));
    const double seconds = source.time_scale * row.front().time;
    if (!(std::abs(seconds) < MAX_TIME))
    {
      ++count.corrupt;
      continue;
    }
    const double by_stamps = times.at(std::llround(1e9 * seconds));
    // In the first round of RowTime, times are the numbers in the array, without rounding to nanoseconds.
    const double time = times.rounds() == 1 ? seconds : by_stamps;
    order.add(seconds);
    count.duration = std::max(count.duration, time);
    rows = row;
    for (std::size_t i = 0; i < joints; ++i)
    {
      rows[i].time = rows[i].received = time;
      rows[i].position = angles[i].take(time, row[i].position);
    }
    sources.add("", rows);
    if (!visit(rows))
    {
      break;
    }
  }
  remarkOnRounds(angles, times.rounds(), count);
  count.misfit = { Reason::TWO_SOURCES, sources.text() };
  if (!count.misfit.exists())
  {
    count.misfit = { Reason::STAMPS, order.text() };
  }
  return count;
}
}  // namespace hjt
