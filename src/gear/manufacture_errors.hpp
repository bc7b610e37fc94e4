// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <Eigen/Core>

#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
/// Cumulative pitch deviations of the teeth or spaces of a part (ISO 1328-1), counter-clockwise > 0 [m].
///
/// Random:  F_i = A sum_k cos(2 pi k i / Z + phase_k) / k,  k = 1 ... Z/2
/// where    i, Z     number of the tooth, number of teeth
///          A        makes the largest minus the smallest F_i equal to the total cumulative pitch deviation Fp [m]
///          phase_k  k-th number of the generator mt19937 over 2^32, times 2 pi: equal on every platform    [rad]
///
/// The amplitudes 1/k are those of a gear that is cut tooth by tooth. The kinematic error of a measured drive supports
/// these amplitudes: 6.9 arc seconds at order 2, 3.1 at order 4. Deviations from a table are not scaled.
///
/// `key`: parameter that names the table, for the error message. @throws ParameterError if the table is invalid.
Eigen::VectorXd pitchDeviations(const PitchParameters& pitch, int teeth, const std::string& key);
Eigen::VectorXd flexsplinePitch(const ManufactureParameters& manufacture, const GearParameters& gear);
Eigen::VectorXd circularSplinePitch(const ManufactureParameters& manufacture, const GearParameters& gear);

/// Errors of the positions of the flexspline's teeth and the circular spline's spaces. They are measured along and
/// across the axis that the tooth or space has in a perfect gear.
///
/// Flexspline, with a = angle of a tooth at rest: the pitch deviations, plus the effect of
/// eccentricity (x, y):  along x cos a + y sin a,    across y cos a - x sin a            (run-out of the teeth)
///
/// Circular spline, with a = angle from space 0: the pitch deviations, plus the effects of
/// eccentricity (x, y):  along x cos a + y sin a,    across y cos a - x sin a            (moved as a whole)
/// ellipticity (c, s):   along c cos 2a + s sin 2a,  across (s cos 2a - c sin 2a) / 2    (bent without stretch)
struct ManufactureErrors
{
  /// @throws ParameterError if a table is invalid.
  ManufactureErrors(const ManufactureParameters& manufacture, const GearParameters& gear);

  Eigen::VectorXd tooth_across;  ///< error of each flexspline tooth, counter-clockwise > 0 [m]
  Eigen::VectorXd tooth_along;   ///< error of each flexspline tooth, outwards > 0 [m]
  Eigen::VectorXd space_across;  ///< error of each space of the circular spline, counter-clockwise > 0 [m]
  Eigen::VectorXd space_along;   ///< error of each space of the circular spline, outwards > 0 [m]
};
}  // namespace hjt
