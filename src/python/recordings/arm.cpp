// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "arm/arm_configuration.hpp"
#include "arm/arm_recorder.hpp"
#include "arm/set_points.hpp"
#include "base/range.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "output/process_end.hpp"
#include "python/bindings.hpp"
#include "python/recordings/calls.hpp"
#include "recordings/arm_run.hpp"

namespace hjt
{
namespace
{
/// Set points from columns: `time`, `position`, and optionally `velocity` and `acceleration`.
/// @throws InputError if columns are missing or differ in shape.
std::vector<ArmSetPoint> setPointsOf(const py::object& columns)
{
  requireColumns(columns, "motion");
  const MotionColumn times(columns, "time");
  const MotionColumn positions(columns, "position");
  const MotionColumn velocities(columns, "velocity");
  const MotionColumn accelerations(columns, "acceleration");
  const auto fits = [&](const MotionColumn& column)
  { return column.rows() == times.rows() && column.width() == positions.width(); };
  if (!times || !positions || times.width() != 1 || !fits(positions) || (velocities && !fits(velocities)) ||
      (accelerations && !fits(accelerations)))
  {
    throw InputError(
        "motion: columns 'time', of shape (rows,), and 'position', of shape (rows, joints), are required; columns "
        "'velocity' and 'acceleration' must have the shape of 'position'");
  }
  std::vector<ArmSetPoint> points(static_cast<std::size_t>(times.rows()));
  for (std::size_t row = 0; row < points.size(); ++row)
  {
    points[row].time = times.at(row, 0);
    for (std::size_t joint = 0; joint < static_cast<std::size_t>(positions.width()); ++joint)
    {
      const JointMotion& motion = points[row].joints.emplace_back(
          JointMotion{ positions.at(row, joint), velocities ? velocities.at(row, joint) : 0.0,
                       accelerations ? accelerations.at(row, joint) : 0.0 });
      if (!std::isfinite(points[row].time + motion.position + motion.velocity + motion.acceleration))
      {
        throw InputError("motion: row " + std::to_string(row) + " is not finite");
      }
    }
  }
  fillRates(points, static_cast<bool>(velocities), static_cast<bool>(accelerations));
  return points;
}

/// Rows of an arm as one array for each quantity, of shape (rows,), (rows, joints) or (rows, 3).
class RowArrays
{
public:
  void add(double time, const ArmRow& row)
  {
    times_.push_back(time);
    for (std::size_t k = 0; k < row.size(); ++k)
    {
      values_[k].insert(values_[k].end(), row[k].begin(), row[k].end());
    }
  }

  py::dict arrays(std::size_t joints) const
  {
    py::dict arrays;
    arrays["timestamp"] = Values(static_cast<py::ssize_t>(times_.size()), times_.data());
    for (std::size_t k = 0; k < values_.size(); ++k)
    {
      const std::array<std::size_t, 2> shape{ times_.size(), ARM_QUANTITIES[k].width(joints) };
      arrays[ARM_QUANTITIES[k].name] = Values(shape, values_[k].data());
    }
    return arrays;
  }

private:
  std::vector<double> times_;
  ArmRow values_;
};

/// Set points of `motion`, which is the name of a file or has columns by name.
std::vector<ArmSetPoint> setPointsIn(const py::object& motion, const ArmDescription& arm)
{
  std::vector<ArmSetPoint> points =
      py::isinstance<py::str>(motion) ? readSetPoints(py::cast<std::string>(motion), arm) : setPointsOf(motion);
  requireMotion(points, arm, "motion");
  return points;
}

void requireRate(const std::optional<double>& rate)
{
  requireWithin("rate", rate.value_or(ROW_RATE.min), "Hz", ROW_RATE);
}

void warnPython(const std::vector<std::string>& notices)
{
  for (const std::string& notice : notices)
  {
    if (PyErr_WarnEx(PyExc_RuntimeWarning, notice.c_str(), 1) != 0)
    {
      throw py::error_already_set();
    }
  }
}

class ArmObject
{
public:
  explicit ArmObject(const py::dict& arguments)
  {
    const Given given(arguments);
    ConfigurationOptions options;
    takeOverlays(given, options);
    std::string arm;
    std::string identified;
    std::optional<double> payload;
    std::vector<double> start;
    OptionTable table;
    table.add("arm", arm, "name in config/arms, or a file");
    table.add("identified", identified, "directory of overlays").existingDirectory();
    table.add("--fault", options.faults, "JOINT:KIND:SEVERITY[:PLACE[:ONSET]]");
    table.add("payload", payload, "mass [kg]");
    table.add("start", start, "angles [rad]");
    given.take(table);
    arm_ = readArmDescription(findArm(arm, configDirectory(options)));
    arm_.payload.mass = payload.value_or(arm_.payload.mass);
    requirePayload(arm_.payload);
    addIdentifiedGains(identified, arm_);
    const std::vector<Parameters> drives = armDrives(arm_, options, identified, options.faults);
    if (given["start"].is_none())
    {
      start.resize(arm_.joints.size());
    }
    if (start.size() != arm_.joints.size())
    {
      throw InputError("start: " + std::to_string(arm_.joints.size()) + " finite angles are required [rad]");
    }
    ArmSetPoint point;
    for (const double angle : start)
    {
      point.joints.push_back({ angle, 0.0, 0.0 });
    }
    requireMotion({ point }, arm_, "start");
    PythonWatch watch(given["progress"]);
    const Watch followed = watch.watch();
    try
    {
      withoutLock([&] { moving_.emplace(arm_, drives, ArmMotion({ point }), surfaceSource(followed)); });
    }
    catch (const Stopped&)
    {
      // The call ends, because Python has raised an exception. `finish` throws this exception.
    }
    warnPython(watch.finish());
    recorder_.emplace(arm_, *moving_);
    reset();
  }

