// SPDX-License-Identifier: BSD-3-Clause
#include "studies/small_wave.hpp"

#include <algorithm>
#include <cmath>

#include "gear/angle.hpp"
#include "solver/ring_equilibrium.hpp"
#include "statics/static_solver.hpp"

namespace hjt
{
namespace
{
/// Displacement of a tooth in its own axes at rest, and the rotation of its chord.
struct Displacement
{
  double radial;
  double tangential;
  double tilt;
};

/// Amplitudes of a theory:
///   radial      w1 cos 2psi - w2 sin^2 2psi - w0
///   tangential  -v1 sin 2psi + v2 sin 4psi
///   tilt        t1 sin 2psi + t2 sin 4psi
struct RingTheory
{
  double w0{}, w1{}, w2{}, v1{}, v2{}, t1{}, t2{};

  Displacement at(double psi) const
  {
    const double s = std::sin(2.0 * psi);
    return { w1 * std::cos(2.0 * psi) - w2 * s * s - w0, -v1 * s + v2 * std::sin(4.0 * psi),
             t1 * s + t2 * std::sin(4.0 * psi) };
  }
};

RingTheory thinRing(const Parameters& parameters, double w)
{
  RingTheory theory;
  theory.w1 = w;
  theory.v1 = 0.5 * w;
  theory.t1 = 1.5 * w / parameters.gear.flexspline_inner_radius;
  return theory;
}

RingTheory linearRing(const Parameters& parameters, double bending, double w)
{
  const double r = parameters.gear.flexspline_inner_radius;
  const double pitch = TWO_PI / parameters.gear.teeth_flexspline;
  const double half = std::tan(0.5 * pitch);
  RingTheory theory;
  // The force that bends the rim, 9 k_F p^2 w / r^2 a tooth, presses the contact in.
  theory.w1 = w * (1.0 - 9.0 * bending * pitch * pitch / (r * r * parameters.contact.stiffness));
  // Chords keep their length: tan(p/2) / tan(p) for 1/2; the hoop force of the bending moment stretches them.
  theory.v1 = 0.5 * theory.w1 * (1.0 - half * half + 3.0 * bending / (parameters.ring.tension_stiffness * r * r));
  const double c = std::cos(pitch);
  theory.t1 = (2.0 * theory.w1 * c * c - theory.v1 * std::cos(2.0 * pitch)) / r;
  return theory;
}

RingTheory secondOrderRing(const Parameters& parameters, double bending, double w)
{
  const double r = parameters.gear.flexspline_inner_radius;
  const double pitch = TWO_PI / parameters.gear.teeth_flexspline;
  RingTheory theory = linearRing(parameters, bending, w);
  // The ellipse is longer than the circle by the strain (w/2r)^2; the tension of that presses the contact in.
  const double yielding = parameters.ring.tension_stiffness * pitch * pitch / parameters.contact.stiffness;
  theory.w0 = r * yielding / (1.0 + yielding) * std::pow(0.5 * w / r, 2.0);
  theory.w2 = 0.625 * w * w / r;
  theory.v2 = 0.0625 * w * w / r;
  theory.t2 = (theory.v2 + 2.0 * theory.w2) / r;
  return theory;
}

/// As the theories have it: a bare rim on springs, neither tight nor loose.
Parameters onSprings(Parameters parameters)
{
  parameters.contact.support = SupportKind::SPRINGS;
  parameters.contact.fit = 0.0;
  parameters.contact.temperature_difference = 0.0;
  parameters.bearing.race_bending_stiffness = 0.0;
  return parameters;
}

Displacement displacement(const RingModel& model, const RingShape& shape, int i)
{
  const Eigen::Vector2d radial = model.rest.radial().segment<2>(2 * i);
  const Eigen::Vector2d across(-radial.y(), radial.x());
  const Eigen::Vector2d moved = shape.points.segment<2>(2 * i) - model.rest.points().segment<2>(2 * i);
  const Eigen::Vector2d normal = shape.chord(i).normal;
  return { radial.dot(moved), across.dot(moved), std::atan2(across.dot(normal), radial.dot(normal)) };
}

ShapeError errorOf(const RingTheory& theory, const RingModel& model, const RingShape& shape, double w)
{
  const double r = model.gear.flexspline_inner_radius;
  ShapeError error;
  for (int i = 0; i < shape.teeth(); ++i)
  {
    const Displacement is = displacement(model, shape, i);
    const Displacement expected = theory.at(i * model.rest.pitchAngle());
    error.radial = std::max(error.radial, std::abs(is.radial - expected.radial) / w);
    error.tangential = std::max(error.tangential, std::abs(is.tangential - expected.tangential) / (0.5 * w));
    error.tilt = std::max(error.tilt, std::abs(is.tilt - expected.tilt) / (1.5 * w / r));
  }
  return error;
}
}  // namespace

std::vector<SmallWaveRow> analyseSmallWave(const Parameters& given, WaveBending kind, double smallest, int count)
{
  const Parameters parameters = onSprings(given);
  RingModel model(parameters);
  model.setMeshed(false);
  RingEquilibrium ring(model, staticSolver(parameters.solver));
  const double largest = parameters.gear.wave_amplitude;
  SolveStatus status = ring.insert({ 0.0, 0.0, largest });
  std::vector<SmallWaveRow> rows;
  for (int k = 0; k < count; ++k)
  {
    const double w = count > 1 ? largest * std::pow(smallest / largest, static_cast<double>(k) / (count - 1)) : largest;
    const double bending = parameters.ring.bending_stiffness * (kind == WaveBending::PROPORTIONAL ? w / largest : 1.0);
    model.edit<RimBending>().stiffness().setConstant(bending);
    if (status.ok())
    {
      // A ring in proportion is wrong only in the second order of w.
      const Eigen::VectorXd displacements = ring.shape().points - model.rest.points();
      status =
          ring.solveFrom(model.rest.points() + w / ring.position().wave_amplitude * displacements, { 0.0, 0.0, w });
    }
    SmallWaveRow row;
    row.status = status;
    row.wave_amplitude = w;
    row.teeth_in_contact = static_cast<int>((ring.forces().of<WaveGeneratorContact>().force.array() > 0.0).count());
    row.contact_force_min = ring.forces().of<WaveGeneratorContact>().force.minCoeff();
    row.contact_force_max = ring.forces().of<WaveGeneratorContact>().force.maxCoeff();
    row.thin_ring = errorOf(thinRing(parameters, w), model, ring.shape(), w);
    row.linear = errorOf(linearRing(parameters, bending, w), model, ring.shape(), w);
    row.second_order = errorOf(secondOrderRing(parameters, bending, w), model, ring.shape(), w);
    rows.push_back(row);
  }
  return rows;
}
}  // namespace hjt
