// SPDX-License-Identifier: BSD-3-Clause
// Functions on recordings and data sets within Python: the module _recordings, behind
// python/harmonic_joint_twin/_commands.py, which has their signatures.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "datasets/check_up_file.hpp"
#include "datasets/sweep.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "params/choices.hpp"
#include "python/comparison_row.hpp"
#include "python/recordings/calls.hpp"
#include "recordings/check_report.hpp"
#include "recordings/compare.hpp"
#include "recordings/follow.hpp"
#include "recordings/identify.hpp"
#include "recordings/indicators.hpp"
#include "recordings/remaining.hpp"
#include "recordings/trend_report.hpp"

namespace hjt
{
namespace
{
/// @throws InputError if columns are missing or not of one shape.
void takeRows(const py::object& columns, RecordingOptions& options)
{
  struct Choice
  {
    const char* name;
    double MotionRow::*field;
    bool needed;
  };
  constexpr std::array<Choice, 6> CHOICES{ { { "position", &MotionRow::position, true },
                                             { "current", &MotionRow::current, true },
                                             { "load", &MotionRow::load, false },
                                             { "velocity", &MotionRow::recorded_velocity, false },
                                             { "temperature", &MotionRow::temperature, false },
                                             { "motor_angle", &MotionRow::motor_angle, false } } };
  requireColumns(columns, "recording");
  const MotionColumn times(columns, "time");
  const MotionColumn positions(columns, "position");
  if (!times || !positions || times.width() != 1 || times.rows() == 0)
  {
    throw InputError("recording: columns 'time', of shape (rows,), and 'position' are needed");
  }
  std::vector<std::vector<MotionRow>> rows(static_cast<std::size_t>(times.rows()),
                                           std::vector<MotionRow>(static_cast<std::size_t>(positions.width())));
  for (const Choice& choice : CHOICES)
  {
    const MotionColumn column(columns, choice.name);
    if (!column && !choice.needed)
    {
      continue;
    }
    if (!column || column.rows() != times.rows() || column.width() != positions.width())
    {
      throw InputError(std::string("recording: column '") + choice.name + "' is missing or not of the shape (" +
                       std::to_string(times.rows()) + ", " + std::to_string(positions.width()) + ") of the angles");
    }
    for (std::size_t row = 0; row < rows.size(); ++row)
    {
      for (std::size_t joint = 0; joint < rows[row].size(); ++joint)
      {
        MotionRow& motion = rows[row][joint];
        motion.*choice.field = column.at(row, joint);
        motion.time = times.at(row, 0) - times.at(0, 0);
        motion.received = motion.time;
      }
    }
  }
  options.rows = std::make_shared<const std::vector<std::vector<MotionRow>>>(std::move(rows));
  options.rows_have_load = static_cast<bool>(MotionColumn(columns, "load"));
}

/// How a recording is read. @throws InputError where options contradict each other or are out of range.
void takeReading(const Given& given, RecordingOptions& options)
{
  takeConfiguration(given, options);
  given.take("joint", options.joint);
  given.take("arm", options.arm);
  given.take("load", options.load);
  given.take("identified", options.identified);
  given.take("topic", options.topic);
  given.take("time_scale", options.time_scale);
  given.take("force", options.force);
  if (options.load != LOAD_OF_ARM && options.load != LOAD_RECORDED)
  {
    throw InputError("load = '" + options.load + "' must be 'arm' or 'target_moment'");
  }
  if (!(options.time_scale > 0.0) || !std::isfinite(options.time_scale))
  {
    throw InputError("time_scale = " + std::to_string(options.time_scale) + " [-] must be above 0");
  }
}

/// And of what. @throws InputError likewise.
void takeSubject(const Given& given, RecordingOptions& options)
{
  takeReading(given, options);
  if (options.joint.empty() == options.arm.empty())
  {
    throw InputError("one of joint and arm is needed");
  }
}

void takeRecording(const Given& given, RecordingOptions& options)
{
  const py::object recording = given["recording"];
  options.recording = py::isinstance<py::str>(recording) ? py::cast<std::string>(recording) : "recording";
  if (!py::isinstance<py::str>(recording))
  {
    takeRows(recording, options);
  }
}

/// `at_hand`: names to columns of arrays, of shape (rows,).
void takeSignals(const Given& given, SignalOptions& options)
{
  takeConfiguration(given, options);
  given.take("recordings", options.recordings);
  given.take("joint", options.joint);
  given.take("torque_scale", options.torque_scale);
  given.take("force", options.force);
  given.take("at_hand", options.at_hand);
  std::map<std::string, std::string> columns;
  given.take("columns", columns);
  for (const auto& [signal, column] : columns)
  {
    nameColumn(options.source, signal, column);
  }
  for (const auto& [recording, columns] : options.at_hand)
  {
    for (const auto& [name, values] : columns)
    {
      if (values.size() != columns.begin()->second.size())
      {
        throw InputError(recording + ": column '" + name + "' has " + std::to_string(values.size()) +
                         " values, expected: " + std::to_string(columns.begin()->second.size()) + " as '" +
                         columns.begin()->first + "'");
      }
    }
  }
  for (const std::string& recording : options.recordings)
  {
    const std::string wrong = options.at_hand.count(recording) > 0 ? "" : wrongSignalFile(recording);
    if (!wrong.empty())
    {
      throw InputError(wrong);
    }
  }
}

Answer followIn(const py::dict& arguments)
{
  const Given given(arguments);
  FollowOptions options;
  takeSubject(given, options);
  takeRecording(given, options);
  given.take("bag", options.bag);
  std::string mode = "motion";
  given.take("mode", mode);
  bool known = false;
  for (const auto& [name, choice] : choiceNames(InputMode{}))
  {
    known = known || (mode == name && choice != InputMode::COMMANDS);
    options.mode = mode == name ? choice : options.mode;
  }
  if (!known)
  {
    throw InputError("mode = '" + mode + "' must be 'motion', 'torque' or 'observer'");
  }
  std::vector<std::vector<ComparisonRow>> rows;
  options.take = [&](std::size_t joint, const Comparison& now)
  {
    rows.resize(std::max(rows.size(), joint + 1));
    rows[joint].push_back(rowOf(now));
  };
  return call(given, options, follow,
              [&](const Followed& followed)
              {
                rows.resize(followed.joints.size());
                py::object document = toPython(documentOf(reportOf(followed)));
                py::dict arrays;
                for (std::size_t i = 0; i < rows.size(); ++i)
                {
                  arrays[py::str(followed.joints[i].name)] =
                      py::array_t<ComparisonRow>(static_cast<py::ssize_t>(rows[i].size()), rows[i].data());
                }
                document["comparison"] =
                    followed.is_arm ? py::object(arrays) : arrays[py::str(followed.joints.front().name)];
                return document;
              });
}

Answer identifyIn(const py::dict& arguments)
{
  const Given given(arguments);
  IdentifyOptions options;
  takeSubject(given, options);
  takeRecording(given, options);
  given.take("out", options.out);
  given.take("train", options.train);
  given.take("judge", options.judge);
  given.take("folds", options.folds);
  if (arguments.contains("folds"))
  {
    requireWithin("folds", options.folds, "-", { 2.0, 100.0 });
  }
  return call(
      given, options, [](const IdentifyOptions& asked) { return identify(asked); },
      [](const Identified& found) { return toPython(documentOf(reportOf(found).whole())); });
}

Answer checkIn(const py::dict& arguments)
{
  const Given given(arguments);
  RecordingOptions options;
  takeReading(given, options);
  takeRecording(given, options);
  return call(given, options, checkRecording, [](const RecordingCheck& found) { return toPython(documentOf(found)); });
}

Answer compareIn(const py::dict& arguments)
{
  const Given given(arguments);
  ComparisonOptions options;
  takeSubject(given, options);
  takeRecording(given, options);
  given.take("report", options.report);
  given.take("reference", options.references);
  return call(given, options, compare, [](const ComparedRecording& found) { return toPython(found.document); });
}

Answer trendIn(const py::dict& arguments)
{
  const Given given(arguments);
  TrendOptions options;
  takeSubject(given, options);
  given.take("recordings", options.recordings);
  given.take("reference", options.references);
  given.take("out", options.out);
  given.take("report", options.report);
  return call(given, options, trend, [](const Trend& found) { return toPython(documentOf(found)); });
}

Answer indicatorsIn(const py::dict& arguments)
{
  const Given given(arguments);
  IndicatorsOptions options;
  takeSignals(given, options);
  given.take("models", options.models);
  given.take("baseline", options.baseline);
  given.take("save_baseline", options.save_baseline);
  given.take("out", options.out);
  given.take("carry", options.carry);
  if (options.carry && (options.baseline.empty() || options.models.empty()))
  {
    throw InputError("carry needs baseline and models");
  }
  return call(given, options, indicators,
              [](const AssessedWindows& found) { return toPython(documentOf(reportOf(found))); });
}

Answer remainingIn(const py::dict& arguments)
{
  const Given given(arguments);
  RemainingOptions options;
  takeSignals(given, options);
  given.take("hours", options.hours);
  given.take("baseline", options.baseline);
  given.take("duty", options.duty);
  given.take("lost_motion_limit", options.lost_motion_limit);
  given.take("use_record", options.use_record);
  return call(given, options, remaining, [](const Remaining& found) { return toPython(documentOf(reportOf(found))); });
}

Answer checkUpIn(const py::dict& arguments)
{
  const Given given(arguments);
  CheckUpOptions options;
  given.take("arm", options.arm);
  given.take("joint", options.joint);
  given.take("out", options.out);
  given.take("file_format", options.format);
  given.take("force", options.force);
  const CheckUpMotion motion = withoutLock([&] { return writeCheckUp(options); });
  return { toPython(documentOf(reportOf(motion))), {} };
}

template <SweepResult (*WORK)(const SweepOptions&)>
Answer sweepIn(const py::dict& arguments)
{
  const Given given(arguments);
  SweepOptions options;
  takeConfiguration(given, options);
  given.take("plan", options.plan);
  given.take("out", options.out);
  given.take("jobs", options.jobs);
  requireWithin("jobs", options.jobs, "-", JOBS);
  std::array<std::uint64_t, 2> shard{ options.shard, options.shards };
  given.take("shard", shard);
  if (shard[0] >= shard[1])
  {
    throw InputError("shard = " + shortText(given["shard"]) + " must be (i, n) with 0 <= i < n");
  }
  options.shard = shard[0];
  options.shards = shard[1];
  const auto work = [](const SweepOptions& asked)
  {
    const SweepResult found = WORK(asked);
    if (found.rows_without_forces > 0)
    {
      asked.watch.notice(std::to_string(found.rows_without_forces) + " " + WITHOUT_FORCES);
    }
    return found;
  };
  return call(given, options, work, [](const SweepResult& found) { return toPython(documentOf(found)); });
}
}  // namespace
}  // namespace hjt

