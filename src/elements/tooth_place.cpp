// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "elements/tooth_mesh.hpp"

namespace hjt
{
ToothPlace ToothMesh::place(const RingShape& shape, const DrivePosition& position, int i) const noexcept
{
  const ToothEngagement tooth = engage(shape, std::cos(position.output_angle), std::sin(position.output_angle), i);
  const double xi = tooth.xi + tooth.tooth_ahead;
  const double zeta = tooth.zeta - tooth.space_out;
  return { xi, zeta + tip_offset_ - tip_loss_[i], std::asin(tooth.across.dot(tooth.chord.normal)),
           profile_.value(zeta) + clearance_[i] - std::abs(xi) };
}

double ToothMesh::slidingSpeed(const RingShape& shape, const FlankContact& contact, const Eigen::VectorXd& speeds,
                               double output_speed) const noexcept
{
  const ToothEngagement& tooth = contact.place;
  const int i = contact.tooth;
  const Eigen::Vector2d& n = tooth.chord.normal;
  const Eigen::Vector2d chord_speed = speeds.segment<2>(2 * shape.next(i)) - speeds.segment<2>(2 * shape.previous(i));
  const double tilt = n.dot(chord_speed) / tooth.chord.length;
  const Eigen::Vector2d speed = speeds.segment<2>(2 * i) - mid_height_ * tilt * Eigen::Vector2d(-n.y(), n.x());
  const double xi_speed = tooth.across.dot(speed) - output_speed * tooth.zeta;
  const double zeta_speed = tooth.radial.dot(speed) + output_speed * tooth.xi;
  const double sin_flank = contact.law.slope * contact.law.cosine;
  return contact.law.cosine * zeta_speed + (contact.law.by_xi > 0.0 ? -sin_flank : sin_flank) * xi_speed;
}
}  // namespace hjt
