// SPDX-License-Identifier: BSD-3-Clause
#include "harmonic_joint_twin/elements/tooth_mesh.hpp"

#include <cmath>

#include "harmonic_joint_twin/elements/contact_ramp.hpp"
#include "harmonic_joint_twin/gear/angle.hpp"

namespace hjt
{
/// A tooth in the axes of its space.
struct ToothMesh::Engagement
{
  Eigen::Vector2d radial;  // axis of the space
  Eigen::Vector2d across;  // counter-clockwise of it
  Chord chord;
  double xi;  // from where the space would be in the perfect gear
  double zeta;
  double tooth_ahead;  // by errors of manufacture: the tooth's less the space's, across [m]
  double space_out;    // by errors of manufacture: the space's, along its axis [m]
};

/// Derivatives of the tooth's energy by xi and zeta.
struct ToothMesh::Law
{
  double energy{};
  double by_xi{};
  double by_zeta{};
  double by_xi_xi{};
  double by_xi_zeta{};
  double by_zeta_zeta{};
  double cosine{};  // of the flank's angle where the tooth touches
};

ToothMesh::ToothMesh(const MeshParameters& parameters, const GearParameters& gear, const ManufactureErrors& errors)
  : spaces_(gear.teeth_circular_spline)
  , mid_height_(gear.toothMidHeight())
  , tip_offset_(0.5 * gear.tooth_height_flexspline - gear.tip_radius_circular_spline)
  , reach_(-tip_offset_ - mid_height_ + errors.space_along.minCoeff())
  , depth_(parameters.engagement_depth)
  , smoothing_(parameters.smoothing)
  , cos_flank_(std::cos(parameters.flank_angle))
  , half_space_(std::tan(PI / gear.teeth_circular_spline))
  , profile_(parameters, gear)
  , tooth_across_(errors.tooth_across)
  , stiffness_(Eigen::VectorXd::Constant(gear.teeth_flexspline, parameters.stiffness))
  , clearance_(Eigen::VectorXd::Zero(gear.teeth_flexspline))
{
  for (int k = 0; k < spaces_; ++k)
  {
    const double angle = TWO_PI * k / spaces_;
    space_.push_back({ std::cos(angle), std::sin(angle), errors.space_across[k], errors.space_along[k] });
  }
}

[[gnu::always_inline]] inline ToothMesh::Engagement ToothMesh::engage(const RingShape& shape, double cos_output,
                                                                      double sin_output, int i) const noexcept
{
  const Space& space = space_[shape.space[i]];
  const double rx = cos_output * space.axis_x - sin_output * space.axis_y;
  const double ry = sin_output * space.axis_x + cos_output * space.axis_y;
  const Chord chord = shape.chord(i);
  const double px = shape.points[2 * i] + mid_height_ * chord.normal.x();
  const double py = shape.points[2 * i + 1] + mid_height_ * chord.normal.y();
  return { { rx, ry }, { -ry, rx }, chord, py * rx - px * ry, px * rx + py * ry, tooth_across_[i] - space.across,
           space.along };
}

/// A tooth whose tip does not reach the circular spline however it is tilted.
bool ToothMesh::outOfReach(const RingShape& shape, int i) const noexcept
{
  return shape.points.segment<2>(2 * i).squaredNorm() < reach_ * reach_;
}

/// Whether the tooth touches a flank: most that reach the circular spline do not.
[[gnu::always_inline]] inline bool ToothMesh::touches(const Engagement& tooth, int i) const noexcept
{
  const double zeta = tooth.zeta - tooth.space_out;
  return !(zeta + tip_offset_ <= 0.0 ||
           std::abs(tooth.xi + tooth.tooth_ahead) <= profile_.at(zeta).value + clearance_[i]);
}

/// Of a tooth that touches.
ToothMesh::Law ToothMesh::law(const Engagement& tooth, int i) const noexcept
{
  Law law;
  const double xi = tooth.xi + tooth.tooth_ahead;
  const double zeta = tooth.zeta - tooth.space_out;
  const double depth = zeta + tip_offset_;
  const HalfClearance flank = profile_.at(zeta);
  const double clearance = flank.value + clearance_[i];
  const ContactRamp leading(xi - clearance, smoothing_);
  const ContactRamp trailing(-xi - clearance, smoothing_);
  const double energy = leading.energy + trailing.energy;
  const double force = leading.force + trailing.force;
  const double difference = leading.force - trailing.force;
  const double tangent = leading.tangent + trailing.tangent;

  double s = 1.0;
  double s1 = 0.0;
  double s2 = 0.0;
  if (depth < depth_)
  {
    const double u = depth / depth_;
    s = u * u * (3.0 - 2.0 * u);
    s1 = 6.0 * u * (1.0 - u) / depth_;
    s2 = 6.0 * (1.0 - 2.0 * u) / (depth_ * depth_);
  }
  const double k = stiffness_[i] * cos_flank_ * cos_flank_;
  const double slope = flank.slope;
  law.cosine = flank.cosine;
  law.energy = k * s * energy;
  law.by_xi = k * s * difference;
  law.by_zeta = k * (slope * s * force + s1 * energy);
  law.by_xi_xi = k * s * tangent;
  law.by_xi_zeta = k * (slope * s * (leading.tangent - trailing.tangent) + s1 * difference);
  law.by_zeta_zeta =
      k * (slope * slope * s * tangent + 2.0 * slope * s1 * force + s2 * energy + flank.curvature * s * force);
  return law;
}

void ToothMesh::addForces(const RingShape& shape, const DrivePosition& position, RingForces& forces) const noexcept
{
  const double cos_output = std::cos(position.output_angle);
  const double sin_output = std::sin(position.output_angle);
  for (int i = 0; i < shape.teeth(); ++i)
  {
    if (outOfReach(shape, i))
    {
      continue;
    }
    const Engagement tooth = engage(shape, cos_output, sin_output, i);
    if (!touches(tooth, i))
    {
      continue;
    }
    const Law at = law(tooth, i);
    const Eigen::Vector2d gradient = at.by_xi * tooth.across + at.by_zeta * tooth.radial;
    // The tooth tilts with the chord: its couple acts on the two neighbours, along the chord's normal.
    const Eigen::Vector2d& normal = tooth.chord.normal;
    const double couple = mid_height_ / tooth.chord.length * (-normal.y() * gradient.x() + normal.x() * gradient.y());
    forces.teeth.segment<2>(2 * i) -= gradient;
    forces.teeth.segment<2>(2 * shape.next(i)) += couple * normal;
    forces.teeth.segment<2>(2 * shape.previous(i)) -= couple * normal;
    forces.meshed[i] = 1;
    forces.flank_force[i] = at.by_xi / at.cosine;
    forces.output_torque += at.by_xi * tooth.zeta - at.by_zeta * tooth.xi;
    forces.energy += at.energy;
  }
}

void ToothMesh::addTangent(const RingShape& shape, const DrivePosition& position, const RingForces& forces,
                           RingTangent& tangent) const noexcept
{
  const double cos_output = std::cos(position.output_angle);
  const double sin_output = std::sin(position.output_angle);
  for (int i = 0; i < shape.teeth(); ++i)
  {
    if (!forces.meshed[i])
    {
      continue;
    }
    const Engagement tooth = engage(shape, cos_output, sin_output, i);
    const Law at = law(tooth, i);
    const Eigen::Vector2d& er = tooth.radial;
    const Eigen::Vector2d& et = tooth.across;
    const Eigen::Vector2d gradient = at.by_xi * et + at.by_zeta * er;
    const Block2 hessian = at.by_xi_xi * et * et.transpose() + at.by_zeta_zeta * er * er.transpose() +
                           at.by_xi_zeta * (et * er.transpose() + er * et.transpose());
    const Eigen::Vector2d& n = tooth.chord.normal;
    const Eigen::Vector2d q(-n.y(), n.x());  // along the chord
    const double lever = mid_height_ / tooth.chord.length;
    const double along = q.dot(gradient);
    const double outward = n.dot(gradient);

    // P = X_i + z n(Q), dn = -q (n . dQ) / |Q|, Q = X_{i+1} - X_{i-1}.
    const Eigen::Vector2d hq = hessian * q;
    const Block2 mixed = -lever * hq * n.transpose();
    const double by_turn = lever * lever * q.dot(hq) - lever / tooth.chord.length * outward;
    const Block2 chord =
        by_turn * n * n.transpose() + lever / tooth.chord.length * along * (n * q.transpose() + q * n.transpose());
    const int h = shape.previous(i);
    const int j = shape.next(i);
    tangent.addDiagonal(i, hessian);
    tangent.addDiagonal(h, chord);
    tangent.addDiagonal(j, chord);
    tangent.addPair(i, j, mixed);
    tangent.addPair(h, i, -mixed.transpose());
    tangent.addPair(h, j, -chord);

    // By the output angle: d xi = -zeta, d zeta = xi, d e_t = -e_r, d e_r = e_t.
    const double xi_rate = -at.by_xi_xi * tooth.zeta + at.by_xi_zeta * tooth.xi;
    const double zeta_rate = -at.by_xi_zeta * tooth.zeta + at.by_zeta_zeta * tooth.xi;
    const Eigen::Vector2d gradient_rate = (xi_rate + at.by_zeta) * et + (zeta_rate - at.by_xi) * er;
    const Eigen::Vector2d neighbour_rate = -lever * q.dot(gradient_rate) * n;
    tangent.output.segment<2>(2 * i) += gradient_rate;
    tangent.output.segment<2>(2 * j) += neighbour_rate;
    tangent.output.segment<2>(2 * h) -= neighbour_rate;
    tangent.output_stiffness +=
        -xi_rate * tooth.zeta + zeta_rate * tooth.xi - at.by_xi * tooth.xi - at.by_zeta * tooth.zeta;
  }
}

/// Where tooth 0 at rest lies among the spaces, plus a half for rounding, between 0 and twice their number.
double ToothMesh::firstSpace(double output_angle) const noexcept
{
  const double turns = output_angle / TWO_PI;
  const double part = turns - std::floor(turns);
  // An angle that is no number has no space; any will do, the forces will tell.
  return 0.5 + spaces_ * (part >= 0.0 && part <= 1.0 ? 1.0 - part : 0.0);
}

/// Space nearest to the angle at rest of tooth i of `teeth`.
int ToothMesh::spaceAtRest(double first, int i, int teeth) const noexcept
{
  const double spaces_a_tooth = static_cast<double>(spaces_) / teeth;
  return static_cast<int>(first + i * spaces_a_tooth) % spaces_;
}

void ToothMesh::pairAtRest(const DrivePosition& position, RingShape& shape) const noexcept
{
  const double first = firstSpace(position.output_angle);
  for (int i = 0; i < shape.teeth(); ++i)
  {
    shape.space[i] = spaceAtRest(first, i, shape.teeth());
  }
}

int ToothMesh::pairNearest(const DrivePosition& position, RingShape& shape) const noexcept
{
  int jumps = 0;
  const double cos_output = std::cos(position.output_angle);
  const double sin_output = std::sin(position.output_angle);
  const double first = firstSpace(position.output_angle);
  for (int i = 0; i < shape.teeth(); ++i)
  {
    if (outOfReach(shape, i))
    {
      // The tooth's angle at rest is near enough while it cannot touch.
      shape.space[i] = spaceAtRest(first, i, shape.teeth());
      continue;
    }
    const Engagement tooth = engage(shape, cos_output, sin_output, i);
    if (std::abs(tooth.xi) <= half_space_ * tooth.zeta || touches(tooth, i))
    {
      continue;
    }
    const int shift = static_cast<int>(std::lround(std::atan2(tooth.xi, tooth.zeta) * spaces_ / TWO_PI));
    shape.space[i] = ((shape.space[i] + shift) % spaces_ + spaces_) % spaces_;
    jumps += tooth.zeta + tip_offset_ > 0.0 && stiffness_[i] > 0.0 ? 1 : 0;
  }
  return jumps;
}

ToothPlace ToothMesh::place(const RingShape& shape, const DrivePosition& position, int i) const noexcept
{
  const Engagement tooth = engage(shape, std::cos(position.output_angle), std::sin(position.output_angle), i);
  const double xi = tooth.xi + tooth.tooth_ahead;
  const double zeta = tooth.zeta - tooth.space_out;
  return { xi, zeta + tip_offset_, std::asin(tooth.across.dot(tooth.chord.normal)),
           profile_.at(zeta).value + clearance_[i] - std::abs(xi) };
}

double ToothMesh::slidingSpeed(const RingShape& shape, const DrivePosition& position, int i,
                               const Eigen::VectorXd& speeds, double output_speed, bool leading) const noexcept
{
  const Engagement tooth = engage(shape, std::cos(position.output_angle), std::sin(position.output_angle), i);
  const Eigen::Vector2d& n = tooth.chord.normal;
  const Eigen::Vector2d chord_speed = speeds.segment<2>(2 * shape.next(i)) - speeds.segment<2>(2 * shape.previous(i));
  const double tilt = n.dot(chord_speed) / tooth.chord.length;
  const Eigen::Vector2d speed = speeds.segment<2>(2 * i) - mid_height_ * tilt * Eigen::Vector2d(-n.y(), n.x());
  const double xi_speed = tooth.across.dot(speed) - output_speed * tooth.zeta;
  const double zeta_speed = tooth.radial.dot(speed) + output_speed * tooth.xi;
  const HalfClearance flank = profile_.at(tooth.zeta - tooth.space_out);
  const double sin_flank = flank.slope * flank.cosine;
  return flank.cosine * zeta_speed + (leading ? -sin_flank : sin_flank) * xi_speed;
}
}  // namespace hjt
