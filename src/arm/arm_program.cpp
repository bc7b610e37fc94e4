// SPDX-License-Identifier: BSD-3-Clause
#include "arm/arm_program.hpp"

#include <utility>

#include "arm/arm_file.hpp"
#include "arm/check_up.hpp"
#include "arm/set_points.hpp"
#include "params/field_reader.hpp"

namespace hjt
{
namespace
{
constexpr double PERIOD = 0.008;    // of the set points [s]
constexpr double LARGEST = 100.0;   // angle: a joint may turn without end [rad]
constexpr double LONGEST = 3600.0;  // rest [s]
constexpr const char* MOVES = "moves";

/// Moves, each with what the file says for all where it says nothing itself.
class ProgramReader
{
public:
  ProgramReader(const std::string& path, std::size_t joints)
    : map_(readArmFile(path)), joints_(joints), fields_(map_, path)
  {
    const auto given = map_.lower_bound(MOVES);
    if (count() == 0)
    {
      const bool is_there = holds(MOVES);
      const bool is_value = is_there && given->first == MOVES;
      throw ParameterError((is_there ? given->second.origin : path) + ": " + MOVES +
                           (is_value ? " = " + valueText(given->second) :
                            is_there ? "" :
                                       ", which is missing,") +
                           " must be a list of one move or more, {to: [...], speed: ..., acceleration: ...}");
    }
    for (std::size_t i = 0; i < count(); ++i)
    {
      for (const char* key : { "speed", "acceleration", "jerk", "wait" })
      {
        if (const auto common = map_.find(key); common != map_.end())
        {
          map_.emplace(place(i) + key, common->second);
        }
      }
    }
    for (const char* key : { "speed", "acceleration", "jerk", "wait" })
    {
      map_.erase(key);
    }
  }

  ArmPose start()
  {
    ArmPose start(joints_);
    fields_("start", "rad", start, Range{ -LARGEST, LARGEST }, "angles of all joints where it begins");
    return start;
  }

  std::vector<ArmMove> moves()
  {
    std::vector<ArmMove> moves(count());
    for (std::size_t i = 0; i < moves.size(); ++i)
    {
      read(place(i), moves[i]);
    }
    fields_.refuseUnknownKeys();
    throwIfAny(fields_.errors());
    return moves;
  }

private:
  static std::string place(std::size_t move) { return MOVES + ("." + std::to_string(move)) + "."; }

  bool holds(const std::string& key) const
  {
    const auto found = map_.lower_bound(key);
    return found != map_.end() && found->first.rfind(key, 0) == 0;
  }

  std::size_t count() const
  {
    std::size_t moves = 0;
    while (holds(place(moves)))
    {
      ++moves;
    }
    return moves;
  }

  void read(const std::string& at, ArmMove& move)
  {
    move.target.resize(joints_);
    fields_(at + "to", "rad", move.target, Range{ -LARGEST, LARGEST }, "angles of all joints");
    fields_(at + "speed", "rad/s", move.speed, Range{ 1e-3, 100.0 }, "of the joint that goes farthest, at most");
    fields_(at + "acceleration", "rad/s^2", move.acceleration, Range{ 1e-2, 1e4 }, "of that joint, at most");
    if (holds(at + "jerk"))
    {
      fields_(at + "jerk", "rad/s^3", move.jerk, Range{ 1e-2, 1e6 }, "of that joint, at most");
    }
    if (holds(at + "wait"))
    {
      fields_(at + "wait", "s", move.wait, Range{ 0.0, LONGEST }, "at rest afterwards");
    }
  }

  ParameterMap map_;
  std::size_t joints_;
  FieldReader fields_;
};
}  // namespace

std::vector<ArmSetPoint> readArmProgram(const std::string& path, const ArmDescription& arm)
{
  ProgramReader reader(path, arm.joints.size());
  const ArmPose start = reader.start();
  std::vector<ArmSetPoint> points;
  for (ArmInstant& instant : sampleMoves(arm, start, reader.moves(), PERIOD))
  {
    points.push_back({ instant.time, std::move(instant.joints) });
  }
  requireMotion(points, arm, path);
  return points;
}
}  // namespace hjt
