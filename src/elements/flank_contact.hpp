// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "gear/ring_shape.hpp"

namespace hjt
{
/// A tooth in the axes of its space.
struct ToothEngagement
{
  Eigen::Vector2d radial;  ///< axis of the space [-]
  Eigen::Vector2d across;  ///< counter-clockwise of it [-]
  Chord chord;
  double xi;           ///< across, from where the space would be in the perfect gear [m]
  double zeta;         ///< along the axis [m]
  double tooth_ahead;  ///< by errors of manufacture: the tooth's less the space's, across [m]
  double space_out;    ///< by errors of manufacture: the space's less the tooth's, along its axis [m]
};

/// Derivatives of a tooth's energy by xi and zeta.
struct FlankLaw
{
  double energy;        ///< [J]
  double by_xi;         ///< [N]
  double by_zeta;       ///< [N]
  double by_xi_xi;      ///< [N/m]
  double by_xi_zeta;    ///< [N/m]
  double by_zeta_zeta;  ///< [N/m]
  double slope;         ///< tangent of the flank's angle where the tooth touches [-]
  double cosine;        ///< of that angle [-]
};

/// A tooth that touches a flank, with all that its force, its tangent and its friction follow from.
struct FlankContact
{
  int tooth;
  ToothEngagement place;
  FlankLaw law;
};

/// The teeth that touch a flank, in the order of the teeth. Room for all of them from the start.
class FlankContacts
{
public:
  explicit FlankContacts(int teeth) : contacts_(static_cast<std::size_t>(teeth)) {}

  void clear() noexcept { count_ = 0; }
  FlankContact& add() noexcept { return contacts_[count_++]; }  ///< at most once a tooth

  const FlankContact* begin() const noexcept { return contacts_.data(); }
  const FlankContact* end() const noexcept { return contacts_.data() + count_; }

private:
  std::vector<FlankContact> contacts_;
  std::size_t count_{};
};
}  // namespace hjt
