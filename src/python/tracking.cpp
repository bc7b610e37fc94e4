// SPDX-License-Identifier: BSD-3-Clause
#include <pybind11/stl.h>

#include <memory>
#include <optional>

#include "harmonic_joint_twin/base/errors.hpp"
#include "params/choices.hpp"
#include "python/bindings.hpp"
#include "python/comparison_row.hpp"
#include "python/configuration.hpp"
#include "python/surface_source.hpp"
#include "tracking/tracker.hpp"

namespace hjt
{
namespace
{
using Values = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// A column of a recording; empty if the quantity was not recorded.
class Recorded
{
public:
  /// Takes the values of a column. @throws InputError unless the column has `rows` values.
  Recorded(const char* name, const std::optional<Values>& values, py::ssize_t rows) : values_(values)
  {
    if (values_ && (values_->ndim() != 1 || values_->size() != rows))
    {
      throw InputError(std::string(name) + " has " + std::to_string(values_->size()) + " values in " +
                       std::to_string(values_->ndim()) + " dimensions, expected: one dimension with " +
                       std::to_string(rows) + " values, as many as time");
    }
    data_ = values_ ? values_->data() : nullptr;
  }

  explicit operator bool() const noexcept { return data_ != nullptr; }
  double operator[](py::ssize_t row) const noexcept { return data_[row]; }

private:
  std::optional<Values> values_;
  const double* data_;
};

/// A twin that receives the rows of a recording.
class TrackerObject
{
public:
  TrackerObject(const Configuration& parameters, const std::string& mode, const std::optional<std::string>& cache,
                const py::object& progress)
    : tracker_(makeTracker(parameters.values(), mode, cache, progress))
  {
  }

  Tracker& tracker()
  {
    in_use_.refuse();
    return *tracker_;
  }

  py::array_t<ComparisonRow> follow(const Values& time, const Values& position, const Values& current,
                                    const std::optional<Values>& load, const std::optional<Values>& temperature,
                                    const std::optional<Values>& motor_angle, bool at_end, const py::object& progress)
  {
    const InUse::Hold hold = in_use_.hold();
    const py::ssize_t rows = time.size();
    const Recorded times("time", time, rows);
    const Recorded positions("position", position, rows);
    const Recorded currents("current", current, rows);
    const Recorded loads("load", load, rows);
    const Recorded temperatures("temperature", temperature, rows);
    const Recorded motor_angles("motor_angle", motor_angle, rows);
    std::vector<ComparisonRow> compared;
    withoutLock(
        [&]
        {
          RunCheck check(progress);
          for (py::ssize_t i = 0; i < rows; ++i)
          {
            MotionRow row;
            row.time = times[i];
            row.received = row.time;
            row.position = positions[i];
            row.current = currents[i];
            row.temperature = temperatures ? temperatures[i] : row.temperature;
            row.motor_angle = motor_angles ? motor_angles[i] : row.motor_angle;
            if (loads)
            {
              tracker_->pushLoad(row.time, loads[i]);
            }
            tracker_->push(row);
            take(false, compared);
            check(i + 1, rows);
          }
          take(at_end, compared);
          check.end();
        });
    return py::array_t<ComparisonRow>(static_cast<py::ssize_t>(compared.size()), compared.data());
  }

private:
  static std::unique_ptr<Tracker> makeTracker(const Parameters& parameters, const std::string& name,
                                              const std::optional<std::string>& cache, const py::object& progress)
  {
    for (const auto& [choice, mode] : choiceNames(InputMode{}))
    {
      if (name == choice && mode != InputMode::COMMANDS)
      {
        SurfaceSourceOf source(cache, progress);
        auto tracker = withoutLock([&, taken = mode, given = parameters]
                                   { return std::make_unique<Tracker>(given, taken, source.source()); });
        source.warn();
        return tracker;
      }
    }
    throw InputError("mode = '" + name + "' must be 'motion', 'torque' or 'observer'");
  }

