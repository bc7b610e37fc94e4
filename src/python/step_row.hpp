// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pybind11/stl.h>

#include <cstdint>
#include <string>
#include <vector>

#include "harmonic_joint_twin/base/errors.hpp"
#include "harmonic_joint_twin/twin/twin.hpp"
#include "python/bindings.hpp"

namespace hjt
{
/// One row of a run: all outputs and readings of an instant. Names as in the columns of `joint_twin simulate`.
struct StepRow
{
  std::int64_t stamp;
  double time;
  double motor_angle;
  double motor_velocity;
  double output_angle;
  double output_velocity;
  double motor_torque;
  double load_torque;
  double temperature;
  double housing_temperature;
  double wave_generator_torque;
  double joint_torque;
  double friction_torque;
  double torsional_stiffness;
  double energy_residual;
  double dissipated_energy;
  double released_energy;
  double residual;
  double phase_advance;
  double motor_angle_encoder;
  double motor_velocity_encoder;
  double output_angle_encoder;
  double output_velocity_encoder;
  double motor_torque_reading;
  std::int64_t motor_count;
  std::uint32_t output_count;
  std::uint32_t iterations;
  std::uint32_t substeps;
  bool brake;
  bool converged;
  bool on_surface;
};

inline StepRow rowOf(const Twin& twin) noexcept
{
  const JointOutputs& o = twin.outputs();
  const EncoderReadings e = twin.encoders();
  return { o.stamp,
           toSeconds(o.stamp),
           o.motor_angle,
           o.motor_velocity,
           o.output_angle,
           o.output_velocity,
           o.motor_torque,
           o.load_torque,
           o.temperature,
           o.housing_temperature,
           o.wave_generator_torque,
           o.joint_torque,
           o.friction_torque,
           o.torsional_stiffness,
           o.energy_residual,
           o.dissipated_energy,
           o.released_energy,
           o.residual,
           o.phase_advance,
           e.motor_angle,
           e.motor_velocity,
           e.output_angle,
           e.output_velocity,
           twin.motorTorqueReading(),
           e.motor_count,
           e.output_count,
           o.iterations,
           o.substeps,
           o.brake_engaged,
           o.converged,
           twin.onSurface() };
}

using StepRows = py::array_t<StepRow>;

/// The user's array, or a new one. @throws InputError.
inline StepRows rowsFor(const std::vector<py::ssize_t>& shape, const py::object& out)
{
  if (out.is_none())
  {
    return StepRows(shape);
  }
  if (!py::isinstance<StepRows>(out))
  {
    throw InputError("out must be an array of dtype STEP_DTYPE");
  }
  auto rows = py::reinterpret_borrow<StepRows>(out);
  const py::object expected = py::tuple(py::cast(shape));
  if (!py::object(rows.attr("shape")).equal(expected) || !rows.writeable())
  {
    throw InputError("out has shape " + py::cast<std::string>(py::str(rows.attr("shape"))) +
                     (rows.writeable() ? "" : ", not writeable") +
                     ", expected: " + py::cast<std::string>(py::str(expected)) + ", writeable");
  }
  if ((rows.flags() & py::array::c_style) == 0)
  {
    throw InputError("out must be contiguous");
  }
  return rows;
}
}  // namespace hjt
