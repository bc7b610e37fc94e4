// SPDX-License-Identifier: BSD-3-Clause
#include "elements/tooth_mesh.hpp"

#include <cmath>

#include "elements/contact_laws.hpp"
#include "gear/angle.hpp"
#include "gear/vector_loops.hpp"

namespace hjt
{
namespace
{
constexpr double OUTSIDE = -1.0;  // replaces the depth in a flank if the tip is outside the circular spline [m]

/// Position of a tooth across and along the axis of its space, as in ToothEngagement [m].
struct ToothPose
{
  double xi;
  double zeta;
};

/// Position of tooth i at mid-height. `h`, `j`: teeth before and after i; `axis_x`, `axis_y`: axis of the space.
inline ToothPose poseOf(const double* point, double mid_height, int h, int i, int j, double axis_x,
                        double axis_y) noexcept
{
  const double dx = point[2 * j] - point[2 * h];
  const double dy = point[2 * j + 1] - point[2 * h + 1];
  const double lever = mid_height / std::sqrt(dx * dx + dy * dy);
  const double px = point[2 * i] + lever * dy;
  const double py = point[2 * i + 1] - lever * dx;
  return { py * axis_x - px * axis_y, px * axis_x + py * axis_y };
}
}  // namespace

ToothMesh::Scratch::Scratch(int teeth)
  : flank_force(Eigen::VectorXd::Zero(teeth))
  , meshed(static_cast<std::size_t>(teeth))
  , flanks(teeth)
  , pressed(teeth)
  , along(teeth)
{
}

ToothMesh::ToothMesh(const Parameters& parameters, const ToothRing& /*rest*/)
  : ToothMesh(parameters.mesh, parameters.gear, ManufactureErrors(parameters.manufacture, parameters.gear))
{
}

ToothMesh::ToothMesh(const MeshParameters& parameters, const GearParameters& gear, const ManufactureErrors& errors)
  : spaces_(gear.teeth_circular_spline)
  , mid_height_(gear.toothMidHeight())
  , tip_offset_(0.5 * gear.tooth_height_flexspline - gear.tip_radius_circular_spline)
  , reach_(-tip_offset_ - mid_height_ + errors.space_along.minCoeff() - errors.tooth_along.maxCoeff())
  , depth_(parameters.engagement_depth)
  , smoothing_(parameters.smoothing)
  , cos_flank_(std::cos(parameters.flank_angle))
  , half_space_(std::tan(PI / gear.teeth_circular_spline))
  , profile_(parameters, gear)
  , tooth_across_(errors.tooth_across)
  , tooth_along_(errors.tooth_along)
  , stiffness_(Eigen::VectorXd::Constant(gear.teeth_flexspline, parameters.stiffness))
  , clearance_(Eigen::VectorXd::Zero(gear.teeth_flexspline))
  , tip_loss_(Eigen::VectorXd::Zero(gear.teeth_flexspline))
{
  for (int k = 0; k < spaces_; ++k)
  {
    const double angle = TWO_PI * k / spaces_;
    space_.push_back({ std::cos(angle), std::sin(angle), errors.space_across[k], errors.space_along[k] });
  }
}

void ToothMesh::moveSpaces(double distance) noexcept
{
  for (Space& space : space_)
  {
    space.across -= distance * space.axis_y;
    space.along += distance * space.axis_x;
  }
  reach_ -= std::abs(distance);
}

ToothEngagement ToothMesh::engage(const RingShape& shape, double cos_output, double sin_output, int i) const noexcept
{
  const Space& space = space_[static_cast<std::size_t>(shape.space[i])];
  const double rx = cos_output * space.axis_x - sin_output * space.axis_y;
  const double ry = sin_output * space.axis_x + cos_output * space.axis_y;
  const Chord chord = shape.chord(i);
  const double px = shape.points[2 * i] + mid_height_ * chord.normal.x();
  const double py = shape.points[2 * i + 1] + mid_height_ * chord.normal.y();
  return { { rx, ry },
           { -ry, rx },
           chord,
           py * rx - px * ry,
           px * rx + py * ry,
           tooth_across_[i] - space.across,
           space.along - tooth_along_[i] };
}

/// Energy of a tooth that touches a flank, and its derivatives.
FlankLaw ToothMesh::law(const ToothEngagement& tooth, int i) const noexcept
{
  const double xi = tooth.xi + tooth.tooth_ahead;
  const double zeta = tooth.zeta - tooth.space_out;
  const double depth = zeta + tip_offset_ - tip_loss_[i];
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
  FlankLaw law;
  law.energy = k * s * energy;
  law.by_xi = k * s * difference;
  law.by_zeta = k * (slope * s * force + s1 * energy);
  law.by_xi_xi = k * s * tangent;
  law.by_xi_zeta = k * (slope * s * (leading.tangent - trailing.tangent) + s1 * difference);
  law.by_zeta_zeta =
      k * (slope * slope * s * tangent + 2.0 * slope * s1 * force + s2 * energy + flank.curvature * s * force);
  law.slope = slope;
  law.cosine = flank.cosine;
  return law;
}

/// Computes the depth of every tooth in the nearer flank. Only teeth in contact need energy and derivatives.
HJT_VECTOR_CLONES void ToothMesh::findPressed(const RingShape& shape, double cos_output, double sin_output,
                                              Scratch& scratch) const noexcept
{
  const int n = shape.solved;
  double* __restrict__ depth = scratch.pressed.data();
  double* __restrict__ along = scratch.along.data();
  const double* __restrict__ point = shape.points.data();
  const int* __restrict__ space = shape.space.data();
  const Space* __restrict__ spaces = space_.data();
  const double* __restrict__ ahead = tooth_across_.data();
  const double* __restrict__ out = tooth_along_.data();
  const double* __restrict__ clearance = clearance_.data();
  const double mid_height = mid_height_;
  const auto find = [&](int h, int i, int j)
  {
    const Space& own = spaces[space[i]];
    const double rx = cos_output * own.axis_x - sin_output * own.axis_y;
    const double ry = sin_output * own.axis_x + cos_output * own.axis_y;
    const ToothPose stand = poseOf(point, mid_height, h, i, j, rx, ry);
    along[i] = stand.zeta + out[i] - own.along;
    depth[i] = std::abs(stand.xi + ahead[i] - own.across) - clearance[i];
  };
  find(shape.previous(0), 0, 1);
#pragma omp simd
  for (int i = 1; i < n - 1; ++i)
  {
    find(i - 1, i, i + 1);
  }
  find(n - 2, n - 1, shape.next(n - 1));
  const double* __restrict__ lost = tip_loss_.data();
  const double tip_offset = tip_offset_;
  const ToothProfile& profile = profile_;
  if (profile.straight())
  {
#pragma omp simd
    for (int i = 0; i < n; ++i)
    {
      depth[i] = along[i] + tip_offset > lost[i] ? depth[i] - profile.straightAt(along[i]) : OUTSIDE;
    }
    return;
  }
  for (int i = 0; i < n; ++i)
  {
    depth[i] = along[i] + tip_offset > lost[i] ? depth[i] - profile.value(along[i]) : OUTSIDE;
  }
}

/// Depth of a tooth in the nearer flank, measured across the axis of the space [m].
double ToothMesh::pressedBy(const ToothEngagement& tooth, int i) const noexcept
{
  const double zeta = tooth.zeta - tooth.space_out;
  return zeta + tip_offset_ > tip_loss_[i] ?
             std::abs(tooth.xi + tooth.tooth_ahead) - profile_.value(zeta) - clearance_[i] :
             OUTSIDE;
}

bool ToothMesh::repeats() const noexcept
{
  const std::size_t half = space_.size() / 2;
  for (std::size_t k = 0; k < half; ++k)
  {
    if (space_[k].across != space_[k + half].across || space_[k].along != space_[k + half].along)
    {
      return false;
    }
  }
  return space_.size() == 2 * half && halvesAgree(tooth_across_) && halvesAgree(tooth_along_) &&
         halvesAgree(stiffness_) && halvesAgree(clearance_) && halvesAgree(tip_loss_);
}

void ToothMesh::addForces(const RingShape& shape, const DrivePosition& position, Scratch& scratch,
                          ForceSum& sum) const noexcept
{
  const double cos_output = std::cos(position.output_angle);
  const double sin_output = std::sin(position.output_angle);
  findPressed(shape, cos_output, sin_output, scratch);
  for (int i = 0; i < shape.solved; ++i)
  {
    if (!(scratch.pressed[i] > 0.0))
    {
      continue;
    }
    FlankContact& contact = scratch.flanks.add();
    contact.tooth = i;
    contact.place = engage(shape, cos_output, sin_output, i);
    contact.law = law(contact.place, i);
    const ToothEngagement& tooth = contact.place;
    const FlankLaw& at = contact.law;
    const Eigen::Vector2d gradient = at.by_xi * tooth.across + at.by_zeta * tooth.radial;
    // The tooth tilts with its chord. Therefore its couple acts on the neighbours, along the chord's normal.
    const Eigen::Vector2d& normal = tooth.chord.normal;
    const double couple = mid_height_ / tooth.chord.length * (-normal.y() * gradient.x() + normal.x() * gradient.y());
    sum.teeth.segment<2>(2 * i) -= gradient;
    sum.teeth.segment<2>(2 * shape.next(i)) += couple * normal;
    sum.teeth.segment<2>(2 * shape.previous(i)) -= couple * normal;
    scratch.meshed[static_cast<std::size_t>(i)] = 1;
    scratch.flank_force[i] = at.by_xi / at.cosine;
    sum.output_torque += at.by_xi * tooth.zeta - at.by_zeta * tooth.xi;
    sum.energy += at.energy;
  }
}

void ToothMesh::addTangent(const RingShape& shape, const Scratch& scratch, RingTangent& tangent) const noexcept
{
  for (const FlankContact& contact : scratch.flanks)
  {
    const ToothEngagement& tooth = contact.place;
    const FlankLaw& at = contact.law;
    const Eigen::Vector2d& er = tooth.radial;
    const Eigen::Vector2d& et = tooth.across;
    const Eigen::Vector2d gradient = at.by_xi * et + at.by_zeta * er;
    const Block2 hessian = at.by_xi_xi * et * et.transpose() + at.by_zeta_zeta * er * er.transpose() +
                           at.by_xi_zeta * (et * er.transpose() + er * et.transpose());
    const Eigen::Vector2d& n = tooth.chord.normal;
    const Eigen::Vector2d q(-n.y(), n.x());  // direction of the chord
    const double lever = mid_height_ / tooth.chord.length;
    const double along = q.dot(gradient);
    const double outward = n.dot(gradient);

    // P = X_i + z_t n(Q), dn = -q (n . dQ) / |Q|, Q = X_{i+1} - X_{i-1}; for P, X_i, z_t see ToothMesh.
    const Eigen::Vector2d hq = hessian * q;
    const Block2 mixed = -lever * hq * n.transpose();
    const double by_turn = lever * lever * q.dot(hq) - lever / tooth.chord.length * outward;
    const Block2 chord =
        by_turn * n * n.transpose() + lever / tooth.chord.length * along * (n * q.transpose() + q * n.transpose());
    const int i = contact.tooth;
    const int h = shape.previous(i);
    const int j = shape.next(i);
    tangent.addDiagonal(i, hessian);
    tangent.addDiagonal(h, chord);
    tangent.addDiagonal(j, chord);
    tangent.addPair(i, j, mixed);
    tangent.addPair(h, i, -mixed.transpose());
    tangent.addPair(h, j, -chord);

    // The derivative by the output angle is -zeta for xi, xi for zeta, -er for et, and et for er.
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

/// Position of tooth 0 at rest in units of spaces, from 0 to the number of spaces, plus one half for rounding.
double ToothMesh::firstSpace(double output_angle) const noexcept
{
  const double turns = output_angle / TWO_PI;
  const double part = turns - std::floor(turns);
  // For an angle that is NaN any space is right, because the forces become NaN too.
  return 0.5 + spaces_ * (part >= 0.0 && part <= 1.0 ? 1.0 - part : 0.0);
}

void ToothMesh::pairAtRest(const DrivePosition& position, RingShape& shape) const noexcept
{
  const double first = firstSpace(position.output_angle);
  const double spaces_a_tooth = static_cast<double>(spaces_) / shape.teeth();
  for (int i = 0; i < shape.teeth(); ++i)
  {
    shape.space[static_cast<std::size_t>(i)] = static_cast<int>(first + i * spaces_a_tooth) % spaces_;
  }
}

/// Assigns the space nearest to the angle at rest to every tooth whose tip cannot reach the circular spline at any
/// tilt. @returns the number of other teeth that are outside their space.
HJT_VECTOR_CLONES double ToothMesh::pairOutOfReach(const DrivePosition& position, RingShape& shape) const noexcept
{
  const double cos_output = std::cos(position.output_angle);
  const double sin_output = std::sin(position.output_angle);
  const int n = shape.solved;
  const int spaces = spaces_;
  const double first = firstSpace(position.output_angle);
  const double spaces_a_tooth = static_cast<double>(spaces) / shape.teeth();
  const double mid_height = mid_height_;
  const double reach = reach_ * reach_;
  const double half_space = half_space_;
  const double* __restrict__ point = shape.points.data();
  const Space* __restrict__ axes = space_.data();
  int* __restrict__ space = shape.space.data();
  const auto outside = [&](int h, int i, int j)
  {
    const Space& own = axes[space[i]];
    const double rx = cos_output * own.axis_x - sin_output * own.axis_y;
    const double ry = sin_output * own.axis_x + cos_output * own.axis_y;
    const ToothPose stand = poseOf(point, mid_height, h, i, j, rx, ry);
    const bool reaches = !(point[2 * i] * point[2 * i] + point[2 * i + 1] * point[2 * i + 1] < reach);
    int rest = static_cast<int>(first + i * spaces_a_tooth);  // space at rest, less than 3 * spaces
    rest -= rest >= spaces ? spaces : 0;
    rest -= rest >= spaces ? spaces : 0;
    space[i] = reaches ? space[i] : rest;
    return reaches && !(std::abs(stand.xi) <= half_space * stand.zeta) ? 1.0 : 0.0;
  };
  double sum = outside(shape.previous(0), 0, 1) + outside(n - 2, n - 1, shape.next(n - 1));
#pragma omp simd reduction(+ : sum)
  for (int i = 1; i < n - 1; ++i)
  {
    sum += outside(i - 1, i, i + 1);
  }
  return sum;
}

int ToothMesh::pairNearest(const DrivePosition& position, RingShape& shape) const noexcept
{
  int jumps = 0;
  if (pairOutOfReach(position, shape) != 0.0)
  {
    jumps = pairInReach(position, shape);
  }
  shape.repeatSpaces(spaces_);
  return jumps * shape.copies();
}

/// Assigns the nearest space to every tooth that touches no flank and is outside its space. @returns the number of
/// solved teeth that passed over a tip of the circular spline.
int ToothMesh::pairInReach(const DrivePosition& position, RingShape& shape) const noexcept
{
  int jumps = 0;
  const double cos_output = std::cos(position.output_angle);
  const double sin_output = std::sin(position.output_angle);
  for (int i = 0; i < shape.solved; ++i)
  {
    const ToothEngagement tooth = engage(shape, cos_output, sin_output, i);
    if (shape.points.segment<2>(2 * i).squaredNorm() < reach_ * reach_ ||
        std::abs(tooth.xi) <= half_space_ * tooth.zeta || pressedBy(tooth, i) > 0.0)
    {
      continue;
    }
    const int shift = static_cast<int>(std::lround(std::atan2(tooth.xi, tooth.zeta) * spaces_ / TWO_PI));
    int& space = shape.space[static_cast<std::size_t>(i)];
    space = ((space + shift) % spaces_ + spaces_) % spaces_;
    jumps += tooth.zeta + tip_offset_ > tip_loss_[i] && stiffness_[i] > 0.0 ? 1 : 0;
  }
  return jumps;
}

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