  void take(bool at_end, std::vector<ComparisonRow>& compared)
  {
    while (const std::optional<Comparison> now = tracker_->pop(at_end))
    {
      compared.push_back(rowOf(*now));
    }
  }

  std::unique_ptr<Tracker> tracker_;
  InUse in_use_{ "tracker" };
};

py::dict countersOf(TrackerObject& self)
{
  const TrackerCounters counters = self.tracker().counters();
  py::dict named;
  named["compared"] = counters.compared;
  named["refused"] = counters.refused;
  named["gaps"] = counters.gaps;
  named["restarts"] = counters.restarts;
  named["outside"] = counters.outside;
  named["without_load"] = counters.without_load;
  named["refused_temperatures"] = counters.refused_temperatures;
  named["solver_failures"] = counters.solver_failures;
  return named;
}
}  // namespace

void bindTracking(py::module& module)
{
  PYBIND11_NUMPY_DTYPE(ComparisonRow, time, position_measured, position_predicted, position_residual, position_band,
                       velocity_measured, velocity_predicted, velocity_residual, current_measured, current_predicted,
                       current_residual, current_band, residual_torque, joint_torque, friction_torque, load_torque,
                       temperature, housing_temperature, load_told, temperature_received, sticking, after_gap,
                       outside_band);
  module.attr("COMPARISON_DTYPE") = py::dtype::of<ComparisonRow>();

  py::class_<TrackerObject>(
      module, "Tracker",
      "A sound joint beside a recorded one, as in `joint_twin follow` and the node beside a robot.\n\n"
      "Tracker(parameters, mode='motion', cache=None, progress=None). mode: 'motion' predicts the current of the "
      "recorded motion, 'torque' the motion of the recorded current, 'observer' corrects the twin towards the recorded "
      "angles. parameters: those of the joint, for example Parameters('joints/elbow.yaml', 'beside_robot.yaml'); "
      "telemetry.load says where the load comes from. cache, progress: as for Twin. Raises ParameterError.")
      .def(py::init<const Configuration&, const std::string&, const std::optional<std::string>&, const py::object&>(),
           py::arg("parameters"), py::arg("mode") = "motion", py::arg("cache") = py::none(),
           py::arg("progress") = py::none())
      .def("follow", &TrackerObject::follow, py::arg("time"), py::arg("position"), py::arg("current"),
           py::arg("load") = py::none(), py::arg("temperature") = py::none(), py::arg("motor_angle") = py::none(),
           py::arg("at_end") = true, py::arg("progress") = py::none(),
           "Processes rows of a recording without the interpreter's lock, as arrays of shape (rows,): time [s], "
           "ascending; position of the joint [rad]; current of the motor [A]; load at the output, > 0 resists positive "
           "motion [N.m]; temperature of the drive [degC]; motor_angle [rad]; None: not recorded. at_end: whether no "
           "row follows; if False, the last 36 ms stay for the next call. progress: as for Twin.run.\n\n"
           "Returns a structured array of shape (compared rows,) with dtype COMPARISON_DTYPE. Impossible rows are "
           "ignored and counted. Raises InputError.")
      .def(
          "reset", [](TrackerObject& self) { self.tracker().reset(); }, "Prepares the tracker for another recording.")
      .def_property_readonly("counters", &countersOf, "counts of events, by name: dict of str to int")
      .def_property_readonly(
          "lag", [](TrackerObject& self) { return self.tracker().lag(); },
          "delay of the recorded current, or speed, behind its prediction [s] or None")
      .def_property_readonly(
          "outside_share", [](TrackerObject& self) { return self.tracker().outsideShare(); },
          "share of the rows in the last 30 s whose current is outside its band [-]")
      .def_property_readonly(
          "signal_indicators", [](TrackerObject& self) { return self.tracker().signalIndicators(); },
          "indicators of the recorded joint's last window: SignalIndicators")
      .def_property_readonly(
          "assessment", [](TrackerObject& self) { return self.tracker().assessment(); },
          "assessment of the recorded joint by its indicators: Assessment");
}
}  // namespace hjt
