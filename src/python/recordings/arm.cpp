// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "harmonic_joint_twin/base/errors.hpp"
#include "python/recordings/calls.hpp"
#include "recordings/arm_run.hpp"
#include "recordings/set_points.hpp"

namespace hjt
{
namespace
{
/// Set points of columns, `position` and, if there, `velocity` and `acceleration` of shape (rows, joints).
/// @throws InputError if columns are missing or not of one shape.
std::vector<ArmSetPoint> setPointsOf(const py::object& columns)
{
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
        "motion: columns 'time', of shape (rows,), and 'position', of shape (rows, joints), are needed; 'velocity' and "
        "'acceleration' have the shape of 'position'");
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
  requireMotion(points, "motion");
  return points;
}

/// The rows by their quantities: arrays of shape (rows,), (rows, joints) or (rows, 3).
py::dict arraysOf(const std::vector<double>& values, std::size_t joints)
{
  const std::vector<ArmRunQuantity> quantities = armRunQuantities(joints);
  std::size_t width = 1;
  for (const ArmRunQuantity& quantity : quantities)
  {
    width += quantity.width;
  }
  const std::size_t rows = values.size() / width;
  const auto block = [&](std::size_t first, std::size_t columns)
  {
    py::array_t<double> array({ rows, columns });
    for (std::size_t row = 0; row < rows; ++row)
    {
      std::copy_n(values.data() + row * width + first, columns, array.mutable_data() + row * columns);
    }
    return array;
  };
  py::dict arrays;
  py::array_t<double> times(static_cast<py::ssize_t>(rows));
  for (std::size_t row = 0; row < rows; ++row)
  {
    times.mutable_data()[row] = values[row * width];
  }
  arrays["timestamp"] = times;
  std::size_t first = 1;
  for (const ArmRunQuantity& quantity : quantities)
  {
    const std::string name = quantity.name;
    arrays[py::str(name.substr(0, name.size() - 1))] = block(first, quantity.width);
    first += quantity.width;
  }
  return arrays;
}
}  // namespace

Answer armIn(const py::dict& arguments)
{
  const Given given(arguments);
  ArmRunOptions options;
  takeConfiguration(given, options);
  given.take("arm", options.arm);
  given.take("identified", options.identified);
  given.take("faults", options.faults);
  given.take("out", options.out);
  given.take("rate", options.rate);
  given.take("force", options.force);
  const py::object motion = given["motion"];
  if (py::isinstance<py::str>(motion))
  {
    options.motion = py::cast<std::string>(motion);
  }
  else
  {
    options.set_points = setPointsOf(motion);
  }
  if (options.rate && !(*options.rate > 0.0 && std::isfinite(*options.rate)))
  {
    throw InputError("rate = " + std::to_string(*options.rate) + " [Hz] must be above 0");
  }
  std::vector<double> values;
  options.take = [&](const std::vector<double>& row) { values.insert(values.end(), row.begin(), row.end()); };
  return call(given, options, runArm,
              [&](const ArmRun& run)
              {
                py::object document = toPython(documentOf(reportOf(run)));
                document["rows"] = arraysOf(values, run.joints.size());
                return document;
              });
}
}  // namespace hjt
