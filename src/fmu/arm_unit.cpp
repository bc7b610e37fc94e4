// SPDX-License-Identifier: BSD-3-Clause
/// The FMI unit of a whole arm, in closed loop or with given motor torques.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "arm/arm_recorder.hpp"
#include "arm/moving_arm.hpp"
#include "base/whole_file.hpp"
#include "fmu/arm_variables.hpp"
#include "fmu/drive_part.hpp"

namespace hjt::fmu
{
namespace
{
std::array<double, 3> arrayOf(const Value& value)
{
  return { value.numbers[0], value.numbers[1], value.numbers[2] };
}

Payload payloadOf(const Values& values)
{
  return { values[PAYLOAD_MASS].numbers[0], arrayOf(values[PAYLOAD_CENTRE]) };
}

void takeSetPoint(const Values& values, std::vector<JointMotion>& joints)
{
  for (std::size_t i = 0; i < joints.size(); ++i)
  {
    joints[i] = { values[SET_POSITION].numbers[i], values[SET_VELOCITY].numbers[i],
                  values[SET_ACCELERATION].numbers[i] };
  }
}

/// Time since EPOCH of a stamp [s].
double timeOf(Stamp stamp)
{
  return toSeconds(stamp - EPOCH);
}

/// Simulation of an arm. If the arm has its controller, the arm's instants are later than the importer's times by
/// MovingArm::SETTLING and the lead-in.
class ArmSimulation : public Simulation
{
public:
  ArmSimulation(const ArmDescription& arm, MovingArm moving, std::vector<DrivePart> parts, const Values& values,
                double start)
    : arm_(arm)
    , moving_(std::move(moving))
    , recorder_(arm, moving_)
    , parts_(std::move(parts))
    , set_point_(arm.joints.size())
    , controlled_(values[CONTROLLER].numbers[0] != 0.0)
    , payload_(payloadOf(values))
  {
    if (controlled_)
    {
      moving_.reset(stampAt(start));
      while (moving_.step(moving_.motionBegin()))
      {
      }
      settling_ = moving_.motionBegin() - stampAt(start);
    }
    else
    {
      moving_.twin().reset(stampAt(start));
    }
    for (DrivePart& part : parts_)
    {
      part.begin(values, !controlled_);
    }
  }

  ArmSimulation(const ArmSimulation& other)
    : Simulation(other)
    , arm_(other.arm_)
    , moving_(other.moving_)
    , recorder_(arm_, moving_)
    , parts_(other.parts_)
    , set_point_(other.set_point_)
    , controlled_(other.controlled_)
    , settling_(other.settling_)
    , payload_(other.payload_)
  {
  }
  ArmSimulation& operator=(const ArmSimulation&) = delete;

  std::unique_ptr<Simulation> copy() const override { return std::make_unique<ArmSimulation>(*this); }

  bool step(const Values& values, double end) override
  {
    ArmTwin& twin = moving_.twin();
    const std::uint64_t failures = countersOf(twin).solver_failures;
    const Stamp until = stampAt(end) + settling_ + twin.stepLength() / 1000;  // plus a tolerance for rounding
    takeSetPoint(values, set_point_);
    moving_.goOn(timeOf(stampAt(end)), set_point_);
    giveInputs(values, until);
    while (controlled_ && moving_.step(until))
    {
    }
    while (!controlled_ && twin.stamp() + twin.stepLength() <= until)
    {
      for (std::size_t i = 0; i < parts_.size(); ++i)
      {
        twin.drive(i).commandMotorTorque(twin.stamp(), parts_[i].motorTorque(values));
      }
      twin.step(until);
    }
    row_known_ = false;
    for (DrivePart& part : parts_)
    {
      part.moved();
    }
    return countersOf(twin).solver_failures == failures;
  }

  bool read(std::size_t reference, Values& values) override
  {
    if (reference < FIRST_DRIVE)
    {
      readArm(values);
      return true;
    }
    const std::size_t joint = jointOf(reference);
    return parts_[joint].read(reference, moving_.twin().drive(joint), values);
  }

  bool marks(std::size_t reference) const override
  {
    if (reference < FIRST_DRIVE)
    {
      return false;
    }
    const std::size_t joint = jointOf(reference);
    return parts_[joint].marks(reference, moving_.twin().drive(joint));
  }

private:
  std::size_t jointOf(std::size_t reference) const
  {
    std::size_t joint = 0;
    while (reference >= parts_[joint].end())
    {
      ++joint;
    }
    return joint;
  }

