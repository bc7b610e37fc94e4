// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <set>

#include "bags/recorded_messages.hpp"
#include "base/number_text.hpp"
#include "base/text.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "messages/joint_affixes.hpp"
#include "recordings/message_rows.hpp"
#include "recordings/motion_readers.hpp"

namespace hjt
{
namespace
{
/// Combines rows that hold parts of an arm's joints into rows of all joints, at the times of the first part.
class SideBySide
{
public:
  SideBySide(const std::vector<std::vector<std::size_t>>& parts, std::size_t joints, const VisitMotionRows& visit)
    : parts_(parts), waiting_(parts.size()), rows_(joints), visit_(visit)
  {
  }

  void clear()
  {
    for (auto& rows : waiting_)
    {
      rows.clear();
    }
  }

  /// Adds rows of the joints of one part. Returns false if the visitor wants no more rows.
  bool add(std::size_t part, const std::vector<MotionRow>& rows)
  {
    waiting_[part].push_back(rows);
    while (!waiting_[0].empty() && areReady(waiting_[0].front().front().time))
    {
      const std::vector<MotionRow> base = std::move(waiting_[0].front());
      waiting_[0].pop_front();
      place(0, base);
      bool is_complete = true;
      for (std::size_t other = 1; other < parts_.size() && is_complete; ++other)
      {
        is_complete = placeAt(other, base.front());
      }
      ++(is_complete ? complete_ : dropped_);
      if (is_complete && !visit_(rows_))
      {
        return false;
      }
    }
    return true;
  }

  std::uint64_t complete() const { return complete_; }
  std::uint64_t dropped() const { return dropped_; }

private:
  /// Whether every part after the first has a row at `time` or later.
  bool areReady(double time) const
  {
    return std::all_of(waiting_.begin() + 1, waiting_.end(),
                       [&](const auto& rows) { return !rows.empty() && rows.back().front().time >= time; });
  }

  void place(std::size_t part, const std::vector<MotionRow>& rows)
  {
    for (std::size_t i = 0; i < rows.size(); ++i)
    {
      rows_[parts_[part][i]] = rows[i];
    }
  }

  /// Interpolates the rows of `part` linearly at the time of `base`. Returns false in a gap or outside of the rows.
  bool placeAt(std::size_t part, const MotionRow& base)
  {
    auto& rows = waiting_[part];
    while (rows.size() > 1 && rows[1].front().time <= base.time)
    {
      rows.pop_front();
    }
    if (rows.front().front().time > base.time)
    {
      return false;
    }
    std::vector<MotionRow> between = rows.front();
    const double step = rows.size() > 1 ? rows[1].front().time - between.front().time : 0.0;
    const double passed = base.time - between.front().time;
    if (passed > 0.0 && (step <= 0.0 || step > MotionDifferentiator::MAX_GAP))
    {
      return false;
    }
    for (std::size_t i = 0; i < between.size() && passed > 0.0; ++i)
    {
      const auto to = [&](double& from, double next) { from += passed / step * (next - from); };
      const MotionRow& next = rows[1][i];
      to(between[i].position, next.position);
      to(between[i].current, next.current);
      to(between[i].load, next.load);
      to(between[i].motor_angle, next.motor_angle);
      to(between[i].recorded_velocity, next.recorded_velocity);
      between[i].time = base.time;
      between[i].received = base.received;
    }
    place(part, between);
    return true;
  }

  const std::vector<std::vector<std::size_t>>& parts_;
  std::vector<std::deque<std::vector<MotionRow>>> waiting_;
  std::vector<MotionRow> rows_;
  const VisitMotionRows& visit_;
  std::uint64_t complete_{};
  std::uint64_t dropped_{};
};

/// Names and fields of the joints that the messages of a topic hold, for the text of an error.
class SeenNames
{
public:
  explicit SeenNames(const std::vector<std::string>& joints) : joints_(joints), incomplete_(joints.size()) {}

