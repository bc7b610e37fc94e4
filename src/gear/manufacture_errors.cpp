// SPDX-License-Identifier: BSD-3-Clause
#include "gear/manufacture_errors.hpp"

#include <cmath>
#include <cstdint>
#include <random>

#include "base/csv_table.hpp"
#include "gear/angle.hpp"
#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt
{
namespace
{
Eigen::VectorXd seededDeviations(double total, int seed, int teeth)
{
  if (total == 0.0)
  {
    return Eigen::VectorXd::Zero(teeth);
  }
  constexpr double NUMBERS = 4294967296.0;  // number of values of the random generator
  std::mt19937 random(static_cast<std::uint32_t>(seed));
  Eigen::VectorXd deviations = Eigen::VectorXd::Zero(teeth);
  for (int k = 1; k <= teeth / 2; ++k)
  {
    const double phase = TWO_PI * static_cast<double>(random()) / NUMBERS;
    for (int i = 0; i < teeth; ++i)
    {
      deviations[i] += std::cos(TWO_PI * (k * i % teeth) / teeth + phase) / k;
    }
  }
  return total / (deviations.maxCoeff() - deviations.minCoeff()) * deviations;
}

Eigen::VectorXd readDeviations(const std::string& path, int teeth)
{
  constexpr double MAX_ERROR = 1e-4;  // largest allowed deviation, a tenth of the tooth pitch of the shipped gear [m]
  NumberTable<2> table(path, { "tooth", "deviation" });
  Eigen::VectorXd deviations(teeth);
  std::array<double, 2> row{};
  int tooth = 0;
  for (; table.read(row); ++tooth)
  {
    if (tooth == teeth || row[0] != tooth)
    {
      throw InputError(table.place() + ": column 'tooth' must count from 0 to " + std::to_string(teeth - 1));
    }
    table.requireRange(1, row[1], { -MAX_ERROR, MAX_ERROR }, "m");
    deviations[tooth] = row[1];
  }
  if (tooth != teeth)
  {
    throw InputError(table.place() + ": " + std::to_string(tooth) + " teeth instead of " + std::to_string(teeth));
  }
  return deviations;
}
}  // namespace

Eigen::VectorXd pitchDeviations(const PitchParameters& pitch, int teeth, const std::string& key)
{
  if (pitch.table == NO_FILE)
  {
    return seededDeviations(pitch.deviation, pitch.seed, teeth);
  }
  try
  {
    return readDeviations(pitch.table, teeth);
  }
  catch (const InputError& error)
  {
    throw ParameterError(key + ": " + error.what());
  }
}

Eigen::VectorXd flexsplinePitch(const ManufactureParameters& manufacture, const GearParameters& gear)
{
  return pitchDeviations(manufacture.flexspline_pitch, gear.teeth_flexspline, "manufacture.flexspline_pitch_table");
}

Eigen::VectorXd circularSplinePitch(const ManufactureParameters& manufacture, const GearParameters& gear)
{
  return pitchDeviations(manufacture.circular_spline_pitch, gear.teeth_circular_spline,
                         "manufacture.circular_spline_pitch_table");
}

ManufactureErrors::ManufactureErrors(const ManufactureParameters& manufacture, const GearParameters& gear)
  : tooth_across(flexsplinePitch(manufacture, gear))
  , tooth_along(gear.teeth_flexspline)
  , space_across(circularSplinePitch(manufacture, gear))
  , space_along(gear.teeth_circular_spline)
{
  const auto& [out_x, out_y] = manufacture.flexspline_eccentricity;
  for (int i = 0; i < gear.teeth_flexspline; ++i)
  {
    const double a = TWO_PI * i / gear.teeth_flexspline;
    tooth_across[i] += out_y * std::cos(a) - out_x * std::sin(a);
    tooth_along[i] = out_x * std::cos(a) + out_y * std::sin(a);
  }
  const auto& [x, y] = manufacture.circular_spline_eccentricity;
  const auto& [cosine, sine] = manufacture.circular_spline_ellipticity;
  for (int k = 0; k < gear.teeth_circular_spline; ++k)
  {
    const double a = TWO_PI * k / gear.teeth_circular_spline;
    const double c = std::cos(a);
    const double s = std::sin(a);
    const double c2 = std::cos(2.0 * a);
    const double s2 = std::sin(2.0 * a);
    space_across[k] += y * c - x * s + 0.5 * (sine * c2 - cosine * s2);
    space_along[k] = x * c + y * s + cosine * c2 + sine * s2;
  }
}
}  // namespace hjt
