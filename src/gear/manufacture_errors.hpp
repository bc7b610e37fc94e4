// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <Eigen/Core>

#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
/// Cumulative pitch deviations of the teeth or spaces of a part (ISO 1328-1), counter-clockwise > 0 [m].
///
/// Seeded:  F_i = A sum_k cos(2 pi k i / Z + phase_k) / k,  k = 1 ... Z/2
/// where    A        makes the largest minus the smallest value equal to the total cumulative pitch deviation Fp
///          phase_k  k-th number of the generator mt19937 over 2^32, times 2 pi: equal on every platform
///
/// The amplitudes 1/k are those of a gear that is cut tooth by tooth: a drive with two encoders shows 6.9" at two and
/// 3.1" at four lines a turn of its wave generator. Deviations from a table are not scaled.
///
/// `key` is the table's parameter, for the error text. @throws ParameterError if the table is invalid.
Eigen::VectorXd pitchDeviations(const PitchParameters& pitch, int teeth, const std::string& key);
Eigen::VectorXd flexsplinePitch(const ManufactureParameters& manufacture, const GearParameters& gear);
Eigen::VectorXd circularSplinePitch(const ManufactureParameters& manufacture, const GearParameters& gear);

/// Position errors of the flexspline's teeth and the circular spline's spaces, in the axes that the tooth or space has
/// in a perfect gear.
///
/// Flexspline, with a = angle of a tooth at rest: its pitch deviations, and
/// eccentricity (x, y):  along x cos a + y sin a,    across y cos a - x sin a            (run-out of the teeth)
///
/// Circular spline, with a = angle from space 0: its pitch deviations, and
/// eccentricity (x, y):  along x cos a + y sin a,    across y cos a - x sin a            (moved as a whole)
/// ellipticity (c, s):   along c cos 2a + s sin 2a,  across (s cos 2a - c sin 2a) / 2    (bent without stretch)
struct ManufactureErrors
{
  /// @throws ParameterError if a table is invalid.
  ManufactureErrors(const ManufactureParameters& manufacture, const GearParameters& gear);

  Eigen::VectorXd tooth_across;  ///< for each flexspline tooth, counter-clockwise > 0 [m]
  Eigen::VectorXd tooth_along;   ///< for each flexspline tooth, outwards > 0 [m]
  Eigen::VectorXd space_across;  ///< for each space of the circular spline, counter-clockwise > 0 [m]
  Eigen::VectorXd space_along;   ///< for each space of the circular spline, outwards > 0 [m]
};
}  // namespace hjt
