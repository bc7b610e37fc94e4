// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "harmonic_joint_twin/params/parameters.hpp"
#include "harmonic_joint_twin/solver/solve_status.hpp"

namespace hjt
{
/// Largest errors of a theory of the ring on the wave generator over all teeth, relative to w, w/2 and 3 w/2r [-].
struct ShapeError
{
  double radial{};      ///< displacement along the radius at rest
  double tangential{};  ///< displacement across it
  double tilt{};        ///< rotation of the chord from the tooth before to the tooth after
};

/// The ring on a wave generator of amplitude w, circular spline left out, against three theories. psi from the major
/// axis, counter-clockwise positive:
///
///   thin_ring     inextensible, continuous, first order:  radial w cos 2psi, tangential -(w/2) sin 2psi,
///                 tilt +(3w/2r) sin 2psi
///   linear        first order for the ring as it is:      N chords for an arc, stretch and contact that yield to the
///                 bending moment
///   second_order  linear, and the terms in w^2 of the ellipse and of the perimeter that it stretches
///
/// The bending terms are those of the law `curvature`, and hold while the ring touches all round.
struct SmallWaveRow
{
  SolveStatus status;
  double wave_amplitude{};  ///< w [m]
  int teeth_in_contact{};
  double contact_force_min{};  ///< smallest on a tooth [N]
  double contact_force_max{};  ///< [N]
  ShapeError thin_ring;
  ShapeError linear;
  ShapeError second_order;
};

/// How the rim's bending stiffness goes with the wave amplitude.
enum class WaveBending
{
  KEPT,  ///< as given: what bends the rim falls with w, what presses it on the wave generator with w^2: it lifts off
  PROPORTIONAL  ///< with w: the ring touches all round at any w
};

/// `count` amplitudes in equal ratios from the gear's own down to `smallest` [m].
std::vector<SmallWaveRow> analyseSmallWave(const Parameters& parameters, WaveBending bending, double smallest,
                                           int count);
}  // namespace hjt
