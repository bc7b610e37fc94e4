// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "solver/response_surface.hpp"

#include "gear/angle.hpp"
#include "model/faults/joint_faults.hpp"
#include "model/joint_model.hpp"
#include "surface/faulty_surface.hpp"
#include "surface/surface_cache.hpp"
#include "test/support/temporary_folder.hpp"
#include "test_parameters.hpp"
#include "twin_runs.hpp"

namespace hjt
{
constexpr double ARC_SECOND = PI / 180.0 / 3600.0;
/// The rated torque of the catalogue, and what it is at the motor.
constexpr double RATED_TORQUE = 108.0;  // N.m
constexpr double RATED_MOTOR_TORQUE = RATED_TORQUE / 101.0;

/// A folder that every test of this program shares as cache, so that the surface is built once.
inline const std::string& cacheDirectory()
{
  static const TemporaryFolder FOLDER;
  static const std::string PATH = FOLDER.path().string();
  return PATH;
}

inline Parameters surfaceParameters()
{
  return shippedParameters({ "solver.scene=auto", "input.command_timeout=10.0" });
}

inline SurfaceSource cached()
{
  return { cacheDirectory(), {}, {} };
}

constexpr const char* BROKEN_TOOTH = "tooth_root_crack:1:40";

inline FaultList faultsOf(const std::vector<std::string>& texts)
{
  FaultList faults;
  for (const std::string& text : texts)
  {
    faults.set(parseFault(text, surfaceParameters()), 0);
  }
  return faults;
}

inline JointModel brokenModel()
{
  return JointFaults(surfaceParameters(), faultsOf({ BROKEN_TOOTH })).model();
}

inline SurfaceTables brokenTables(const SurfaceSource& source = cached())
{
  return obtainSurface(surfaceParameters(), brokenModel(), "broken tooth 40 ", source).value();
}

inline const ResponseSurface& surface()
{
  static const ResponseSurface SHIPPED(
      obtainSurface(surfaceParameters(), JointModel(surfaceParameters()), "", cached())->table);
  return SHIPPED;
}

inline ResponseSurface::Place placeOn(const ResponseSurface& table, double motor_angle, double output_angle)
{
  ResponseSurface::Place place;
  EXPECT_TRUE(table.locate(motor_angle, output_angle, place)) << motor_angle << ' ' << output_angle;
  return place;
}

inline RingResponse at(double motor_angle, double output_angle, const ResponseSurface& table = surface())
{
  return table.response(placeOn(table, motor_angle, output_angle));
}
}  // namespace hjt