PYBIND11_MODULE(_recordings, module)
{
  module.doc() = "Functions on recordings and data sets: options by name in, a document and the notices out.";
  pybind11::module::import("harmonic_joint_twin._hjt");  // its errors and COMPARISON_DTYPE
  module.def("arm", &hjt::armIn, pybind11::arg("arguments"), "An arm in closed loop along its set points.");
  hjt::bindArm(module);
  module.def("follow", &hjt::followIn, pybind11::arg("arguments"), "Joints beside their twins, and their rows.");
  module.def("identify", &hjt::identifyIn, pybind11::arg("arguments"), "Gain, friction, inertia and ripple.");
  module.def("check", &hjt::checkIn, pybind11::arg("arguments"), "What of an arm's recording is usable.");
  module.def("compare", &hjt::compareIn, pybind11::arg("arguments"), "Verdict and page.");
  module.def("trend", &hjt::trendIn, pybind11::arg("arguments"), "Friction over many recordings.");
  module.def("indicators", &hjt::indicatorsIn, pybind11::arg("arguments"), "Windows and their assessment.");
  module.def("remaining", &hjt::remainingIn, pybind11::arg("arguments"), "Use and remaining life.");
  module.def("checkup", &hjt::checkUpIn, pybind11::arg("arguments"), "The motion in which faults are seen best.");
  module.def("sweep", &hjt::sweepIn<hjt::sweep>, pybind11::arg("arguments"), "A plan of many runs.");
  module.def("lives", &hjt::sweepIn<hjt::sweepLives>, pybind11::arg("arguments"), "A plan of lives.");
}