  void reset()
  {
    const InUse::Hold hold = in_use_.hold();
    InterruptCheck check;
    moving_->reset(SIMULATION_EPOCH);
    withoutLock(
        [&]
        {
          while (moving_->step(moving_->motionBegin()))
          {
            check();
          }
        });
  }

  double move(const py::object& motion)
  {
    const InUse::Hold hold = in_use_.hold();  // other threads may run while this function reads or warns
    std::vector<ArmSetPoint> points = setPointsIn(motion, arm_);
    requireRates(points, arm_, "motion");
    const double change = straightenTimes(points);
    warnPython(change > 0.0 ? std::vector<std::string>{ straightenedText(change) } : std::vector<std::string>());
    const double length = points.back().time - points.front().time;
    const std::vector<ArmSetPoint> rest = toRest(points.back());
    points.insert(points.end(), rest.begin() + 1, rest.end());
    ArmMotion next(std::move(points));
    moving_->follow(next);
    return length;
  }

  py::dict run(double duration, const std::optional<double>& rate)
  {
    requireRate(rate);
    requireWithin("duration", duration, "s", { 0.0, LONGEST });
    const InUse::Hold hold = in_use_.hold();
    const ArmTwin& twin = moving_->twin();
    const Stamp end = twin.stamp() + toStampLength(duration);
    const double wanted = rate.value_or(arm_.state_rate);
    const auto row_steps = std::max(std::llround(1e9 / wanted / static_cast<double>(twin.stepLength())), 1LL);
    const Stamp begin = moving_->motionBegin() / twin.stepLength();
    const std::uint64_t failures = countersOf(twin).solver_failures;
    InterruptCheck check;
    RowArrays rows;
    withoutLock(
        [&]
        {
          while (moving_->step(end))
          {
            if ((twin.stamp() / twin.stepLength() - begin) % row_steps == 0)
            {
              rows.add(seconds(), recorder_->row());
            }
            check();
          }
        });
    if (const std::uint64_t more = countersOf(twin).solver_failures - failures; more > 0)
    {
      warnPython({ "the solver found no equilibrium in " + std::to_string(more) +
                   " steps, in which the twin kept its last converged state" });
    }
    return rows.arrays(arm_.joints.size());
  }

  void injectFault(const std::string& text)
  {
    in_use_.refuse();
    std::vector<Parameters> drives;
    for (std::size_t i = 0; i < moving_->twin().joints(); ++i)
    {
      drives.push_back(moving_->twin().drive(i).parameters());
      drives.back().faults.clear();
    }
    addArmFaults(arm_, { text }, drives);
    for (std::size_t i = 0; i < drives.size(); ++i)
    {
      for (const Fault& fault : drives[i].faults)
      {
        moving_->twin().drive(i).injectFault(moving_->twin().stamp(), fault);
      }
    }
  }

  void setWrench(const std::array<double, 3>& force, const std::array<double, 3>& moment)
  {
    in_use_.refuse();
    for (std::size_t k = 0; k < force.size(); ++k)
    {
      if (!(std::abs(force[k]) <= MAX_WRENCH && std::abs(moment[k]) <= MAX_WRENCH))
      {
        throw InputError("wrench: each component of force [N] and moment [N.m] must be within -1000 ... 1000");
      }
    }
    moving_->twin().setWrench({ force, moment });
  }