  void add(const sensor_msgs::JointState& state)
  {
    for (const std::string& name : state.name)
    {
      if (!holds(names_, name) && names_.size() < MOST)
      {
        names_.push_back(name);
      }
    }
    for (std::size_t i = 0; i < joints_.size(); ++i)
    {
      const std::size_t place = placeOf(state, joints_[i]);
      if (place < state.name.size())
      {
        Incomplete& joint = incomplete_[i];
        joint.angle = joint.angle || place < state.position.size();
        joint.effort = joint.effort || place < state.effort.size();
        joint.together = joint.together || place < std::min(state.position.size(), state.effort.size());
        joint.finite = joint.finite || (place < std::min(state.position.size(), state.effort.size()) &&
                                        std::isfinite(state.position[place]) && std::isfinite(state.effort[place]));
      }
    }
  }

  std::string text(const std::string& topic) const
  {
    static constexpr std::array WHY{ "", "; their position is empty",
                                     "; their effort is empty, but must hold the motors' currents",
                                     "; position and effort of a joint are never in the same message, but must be",
                                     "; the values of these joints are not finite (NaN)" };
    std::array<std::vector<std::string>, WHY.size()> joints;
    for (std::size_t i = 0; i < joints_.size(); ++i)
    {
      const Incomplete& joint = incomplete_[i];
      if (!joint.finite)
      {
        joints[!holds(names_, joints_[i]) ? 0 :
               !joint.angle               ? 1 :
               !joint.effort              ? 2 :
               !joint.together            ? 3 :
                                            4]
            .push_back(joints_[i]);
      }
    }
    std::vector<std::string> all;
    std::string why;
    for (std::size_t k = 0; k < WHY.size(); ++k)
    {
      all.insert(all.end(), joints[k].begin(), joints[k].end());
      why += joints[k].empty() ? "" : WHY[k];
    }
    std::vector<std::string> found = names_;
    std::sort(found.begin(), found.end());
    std::string text = topic + " never contains angle and effort of " + joined(all) +
                       "; joints found: " + (found.empty() ? "none" : joined(found)) + why;
    for (const JointAffixes& affixes : findAffixes(joints_, names_))
    {
      text += affixes.empty() ? "" : "; with" + optionsOf(affixes) + " the joints are found";
    }
    return text;
  }

private:
  static constexpr std::size_t MOST = 100;

  struct Incomplete
  {
    bool angle{};
    bool effort{};
    bool together{};  // whether one message has both angle and effort of the joint
    bool finite{};
  };

  const std::vector<std::string>& joints_;
  std::vector<std::string> names_;
  std::vector<Incomplete> incomplete_;
};

/// The number of rows, followed by `text`; empty if the number is 0.
std::string counted(std::uint64_t rows, const std::string& text)
{
  return rows == 0 ? "" : std::to_string(rows) + (rows == 1 ? " row " : " rows ") + text;
}

class MessageMotion
{
public:
  MessageMotion(RecordedMessages& recording, const MotionSource& source, const std::vector<std::string>& names,
                const VisitMotionRows& visit)
    : recording_(recording)
    , source_(source)
    , names_(names)
    , seen_(names)
    , layout_(readLayout(recording, source, names))
    , side_by_side_(layout_.parts, names.size(), visit)
  {
    for (std::size_t i = 0; i < layout_.parts.size(); ++i)
    {
      std::vector<std::string> of_part;
      for (const std::size_t joint : layout_.parts[i])
      {
        of_part.push_back(names[joint]);
      }
      parts_.push_back(std::make_unique<MessageRows>(source, of_part, layout_,
                                                     [this, i](const StampedRows& rows) { return take(i, rows); }));
    }
  }

