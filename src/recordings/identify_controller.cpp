// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/identify_controller.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include "arm/arm_configuration.hpp"
#include "arm/arm_controller.hpp"
#include "bags/recorded_messages.hpp"
#include "base/csv_table.hpp"
#include "base/number_text.hpp"
#include "base/statistics.hpp"
#include "base/whole_file.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "output/output_file.hpp"

namespace hjt
{
namespace
{
constexpr std::array QUANTITIES{ "target_q_", "target_qd_", "target_current_", "target_moment_",
                                 "actual_q_", "actual_qd_", "actual_current_" };

/// Largest speed gain that is stored, over the gain of ArmController::defaultGains [-]. With twice the default gain the
/// control loop of a wrist becomes unstable, because the twin's loop lacks the filters of a real controller.
constexpr double MOST_SPEED_GAIN = 1.5;

struct Recorded
{
  double period{};                                 // median time between rows [s]
  std::vector<std::vector<ControllerRow>> joints;  // rows of each joint, `current` holds the target moment [N.m]
  std::vector<std::vector<double>> angles;         // actual angles of each joint [rad]
};

/// Delay of the recorded speeds behind the rates of change of the recorded angles, by least squares; 0 or more [s].
double ageOfSpeeds(const std::vector<ControllerRow>& rows, const std::vector<double>& angles, double period)
{
  double products = 0.0;
  double squares = 0.0;
  for (std::size_t k = 1; k + 1 < rows.size(); ++k)
  {
    const double rate = (angles[k + 1] - angles[k - 1]) / (2.0 * period);
    const double bend = (angles[k + 1] - 2.0 * angles[k] + angles[k - 1]) / (period * period);
    const double speed = rows[k].speed - rows[k].speed_error;
    products += (rate - speed) * bend;
    squares += bend * bend;
  }
  return squares > 0.0 ? std::max(products / squares, 0.0) : 0.0;
}

/// Corrects the errors in `rows` to those that the controller acted on. The controller receives set points late by
/// `delay` [s]. It compares their speeds with measured speeds that are late by `speed_age` [s].
void takeDelays(double delay, double speed_age, double period, std::vector<ControllerRow>& rows)
{
  const std::vector<ControllerRow> logged = rows;
  for (std::size_t k = 1; k + 1 < rows.size(); ++k)
  {
    const double acceleration = (logged[k + 1].speed - logged[k - 1].speed) / (2.0 * period);
    rows[k].angle_error -= delay * (logged[k].speed - 0.5 * delay * acceleration);
    rows[k].speed_error -= (delay + speed_age) * acceleration;
  }
}

Recorded readController(const std::string& path, std::size_t joints)
{
  requireTable(path, "give a table with target and actual values of all joints");
  CsvRows rows(path);
  const std::vector<std::string>& header = rows.header();
  const auto column = [&](const std::string& name)
  {
    const auto found = std::find(header.begin(), header.end(), name);
    if (found == header.end())
    {
      throw InputError(path + ": no column " + name +
                       "; the controller's gains need target and actual values of all joints");
    }
    return static_cast<std::size_t>(found - header.begin());
  };
  const std::size_t time = column("timestamp");
  std::vector<std::array<std::size_t, QUANTITIES.size()>> columns(joints);
  for (std::size_t i = 0; i < joints; ++i)
  {
    std::transform(QUANTITIES.begin(), QUANTITIES.end(), columns[i].begin(),
                   [&](const char* name) { return column(name + std::to_string(i)); });
  }
  Recorded recorded;
  recorded.joints.resize(joints);
  recorded.angles.resize(joints);
  std::vector<double> steps;
  double before = 0.0;
  while (rows.next())
  {
    const double now = rows.number(time);
    if (!recorded.joints.front().empty())
    {
      steps.push_back(now - before);
    }
    before = now;
    for (std::size_t i = 0; i < joints; ++i)
    {
      std::array<double, QUANTITIES.size()> value{};
      std::transform(columns[i].begin(), columns[i].end(), value.begin(),
                     [&](std::size_t place) { return rows.number(place); });
      recorded.joints[i].push_back(
          { value[0] - value[4], value[1] - value[5], value[1], value[3], value[2], value[6] });
      recorded.angles[i].push_back(value[4]);
    }
  }
  recorded.period = steps.empty() ? 0.0 : upperMedian(steps.begin(), steps.end());
  if (!(recorded.period > 0.0))
  {
    throw InputError(path + ": the times of the rows do not increase");
  }
  return recorded;
}

std::string halfWidthText(double half_width)
{
  return "; 95 %: +- " + roundedText(half_width, 3);
}

std::string textOf(const RecordingOptions& options, const std::vector<IdentifiedController>& joints)
{
  std::string text =
      "# SPDX-License-Identifier: BSD-3-Clause\n# Gains of an arm's controller, by `joint_twin identify "
      "--controller` from\n# " +
      options.recording + "\n";
  for (const IdentifiedController& joint : joints)
  {
    const ControllerFit& fit = joint.fit;
    text +=
        "\n" + joint.name + ":\n  # Demanded speed per error of the angle [1/s]" +
        (fit.refusal.empty() ? halfWidthText(fit.position_half_width) : "; as configured: " + fit.refusal) +
        ".\n  position: " + numberText(fit.gains.position) + "\n  # Torque per error of the speed [N.m.s/rad]" +
        (joint.is_limited    ? "; limited, because the twin's loop is unstable with the identified value" :
         fit.refusal.empty() ? halfWidthText(joint.fit.gains.speed / fit.speed_current * fit.speed_half_width) :
                               "") +
        ".\n  speed: " + numberText(fit.gains.speed) +
        "\n  # Integral time of the speed control [s].\n  integral_time: " + numberText(fit.gains.integral_time) +
        "\n  # Constant part of the friction that is fed forward [N.m].\n  coulomb: " + numberText(fit.gains.coulomb) +
        "\n  # Fed-forward friction per speed [N.m.s/rad].\n  viscous: " + numberText(fit.gains.viscous) + "\n";
  }
  return text;
}
}  // namespace

std::vector<IdentifiedController> identifyController(const RecordingOptions& options, const std::string& out)
{
  const std::string path = out.empty() ? "" : (std::filesystem::path(out) / GAINS_FILE).string();
  if (!path.empty())
  {
    std::filesystem::create_directories(out);
    requireWritable(path, options.force, options.recording);
  }
  const ArmDescription arm = readArmDescription(findArm(options.arm, configDirectory(options)));
  Recorded recorded = readController(options.recording, arm.joints.size());
  std::vector<IdentifiedController> joints;
  for (std::size_t i = 0; i < arm.joints.size(); ++i)
  {
    ParameterMap map = armDriveParameters(arm.joints[i], configDirectory(options), options.identified);
    addOverlays(options, map);
    const Parameters drive = parseParameters(map);
    const double gain = drive.telemetry.torque_per_current;
    for (ControllerRow& row : recorded.joints[i])
    {
      row.rigid_current /= gain;
    }
    const double period = recorded.period * options.time_scale;
    takeDelays(arm.joints[i].delay, ageOfSpeeds(recorded.joints[i], recorded.angles[i], period), period,
               recorded.joints[i]);
    const JointGains usual = arm.joints[i].gains.value_or(ArmController::defaultGains(drive));
    IdentifiedController& joint = joints.emplace_back();
    joint.name = arm.joints[i].short_name;
    joint.fit = fitController(recorded.joints[i], period, gain, usual, arm.joints[i].feedback_limit);
    const double most = MOST_SPEED_GAIN * ArmController::defaultGains(drive).speed;
    joint.is_limited = joint.fit.refusal.empty() && joint.fit.gains.speed > most;
    if (joint.is_limited)
    {
      joint.fit.gains.speed = most;
    }
  }
  if (!path.empty())
  {
    writeTextFile(path, textOf(options, joints));
  }
  return joints;
}

Report reportOf(const std::vector<IdentifiedController>& joints)
{
  using Joint = IdentifiedController;
  const std::vector<Column<Joint>> columns{
    { "joint", &Joint::name, "joint" },
    { "angle_current", [](const Joint& joint) { return joint.fit.angle_current; }, "current per angle error [A/rad]" },
    { "angle_half_width", [](const Joint& joint) { return joint.fit.angle_half_width; }, "+-" },
    { "speed_current", [](const Joint& joint) { return joint.fit.speed_current; }, "per speed error [A.s/rad]" },
    { "speed_half_width", [](const Joint& joint) { return joint.fit.speed_half_width; }, "+-" },
    { "lag", [](const Joint& joint) { return joint.fit.lag; }, "lag [s]" },
    { "explained", [](const Joint& joint) { return joint.fit.explained; }, "explained" },
    { "position_half_width", [](const Joint& joint) { return joint.fit.position_half_width; } },
    { "position", [](const Joint& joint) { return joint.fit.gains.position; } },
    { "speed", [](const Joint& joint) { return joint.fit.gains.speed; } },
    { "integral_time", [](const Joint& joint) { return joint.fit.gains.integral_time; } },
    { "coulomb", [](const Joint& joint) { return joint.fit.gains.coulomb; } },
    { "viscous", [](const Joint& joint) { return joint.fit.gains.viscous; } },
    { "is_limited", &Joint::is_limited },
    { "refusal", [](const Joint& joint) { return joint.fit.refusal; }, "stays as configured" }
  };
  return { {}, { { "joints", Table(columns, joints) } } };
}
}  // namespace hjt
