// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/signatures.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "datasets/sweep.hpp"
#include "recordings/recorded_windows.hpp"

#include "harmonic_joint_twin/base/errors.hpp"
#include "health/signature_file.hpp"
#include "messages/topics.hpp"

namespace hjt
{
namespace
{
constexpr std::array SEVERITIES{ 0.1, 0.16, 0.25, 0.4, 0.63, 1.0 };  // severities of the signatures

/// A line that a fault causes in every motion, at an order from kinematics. The amplitude at severity 1 is assumed.
struct KinematicLine
{
  Cause cause;
  LineSignal signal;
  Line line;
  // Amplitude at severity 1: of an angle [rad]; of a torque, as a share of the rated torque at the output [-].
  double size;
};
constexpr double TORQUE_SHARE = 1e-2 / 67.0;
constexpr std::array<KinematicLine, 9> KINEMATIC_LINES{ {
    { causeOf(FaultKind::BEARING_INNER_RACE), LineSignal::KINEMATIC_ERROR, Line::INNER, 5e-6 },
    { causeOf(FaultKind::BEARING_INNER_RACE), LineSignal::MOTOR_TORQUE, Line::INNER, TORQUE_SHARE },
    { causeOf(FaultKind::BEARING_OUTER_RACE), LineSignal::KINEMATIC_ERROR, Line::OUTER, 5e-6 },
    { causeOf(FaultKind::BEARING_OUTER_RACE), LineSignal::MOTOR_TORQUE, Line::OUTER, TORQUE_SHARE },
    { causeOf(FaultKind::BEARING_BALL), LineSignal::KINEMATIC_ERROR, Line::BALL, 5e-6 },
    { causeOf(FaultKind::BEARING_BALL), LineSignal::MOTOR_TORQUE, Line::BALL, TORQUE_SHARE },
    { causeOf(FaultKind::BEARING_CAGE), LineSignal::KINEMATIC_ERROR, Line::CAGE_LOBES, 1e-5 },
    { causeOf(FaultKind::BEARING_CAGE), LineSignal::MOTOR_TORQUE, Line::CAGE_LOBES, TORQUE_SHARE },
    { Cause::CIRCULAR_SPLINE_TOOTH, LineSignal::KINEMATIC_ERROR, Line::CIRCULAR_SPLINE_2, 5e-5 },
} };

/// Conditions of a run apart from its fault. A faulty run is compared with the sound run of the same conditions.
std::string conditionsOf(const RunSpec& spec)
{
  std::string text;
  for (const auto& [path, value] : spec.variables)
  {
    text += path.rfind("classes.", 0) == 0 ? "" : path + "=" + jsonOf(value).dump() + " ";
  }
  return text;
}

[[noreturn]] void refuse(const Plan& plan, const RunSpec& spec, const std::string& what)
{
  throw InputError("plan " + plan.name() + ", class " + spec.fault_class + ", duty " + spec.duty_name + ": " + what);
}

/// The last window of a run.
SignalIndicators windowOf(const Plan& plan, const RunSpec& spec, const std::string& file)
{
  const std::vector<SignalIndicators> windows =
      publishedWindows(file, std::string(DEFAULT_NAMESPACE) + "/" + topics::INDICATORS);
  if (windows.empty())
  {
    refuse(plan, spec,
           "a run without a whole window of the indicators; adapt its duration, indicators.window_turns, "
           "indicators.window_time or publish.indicators_rate");
  }
  return windows.back();
}

/// Changes of the indicators by a fault. For a line with a phase, the change is the amplitude of the difference. An
/// indicator that was not measured has a change of 0.
std::array<double, SIGNATURE_SIZE> changesOf(Cause cause, const SignalIndicators& window, const SignalIndicators& sound)
{
  const SignalIndicators change = difference(window, sound);
  const std::array<std::size_t, SIGNATURE_SIZE> indicators = indicatorsOfNumbers();
  std::array<double, SIGNATURE_SIZE> found{};
  for (std::size_t i = 0; i < SIGNATURE_SIZE; ++i)
  {
    const bool share = i < SCALAR_COUNT && isShare(cause, static_cast<ScalarIndicator>(i));
    const double value = change.values[indicators[i]] / (share ? sound.values[i] : 1.0);
    found[i] = std::isfinite(value) ? value : 0.0;
  }
  return found;
}

/// Mean speed and direction of the sound windows.
MotionKind kindOf(const std::map<std::string, SignalIndicators>& sound)
{
  MotionKind kind{};
  for (const auto& [conditions, window] : sound)
  {
    kind.speed += window.point.speed / static_cast<double>(sound.size());
    kind.direction += std::abs(window.point.direction) / static_cast<double>(sound.size());
  }
  return kind;
}

/// Signature at a severity, interpolated linearly between `known` signatures, which are in order of severity. Beyond
/// the largest known severity, the changes stay those of the last signature.
Signature between(const std::vector<Signature>& known, double severity)
{
  const auto after = std::find_if(known.begin() + 1, known.end() - 1,
                                  [severity](const Signature& one) { return one.severity >= severity; });
  const Signature& before = *(after - 1);
  const double share = std::min((severity - before.severity) / (after->severity - before.severity), 1.0);
  Signature signature = before;
  signature.severity = severity;
  for (std::size_t i = 0; i < SIGNATURE_SIZE; ++i)
  {
    signature.change[i] += share * (after->change[i] - before.change[i]);
  }
  return signature;
}

void addKinematicLines(double rated_torque, SignatureSet& set)
{
  for (const KinematicLine& line : KINEMATIC_LINES)
  {
    const double size = line.size * (line.signal == LineSignal::MOTOR_TORQUE ? rated_torque : 1.0);
    for (const double severity : SEVERITIES)
    {
      Signature signature{ line.cause, severity, ANY_MOTION, {} };
      signature.change[signatureNumber(line.signal, index(line.line))] = severity * size;
      set.signatures.push_back(signature);
    }
  }
}
}  // namespace

void checkSignaturePlan(const Plan& plan)
{
  if (plan.isOfArms())
  {
    throw InputError("plan " + plan.name() + ": signatures are made from runs of one drive, not of an arm");
  }
  if (plan.recording().format != RunFormat::BAG)
  {
    throw InputError("plan " + plan.name() + ": signatures are made from bags; give record: {format: bag}");
  }
  for (std::uint64_t run = 0; run < plan.runs(); ++run)
  {
    const RunSpec spec = checkedRun(plan, run);
    if (spec.faults.size() > 1)
    {
      refuse(plan, spec, std::to_string(spec.faults.size()) + " faults; a run for a signature has at most one");
    }
    if (!spec.faults.empty() && (spec.faults[0].fault.onset > 0.0 || spec.faults[0].ramp > 0.0))
    {
      refuse(plan, spec, "its fault must exist from the start: give onset: 0.0 and no ramp");
    }
  }
}

void SignatureRuns::addFaulty(const Plan& plan, const RunSpec& spec, const SignalIndicators& window, Motion& motion)
{
  const auto sound = motion.sound.find(conditionsOf(spec));
  if (sound == motion.sound.end())
  {
    refuse(plan, spec,
           "no sound run under the same conditions; a plan of signatures has a class without faults before "
           "all others, and grids in place of random draws");
  }
  const Fault& fault = spec.faults[0].fault;
  Mean& mean = motion.faulty[{ fault.kind, fault.severity }];
  const Changes changes = changesOf(causeOf(fault.kind), window, sound->second);
  std::transform(changes.begin(), changes.end(), mean.sum.begin(), mean.sum.begin(), std::plus<>());
  ++mean.count;
}

void SignatureRuns::add(const Plan& plan, const SweepDirectory& directory)
{
  std::map<std::string, std::size_t> motions;
  for (std::uint64_t run = 0; run < plan.runs(); ++run)
  {
    const RunSpec spec = plan.run(run);
    const OrderedJson record = directory.record(run);
    if (record.value("status", "") != "ok")
    {
      notice_("left out: " + directory.runFileName(run) + ", " + record.value("error", "not finished"));
      continue;
    }
    const auto [found, is_new] = motions.emplace(spec.duty_name, motions_.size());
    if (is_new)
    {
      motions_.push_back({ spec.duty_name, {}, {} });
    }
    Motion& motion = motions_[found->second];
    const SignalIndicators window = windowOf(plan, spec, directory.runFile(run));
    if (spec.faults.empty())
    {
      motion.sound[conditionsOf(spec)] = window;
    }
    else
    {
      addFaulty(plan, spec, window, motion);
    }
  }
}

std::vector<Signature> SignatureRuns::rows(FaultKind kind, const Motion& motion)
{
  std::vector<Signature> known{ { causeOf(kind), 0.0, kindOf(motion.sound), {} } };
  for (const auto& [fault, mean] : motion.faulty)
  {
    if (fault.first == kind)
    {
      known.push_back(known.front());
      known.back().severity = fault.second;
      std::transform(mean.sum.begin(), mean.sum.end(), known.back().change.begin(),
                     [&count = mean.count](double sum) { return sum / count; });
    }
  }
  std::vector<Signature> rows;
  for (std::size_t i = 0; known.size() > 1 && i < SEVERITIES.size(); ++i)
  {
    rows.push_back(between(known, SEVERITIES[i]));
  }
  return rows;
}

std::string SignatureRuns::text(const std::string& gear, const SignatureSet& basis, double rated_torque) const
{
  if (motions_.empty())
  {
    throw InputError("no run found its equilibrium, so signatures cannot be made");
  }
  SignatureSet set = basis;
  std::vector<std::string> motions;  // name of the motion of each signature
  set.gear = gear;
  set.signatures.clear();
  set.fitted.fill(true);  // the runs give all values except those of robots, which come from `basis`
  for (const FaultDescription& description : FAULT_DESCRIPTIONS)
  {
    for (const Motion& motion : motions_)
    {
      const std::vector<Signature> own = rows(description.kind, motion);
      set.signatures.insert(set.signatures.end(), own.begin(), own.end());
      motions.resize(set.signatures.size(), motion.name);
    }
  }
  addKinematicLines(rated_torque, set);
  motions.resize(set.signatures.size(), "kinematics");
  for (std::size_t i = 0; i < SCALAR_COUNT; ++i)
  {
    set.sound[i] = 0.0;
    for (const auto& [conditions, window] : motions_.front().sound)
    {
      const double value = std::isfinite(window.values[i]) ? window.values[i] : 0.0;
      set.sound[i] += value / static_cast<double>(motions_.front().sound.size());
    }
  }
  return signatureText(set, motions);
}
}  // namespace hjt
