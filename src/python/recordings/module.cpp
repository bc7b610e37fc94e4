// SPDX-License-Identifier: BSD-3-Clause
// Functions on recordings and data sets in Python: the module _recordings. Their signatures are in
// python/harmonic_joint_twin/_commands.py.
#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "datasets/check_up_file.hpp"
#include "datasets/sweep.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "python/comparison_row.hpp"
#include "python/recordings/calls.hpp"
#include "recordings/arm_run.hpp"
#include "recordings/compare.hpp"
#include "recordings/follow.hpp"
#include "recordings/identify.hpp"
#include "recordings/indicators.hpp"
#include "recordings/recording_check.hpp"
#include "recordings/remaining.hpp"
#include "recordings/trend.hpp"

namespace hjt
{
namespace
{
/// Reads the rows of a recording from columns. @throws InputError if columns are missing or differ in shape.
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
    throw InputError("recording: columns 'time', of shape (rows,), and 'position' are required");
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

/// Reads the options of a function on a recording, which is a file or columns. @throws InputError.
template <class Options>
void takeRecording(const Given& given, Options& options)
{
  const py::object columns = given.columns("recording");
  takeOptions(given, options);
  if (columns)
  {
    takeRows(columns, options);
  }
}

/// Reads options and recordings. `at_hand` has the columns of each recording by name, as arrays of shape (rows,).
template <class Options>
void takeSignals(const Given& given, Options& options)
{
  options.at_hand = py::cast<std::map<std::string, Columns>>(given["at_hand"]);
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
  takeOptions(given, options);
  const py::object columns = given["columns"];
  for (const auto& [signal, column] : columns.is_none() ? py::dict() : py::dict(columns))
  {
    nameColumn(options, py::cast<std::string>(py::str(signal)), py::cast<std::string>(py::str(column)));
  }
}

Answer followIn(const py::dict& arguments)
{
  const Given given(arguments);
  FollowOptions options;
  takeRecording(given, options);
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

Answer checkUpIn(const py::dict& arguments)
{
  CheckUpOptions options;
  takeOptions(Given(arguments), options);
  const CheckUpMotion motion = withoutLock([&] { return writeCheckUp(options); });
  return { toPython(documentOf(reportOf(motion))), {} };
}

template <SweepResult (*WORK)(const SweepOptions&)>
SweepResult sweepAndTell(const SweepOptions& asked)
{
  const SweepResult found = WORK(asked);
  if (found.rows_without_forces > 0)
  {
    asked.watch.notice(std::to_string(found.rows_without_forces) + " " + WITHOUT_FORCES);
  }
  return found;
}

/// Defines a function of the module. `take` reads the options of `function`; `document` makes JSON of its result.
template <class Options, class Result, class Document>
void define(py::module& module, const char* name, const char* text, void (*take)(const Given&, Options&),
            Result (*function)(const Options&), const Document& document)
{
  const auto answer = [=](const py::dict& arguments)
  {
    const Given given(arguments);
    Options options;
    take(given, options);
    return call(given, options, function, [&](const Result& found) { return toPython(document(found)); });
  };
  module.def(name, answer, py::arg("arguments"), text);
  listOptions<Options>(module, name);
}

/// Defines a function of the module, whose result becomes a document by way of its report.
template <class Options, class Result>
void define(py::module& module, const char* name, const char* text, void (*take)(const Given&, Options&),
            Result (*function)(const Options&))
{
  define(module, name, text, take, function, [](const Result& found) { return documentOf(reportOf(found)); });
}

void define(py::module& module)
{
  define(module, "check", "Checks which parts of an arm's recording are usable.", takeRecording<RecordingOptions>,
         checkRecording, [](const RecordingCheck& found) { return documentOf(found); });
  define(module, "identify", "Identifies gain, friction, inertia and ripple.", takeRecording<IdentifyOptions>, identify,
         [](const Identified& found) { return documentOf(reportOf(found).whole()); });
  define(module, "compare", "Computes verdict and report page.", takeRecording<ComparisonOptions>, compare,
         [](const ComparedRecording& found) { return found.document; });
  define(module, "trend", "Computes the trend of friction over many recordings.", takeOptions<TrendOptions>, trend,
         [](const Trend& found) { return documentOf(found); });
  define(module, "indicators", "Computes windows of indicators and their assessment.", takeSignals<IndicatorsOptions>,
         indicators);
  define(module, "remaining", "Computes use and remaining life.", takeSignals<RemainingOptions>, remaining);
  define(module, "sweep", "Simulates a plan of many runs.", takeOptions<SweepOptions>, sweepAndTell<sweep>,
         [](const SweepResult& found) { return documentOf(found); });
  define(module, "lives", "Simulates a plan of lives.", takeOptions<SweepOptions>, sweepAndTell<sweepLives>,
         [](const SweepResult& found) { return documentOf(found); });
  module.def("follow", followIn, py::arg("arguments"), "Compares joints with their twins, row by row.");
  listOptions<FollowOptions>(module, "follow");
  module.def("checkup", checkUpIn, py::arg("arguments"), "Makes the motion that shows faults best.");
  listOptions<CheckUpOptions>(module, "checkup");
  module.def("arm", armIn, py::arg("arguments"), "Simulates an arm in closed loop along its set points.");
  listOptions<ArmRunOptions>(module, "arm");
}
}  // namespace
}  // namespace hjt

PYBIND11_MODULE(_recordings, module)
{
  module.doc() = "Functions on recordings and data sets: options by name as input, a document and notices as output.";
  pybind11::module::import("harmonic_joint_twin._hjt");  // defines the errors and COMPARISON_DTYPE
  module.attr("OPTIONS") = pybind11::dict();
  hjt::define(module);
  hjt::bindArm(module);
}