  void giveInputs(const Values& values, Stamp until)
  {
    ArmTwin& twin = moving_.twin();
    if (twin.stamp() + twin.stepLength() > until)
    {
      return;
    }
    twin.setWrench({ arrayOf(values[WRENCH_FORCE]), arrayOf(values[WRENCH_MOMENT]) });
    const Payload payload = payloadOf(values);
    if (payload.mass != payload_.mass || payload.centre != payload_.centre)
    {
      payload_ = payload;
      moving_.setPayload(payload);
    }
    for (std::size_t i = 0; i < parts_.size(); ++i)
    {
      parts_[i].giveInputs(twin.stamp(), values, twin.drive(i));
    }
  }

  void readArm(Values& values)
  {
    if (row_known_)
    {
      return;
    }
    const ArmRow& row = recorder_.row();
    for (std::size_t k = TARGET_CURRENT; k < row.size(); ++k)
    {
      values[FIRST_ARM_OUTPUT + k - TARGET_CURRENT].numbers = row[k];
    }
    const std::array<double, 4> orientation = moving_.twin().toolPose().orientation;
    std::copy(orientation.begin(), orientation.end(), values[TOOL_ORIENTATION].numbers.begin());
    const std::vector<double>& wanted = row[TARGET_TOOL];
    const std::vector<double>& tool = row[ACTUAL_TOOL];
    values[TOOL_ERROR].numbers[0] = std::hypot(tool[0] - wanted[0], tool[1] - wanted[1], tool[2] - wanted[2]);
    const std::optional<ProtectiveStop>& stop = moving_.protectiveStop();
    values[PROTECTIVE_STOP].numbers[0] = stop ? static_cast<double>(stop->joint + 1) : 0.0;
    row_known_ = true;
  }

  const ArmDescription& arm_;  // arm of the unit, which outlives this object
  MovingArm moving_;
  ArmRecorder recorder_;
  std::vector<DrivePart> parts_;
  std::vector<JointMotion> set_point_;
  bool controlled_;
  Stamp settling_{};  // time of the arm minus the importer's time [ns]
  Payload payload_;
  bool row_known_{};
};

class ArmUnit : public Unit
{
public:
  ArmUnit(ArmDescription arm, std::vector<Parameters> drives) : arm_(std::move(arm)), drives_(std::move(drives))
  {
    variables_ = armVariables(arm_, drives_);
  }

  std::unique_ptr<Simulation> start(const Values& values, double start, const Notice& notice) const override
  {
    ArmDescription arm = arm_;
    arm.gravity = arrayOf(values[GRAVITY]);
    arm.payload = payloadOf(values);
    std::vector<DrivePart> parts;
    std::vector<Parameters> drives;
    for (std::size_t i = 0; i < drives_.size(); ++i)
    {
      const auto gain = [&](ArmReference of) { return values[of].numbers[i]; };
      arm.joints[i].gains = JointGains{ gain(GAIN_POSITION), gain(GAIN_SPEED), gain(GAIN_INTEGRAL_TIME),
                                        gain(GAIN_COULOMB), gain(GAIN_VISCOUS) };
      const std::size_t first = parts.empty() ? std::size_t{ FIRST_DRIVE } : parts.back().end();
      parts.emplace_back(variables_, first, prefixOf(arm.joints[i]));
      drives.push_back(parts.back().parameters(drives_[i], values));
    }
    // start_q is a parameter, because importers set the inputs of the first step before the start.
    ArmSetPoint first{ timeOf(stampAt(start)), {} };
    for (const double angle : values[START_POSITION].numbers)
    {
      first.joints.push_back({ angle, 0.0, 0.0 });
    }
    const double settling = values[CONTROLLER].numbers[0] != 0.0 ? MovingArm::SETTLING : 0.0;
    MovingArm moving(arm, drives, ArmMotion({ first, first }), unitSurfaces(notice), settling);
    return std::make_unique<ArmSimulation>(arm_, std::move(moving), std::move(parts), values, start);
  }

private:
  ArmDescription arm_;
  std::vector<Parameters> drives_;
};
}  // namespace

std::unique_ptr<Unit> openUnit(const std::string& resources, const std::string& token)
{
  std::string text = readFile(resources + ARM_FILE);
  ArmDescription arm = readArmResource(resources + ARM_FILE);
  std::vector<Parameters> drives;
  for (const ArmJoint& joint : arm.joints)
  {
    const std::string folder = resources + joint.short_name + '/';
    const std::string parameters = readFile(folder + PARAMETER_FILE);
    text += parameters;
    drives.push_back(readParameters(parameters, folder));
  }
  requireToken(token, text);
  return std::make_unique<ArmUnit>(std::move(arm), std::move(drives));
}
}  // namespace hjt::fmu