  void setPayload(double mass, const std::array<double, 3>& centre)
  {
    in_use_.refuse();
    requirePayload({ mass, centre });
    moving_->setPayload({ mass, centre });
  }

  void setTemperature(double temperature, const std::optional<std::string>& joint)
  {
    in_use_.refuse();
    requireWithin("temperature", temperature, "degC", { MIN_TEMPERATURE, MAX_TEMPERATURE });
    const std::optional<std::size_t> only = joint ? findJoint(arm_, *joint) : std::nullopt;
    if (joint && !only)
    {
      throw InputError("joint: the arm has no joint '" + *joint + "'; its joints are " + shortNames(arm_));
    }
    ArmTwin& twin = moving_->twin();
    for (std::size_t i = only.value_or(0); i < (only ? *only + 1 : twin.joints()); ++i)
    {
      twin.drive(i).setTemperature(twin.stamp(), temperature);
    }
  }

  double time() const
  {
    in_use_.refuse();
    return seconds();
  }

  py::dict counters() const
  {
    in_use_.refuse();
    py::dict found = stepCounters(countersOf(moving_->twin()));
    found["feedback_limited"] = moving_->controller().limitedControls();
    return found;
  }

  std::vector<std::string> joints() const
  {
    std::vector<std::string> names;
    for (const ArmJoint& joint : arm_.joints)
    {
      names.push_back(joint.short_name);
    }
    return names;
  }

  py::object protectiveStop() const
  {
    in_use_.refuse();
    const std::optional<ProtectiveStop>& stop = moving_->protectiveStop();
    if (!stop)
    {
      return py::none();
    }
    py::dict found;
    found["joint"] = arm_.joints[stop->joint].short_name;
    found["reason"] = stop->reason;
    found["time"] = toSeconds(stop->stamp - moving_->motionBegin());
    return std::move(found);
  }

private:
  static constexpr double MAX_WRENCH = 1000.0;  // largest component of force and moment, as for ~wrench [N], [N.m]
  static constexpr double LONGEST = 1e6;        // longest duration of a run [s]

  static void requirePayload(const Payload& payload)
  {
    if (const std::string errors = payloadErrors(payload); !errors.empty())
    {
      throw InputError("payload: " + errors);
    }
  }

  double seconds() const { return toSeconds(moving_->twin().stamp() - moving_->motionBegin()); }

  ArmDescription arm_;
  std::optional<MovingArm> moving_;
  std::optional<ArmRecorder> recorder_;
  InUse in_use_{ "Arm" };
};
}  // namespace

Answer armIn(const py::dict& arguments)
{
  const Given given(arguments);
  ArmRunOptions options;
  const py::object columns = given.columns("motion");
  takeOptions(given, options);
  if (columns)
  {
    options.set_points = setPointsOf(columns);
  }
  RowArrays rows;
  options.take = [&](double time, const ArmRow& row) { rows.add(time, row); };
  return call(given, options, runArm,
              [&](const ArmRun& run)
              {
                py::object document = toPython(documentOf(reportOf(run)));
                document["rows"] = rows.arrays(run.joints.size());
                return document;
              });
}

void bindArm(py::module& module)
{
  py::class_<ArmObject>(module, "Arm",
                        "An arm in closed loop that is simulated in pieces; harmonic_joint_twin.Arm uses it.")
      .def(py::init<const py::dict&>(), py::arg("arguments"))
      .def("move", &ArmObject::move, py::arg("motion"))
      .def("run", &ArmObject::run, py::arg("duration"), py::arg("rate") = py::none())
      .def("inject_fault", &ArmObject::injectFault, py::arg("fault"))
      .def("set_wrench", &ArmObject::setWrench, py::arg("force"), py::arg("moment"))
      .def("set_payload", &ArmObject::setPayload, py::arg("mass"), py::arg("centre"))
      .def("set_temperature", &ArmObject::setTemperature, py::arg("temperature"), py::arg("joint") = py::none())
      .def("reset", &ArmObject::reset)
      .def_property_readonly("time", &ArmObject::time)
      .def_property_readonly("joints", &ArmObject::joints)
      .def_property_readonly("counters", &ArmObject::counters)
      .def_property_readonly("protective_stop", &ArmObject::protectiveStop);
}
}  // namespace hjt
