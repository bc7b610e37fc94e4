// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <Eigen/Core>

#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
/// Cumulative pitch deviations of a member's teeth or spaces (ISO 1328-1), counter-clockwise > 0. [m]
///
/// Seeded:  F_i = A sum_k cos(2 pi k i / Z + phase_k) / k,  k = 1 ... Z/2
/// where    A        such that the largest less the smallest is the total cumulative pitch deviation Fp
///          phase_k  the k-th number of the generator mt19937 over 2^32, times 2 pi: the same on every platform
///
/// The amplitudes 1/k are those of a gear cut tooth after tooth: a drive with both encoders shows 6.9" at two and 3.1"
/// at four lines a turn of its wave generator. A table's deviations are taken as they are.
///
/// `key`: of the table, for the error text. @throws ParameterError on a bad table.
Eigen::VectorXd pitchDeviations(const PitchParameters& pitch, int teeth, const std::string& key);
Eigen::VectorXd flexsplinePitch(const ManufactureParameters& manufacture, const GearParameters& gear);
Eigen::VectorXd circularSplinePitch(const ManufactureParameters& manufacture, const GearParameters& gear);

/// Errors of position of the flexspline's teeth and the circular spline's spaces, each in the axes of the perfect gear
/// at its own position.
///
/// Flexspline, a the angle of a tooth at rest: its pitch deviations, and
/// eccentricity (x, y):  along x cos a + y sin a,    across y cos a - x sin a            (run-out of the teeth)
///
/// Circular spline, a the angle from space 0: its pitch deviations, and
/// eccentricity (x, y):  along x cos a + y sin a,    across y cos a - x sin a            (moved as a whole)
/// ellipticity (c, s):   along c cos 2a + s sin 2a,  across (s cos 2a - c sin 2a) / 2    (bent without stretch)
struct ManufactureErrors
{
  /// @throws ParameterError on a bad table.
  ManufactureErrors(const ManufactureParameters& manufacture, const GearParameters& gear);

  Eigen::VectorXd tooth_across;  ///< per flexspline tooth, counter-clockwise > 0 [m]
  Eigen::VectorXd tooth_along;   ///< per flexspline tooth, outwards > 0 [m]
  Eigen::VectorXd space_across;  ///< per space of the circular spline, counter-clockwise > 0 [m]
  Eigen::VectorXd space_along;   ///< per space, outwards > 0 [m]
};
}  // namespace hjt