  MotionCount read(const std::function<void(double)>& progress)
  {
    bool more = true;
    recording_.visit(
        topics(), true,
        [&](const RecordedMessage& message)
        {
          if (message.state != nullptr && message.topic == source_.topic && !start_)
          {
            seen_.add(*message.state);
          }
          for (const auto& part : parts_)
          {
            more = more && part->read(message);
          }
          return more;
        },
        progress);
    std::size_t joints = 0;
    for (std::size_t i = 0; i < parts_.size(); ++i)
    {
      more = more && parts_[i]->flush();
      joints += layout_.parts[i].size();
    }
    if (!start_ || joints < names_.size())
    {
      const bool are_short =
          std::any_of(parts_.begin(), parts_.end(), [](const auto& part) { return part->hasShortEfforts(); });
      throw InputError(
          are_short ? source_.topic +
                          ": the messages have fewer efforts than names, so it is not "
                          "known which joint an effort belongs to; each joint that a message names needs an effort" :
                      seen_.text(source_.topic));
    }
    finish();
    if (count_.rows == 0)
    {
      throw InputError(source_.topic + ": the joints come in several messages, which are never less than " +
                       numberText(MotionDifferentiator::MAX_GAP) + " s apart: " + joined(names_));
    }
    return count_;
  }

private:
  std::vector<std::string> topics() const
  {
    const auto& known = recording_.topics();
    const auto load = known.find(source_.load_topic);
    return load == known.end() || source_.load_topic == source_.topic ?
               std::vector<std::string>{ source_.topic } :
               std::vector<std::string>{ source_.topic, source_.load_topic };
  }

  bool take(std::size_t part, const StampedRows& held)
  {
    if (!start_)
    {
      start_ = count_.start = held.stamp;
      count_.least_delay = count_.most_delay = held.delay();
    }
    std::vector<MotionRow> rows = held.rows;
    const std::uint64_t rounds = time_.rounds();
    const double time = time_.at(held.stamp);
    if (time_.rounds() != rounds)
    {
      side_by_side_.clear();
    }
    orders_[part].add(toSeconds(held.stamp - *start_));
    for (MotionRow& row : rows)
    {
      row.time = time;
      row.received = time_.received(held.recorded);
    }
    count_.duration = std::max(count_.duration, time);
    count_.least_delay = std::min(count_.least_delay, held.delay());
    count_.most_delay = std::max(count_.most_delay, held.delay());
    return side_by_side_.add(part, rows);
  }

  void finish()
  {
    std::uint64_t without_time = 0;
    std::uint64_t without_effort = 0;
    std::vector<UnfoldedAngle> angles;
    std::map<std::string, std::uint64_t> missing;
    for (const auto& rows : parts_)
    {
      count_.corrupt = std::max(count_.corrupt, rows->corrupt());
      without_time += rows->withoutTime();
      without_effort += rows->withoutEffort();
      angles.insert(angles.end(), rows->angles().begin(), rows->angles().end());
      missing.insert(rows->missing().begin(), rows->missing().end());
      count_.refused_temperatures += rows->refusedTemperatures();
      count_.misfit = count_.misfit.exists() ? count_.misfit : Misfit{ Reason::TWO_SOURCES, rows->sources().text() };
    }
    for (const auto& [part, order] : orders_)
    {
      count_.misfit = count_.misfit.exists() ? count_.misfit : Misfit{ Reason::STAMPS, order.text() };
    }
    count_.rows = side_by_side_.complete();
    count_.corrupt += side_by_side_.dropped() + without_effort;
    count_.remark(recording_.remark());
    count_.remark(counted(without_time, "without a time were skipped, because their stamp is 0"));
    count_.remark(counted(without_effort, "with effort 0 were skipped, because their source had no values"));
    count_.remark(silentText({ layout_.silent.begin(), layout_.silent.end() }));
    count_.remark(missingText(missing, count_));
    remarkOnRounds(angles, time_.rounds(), count_);
    if (parts_.size() > 1)
    {
      count_.remark("the joints come in " + std::to_string(parts_.size()) +
                    " messages, whose values are interpolated linearly to the same times");
    }
  }

  RecordedMessages& recording_;
  const MotionSource& source_;
  const std::vector<std::string>& names_;
  SeenNames seen_;
  const TopicLayout layout_;
  SideBySide side_by_side_;
  std::vector<std::unique_ptr<MessageRows>> parts_;
  std::map<std::size_t, RowOrder> orders_;
  RowTime time_;
  std::optional<Stamp> start_;
  MotionCount count_;
};
}  // namespace

MotionCount readMessageMotion(const MotionSource& source, const std::vector<std::string>& names,
                              const VisitMotionRows& visit, const std::function<void(double)>& progress)
{
  const std::unique_ptr<RecordedMessages> recording = RecordedMessages::open(source.path);
  recording->requireStates(source.topic);
  return MessageMotion(*recording, source, names, visit).read(progress);
}
}  // namespace hjt
