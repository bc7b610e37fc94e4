// SPDX-License-Identifier: BSD-3-Clause
#include "identification/identification.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Cholesky>

#include "base/statistics.hpp"
#include "elements/motor.hpp"
#include "gear/ratio.hpp"
#include "identification/torque_fit.hpp"
#include "tracking/motion_driven.hpp"

namespace hjt
{
namespace
{
/// Keys of the parameters, in the order of TorqueRipple's lines.
constexpr std::array<const char*, TorqueRipple::LINES> RIPPLE_KEYS{ "telemetry.ripple_circular_spline_2",
                                                                    "telemetry.ripple_flexspline_2",
                                                                    "telemetry.ripple_circular_spline_4",
                                                                    "telemetry.ripple_flexspline_4" };
constexpr std::size_t MAX_RIPPLE_ROWS = 5000;  // largest number of rows in the fit; more rows are thinned out

bool isMoving(const MotionSample& sample)
{
  return std::abs(sample.velocity) > FrictionFit::MOVING;
}

/// Sums the squared error of the current over moving rows and over resting rows.
class ErrorSum
{
public:
  void add(const MotionSample& sample, double predicted)
  {
    const double square = std::pow(predicted - sample.current, 2);
    const std::size_t kind = isMoving(sample) ? 1 : 0;
    squares_[kind] += square;
    ++rows_[kind];
    signal_ += sample.current * sample.current;
  }

  CurrentError result() const
  {
    const auto rms = [](double squares, std::size_t rows)
    { return rows > 0 ? std::sqrt(squares / static_cast<double>(rows)) : 0.0; };
    const std::size_t rows = rows_[0] + rows_[1];
    return { rows,
             rows_[1],
             rms(squares_[0] + squares_[1], rows),
             rms(squares_[1], rows_[1]),
             rms(squares_[0], rows_[0]),
             rms(signal_, rows) };
  }

private:
  std::array<double, 2> squares_{};
  std::array<std::size_t, 2> rows_{};
  double signal_{};
};

Parameters withoutRipple(Parameters parameters)
{
  TelemetryParameters& p = parameters.telemetry;
  p.ripple_circular_spline_2 = p.ripple_flexspline_2 = p.ripple_circular_spline_4 = p.ripple_flexspline_4 = {};
  return parameters;
}

/// Errors of the motion-driven twin with these parameters, first without ripple, then with ripple.
std::array<CurrentError, 2> errorsOf(const Parameters& parameters, const JudgedPart& judge,
                                     const std::function<void()>& look)
{
  look();
  MotionDriven twin(withoutRipple(parameters));
  const TorqueRipple ripple(parameters.telemetry, twin.ratio());
  std::array<ErrorSum, 2> sums;
  for (const MotionSample& sample : judge.samples)
  {
    if (sample.time < judge.from)
    {
      twin.move(sample);
      continue;
    }
    const double predicted = twin.step(sample).current;
    sums[0].add(sample, predicted);
    sums[1].add(sample,
                predicted + ripple.at(sample.position, sample.velocity) / parameters.telemetry.torque_per_current);
  }
  return { sums[0].result(), sums[1].result() };
}

/// Error of the simple fit, which computes the current from load, sign of the speed and speed.
CurrentError simpleModelError(const std::vector<MotionSample>& train, const JudgedPart& judge)
{
  constexpr double STANDSTILL = 0.005;  // largest speed of a joint at rest [rad/s]
  const auto columns = [](const MotionSample& sample)
  {
    const double sign = std::abs(sample.velocity) < STANDSTILL ? 0.0 : std::copysign(1.0, sample.velocity);
    return Eigen::Vector3d(sample.load, sign, sample.velocity);
  };
  Eigen::Matrix3d normal = Eigen::Matrix3d::Identity() * 1e-9;
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (const MotionSample& sample : train)
  {
    const Eigen::Vector3d row = columns(sample);
    normal += row * row.transpose();
    right += row * sample.current;
  }
  const Eigen::Vector3d coefficients = normal.ldlt().solve(right);
  ErrorSum sum;
  for (const MotionSample& sample : judge.samples)
  {
    if (sample.time >= judge.from)
    {
      sum.add(sample, coefficients.dot(columns(sample)));
    }
  }
  return sum.result();
}

/// Stores the motor's inertia in the recorded load or, without a recorded load, the rotor's inertia; never below zero.
void storeInertia(const FrictionFit& fit, bool load_recorded, Identification& result)
{
  constexpr double LEAST = 1e-9;
  Parameters& p = result.parameters;
  const double inertia = fit.value(FrictionFit::INERTIA);
  const char* name = load_recorded ? "motor's inertia in the recorded load" : "rotor inertia";
  const char* key = load_recorded ? "telemetry.inertia_in_load" : "motor.rotor_inertia";
  double& parameter = load_recorded ? p.telemetry.inertia_in_load : p.motor.rotor_inertia;
  const double value = load_recorded ? Motor(p.motor).inertia() - inertia :
                                       inertia - p.motor.wave_generator_inertia + p.telemetry.inertia_in_load;
  IdentifiedValue found{
    name, key, "kg.m^2", parameter, value, fit.halfWidth(FrictionFit::INERTIA), fit.refusal(FrictionFit::INERTIA)
  };
  if (value < 0.0)
  {
    // If the interval lies below the configured inertia, the motion contradicts it, and the least inertia is stored.
    const bool contradicted = found.refusal.empty() && value + found.half_width < parameter && !load_recorded;
    found.value = contradicted ? LEAST : parameter;
    if (!contradicted)
    {
      found.half_width = 0.0;
      found.refusal = "its estimate is negative";
    }
  }
  parameter = found.value;
  result.values.push_back(found);
}

/// Stores the results of the friction fit as parameters of the twin, and as values with intervals.
void storeFriction(const FrictionFit& fit, bool load_recorded, Identification& result)
{
  const auto add = [&](FrictionFit::Quantity quantity, const char* name, const char* key, const char* unit,
                       double configured, double value, double half_width) {
    result.values.push_back({ name, key, unit, configured, value, half_width, fit.refusal(quantity) });
  };
  const auto found = [&](FrictionFit::Quantity quantity) { return fit.value(quantity); };
  const auto width = [&](FrictionFit::Quantity quantity) { return fit.halfWidth(quantity); };
  Parameters& p = result.parameters;

  const double gain = 1.0 / found(FrictionFit::GAIN);
  add(FrictionFit::GAIN, "gain", "telemetry.torque_per_current", "N.m/A", p.telemetry.torque_per_current, gain,
      width(FrictionFit::GAIN) * gain * gain);
  p.telemetry.torque_per_current = gain;
  add(FrictionFit::OFFSET, "offset of the current", "telemetry.current_offset", "A", p.telemetry.current_offset,
      found(FrictionFit::OFFSET), width(FrictionFit::OFFSET));
  p.telemetry.current_offset = found(FrictionFit::OFFSET);
  storeInertia(fit, load_recorded, result);
  add(FrictionFit::PRELOAD, "Coulomb friction (bearing preload)", "bearing.race_preload", "N", p.bearing.race_preload,
      found(FrictionFit::PRELOAD), width(FrictionFit::PRELOAD));
  p.bearing.race_preload = found(FrictionFit::PRELOAD);
  // The friction of the grease is proportional to the viscosity to the power of 2/3.
  const double grease = found(FrictionFit::GREASE);
  const double viscosity = p.bearing.viscosity * std::pow(grease, 1.5);
  add(FrictionFit::GREASE, "friction that rises with speed to the power 2/3 (viscosity)", "bearing.viscosity", "m^2/s",
      p.bearing.viscosity, viscosity, 1.5 * p.bearing.viscosity * std::sqrt(grease) * width(FrictionFit::GREASE));
  p.bearing.viscosity = viscosity;
  const double flanks = found(FrictionFit::FLANKS);
  add(FrictionFit::FLANKS, "load-dependent friction (flanks)", "mesh.friction_kinetic", "-", p.mesh.friction_kinetic,
      flanks * p.mesh.friction_kinetic, width(FrictionFit::FLANKS) * p.mesh.friction_kinetic);
  p.mesh.friction_kinetic *= flanks;
  p.mesh.friction_static *= flanks;
  add(FrictionFit::VISCOUS, "viscous friction", "motor.viscous_friction", "N.m.s/rad", p.motor.viscous_friction,
      found(FrictionFit::VISCOUS), width(FrictionFit::VISCOUS));
  p.motor.viscous_friction = found(FrictionFit::VISCOUS);
  add(FrictionFit::STRIBECK, "Stribeck rise at the motor", "", "N.m", p.motor.stribeck_torque,
      found(FrictionFit::STRIBECK), width(FrictionFit::STRIBECK));
}

/// Median time between two successive rows [s].
double rowPeriod(const std::vector<MotionSample>& samples)
{
  std::vector<double> steps;
  for (std::size_t i = 1; i < samples.size(); ++i)
  {
    steps.push_back(samples[i].time - samples[i - 1].time);
  }
  return upperMedian(steps.begin(), steps.end());
}

/// Differences between the recording and the motion-driven twin without ripple.
struct Lacking
{
  std::vector<double> friction;   // upper bound of the friction in each row [A]
  std::vector<double> missing;    // measured current minus the predicted one without friction, in each row [A]
  std::vector<RippleRow> moving;  // moving rows, with the measured minus the predicted torque
};

Lacking lackingOf(const Parameters& parameters, const std::vector<MotionSample>& samples)
{
  Lacking lacking;
  MotionDriven twin(withoutRipple(parameters));
  const double gain = parameters.telemetry.torque_per_current;
  for (const MotionSample& sample : samples)
  {
    const MotionPrediction prediction = twin.step(sample);
    const double current = sample.current - prediction.current;
    lacking.friction.push_back(prediction.friction_limit / gain);
    lacking.missing.push_back(current + prediction.friction_torque / gain);
    if (isMoving(sample))
    {
      lacking.moving.push_back({ sample.position, sample.velocity, gain * current });
    }
  }
  const std::size_t stride = lacking.moving.size() / MAX_RIPPLE_ROWS + 1;
  for (std::size_t i = 1; stride * i < lacking.moving.size(); ++i)
  {
    lacking.moving[i] = lacking.moving[stride * i];
  }
  lacking.moving.resize((lacking.moving.size() + stride - 1) / stride);
  return lacking;
}

/// Fits presliding angle and lasting share (of the friction, at rest) to all rows. All other values are fixed.
class PreslidingFit
{
public:
  PreslidingFit(const Parameters& parameters, const std::vector<MotionSample>& samples, Lacking lacking)
    : telemetry_(parameters.telemetry)
    , ratio_(nominalRatio(parameters.gear))
    , samples_(samples)
    , friction_(std::move(lacking.friction))
    , missing_(std::move(lacking.missing))
  {
    const TorqueRipple ripple(telemetry_, ratio_);
    for (std::size_t i = 0; i < samples.size(); ++i)
    {
      missing_[i] -= ripple.at(samples[i].position, samples[i].velocity) / telemetry_.torque_per_current;
    }
  }

  void run(Identification& result, const std::function<void()>& look)
  {
    const IdentifiedValue angle = findAngle(look);
    result.values.push_back(angle);
    result.parameters.telemetry.presliding_angle = angle.value;
    const Trial trial = fitted(Eigen::ArrayXd::Constant(1, angle.value)).front();
    const double half_width =
        NORMAL_95 * std::sqrt(trial.squares / static_cast<double>(samples_.size()) * correlation(trial) / trial.size);
    IdentifiedValue share{ "share of the friction that lasts at rest",
                           "telemetry.lasting_share",
                           "-",
                           telemetry_.lasting_share,
                           trial.share,
                           half_width,
                           "" };
    if (half_width > WIDEST_SHARE || trial.share <= 0.0)
    {
      share.value = share.configured;
      share.half_width = 0.0;
      share.refusal = trial.share <= 0.0 ? "its estimate is zero" : "the joint rests too briefly to show this share";
    }
    result.values.push_back(share);
    result.parameters.telemetry.lasting_share = share.value;
  }

private:
  static constexpr double WIDEST_SHARE = 0.25;  // largest half width of the share's interval [-]
  static constexpr double WIDEST = 0.5;         // largest half width of the angle's interval over the angle [-]

  struct Trial
  {
    double angle;
    double share;
    double squares;  // sum of the squared errors of the current [A^2]
    double size;     // sum of the squared effects of a lasting share of 1 [A^2]
  };

  /// For each row and presliding angle, gives the effect of a lasting share of 1, and the error for a share of 0 [A].
  template <class Visit>
  void walk(const Eigen::ArrayXd& angles, const Visit& visit) const
  {
    const Eigen::ArrayXd rates = -angles.inverse();
    Eigen::ArrayXd contacts = Eigen::ArrayXd::Zero(angles.size());
    double lasting = 0.0;
    for (std::size_t i = 0; i < samples_.size(); ++i)
    {
      if (i == 0 || samples_[i].after_gap)
      {
        contacts.setZero();
        lasting = 0.0;
      }
      else
      {
        // The following equations are those of Presliding::move.
        const double turn = ratio_ * (samples_[i].position - samples_[i - 1].position);
        const double end = std::copysign(1.0, turn);
        const double kept = std::exp((samples_[i - 1].time - samples_[i].time) / Presliding::RELAXATION);
        contacts = end + (kept * contacts - end) * (std::abs(turn) * rates).exp();
        lasting = mobilised(lasting, turn, Presliding::LASTING_ANGLE);
      }
      visit(i, friction_[i] * (lasting - contacts), missing_[i] - friction_[i] * contacts);
    }
  }

  /// Best lasting share at each presliding angle. This share is found directly, because the error is linear in it.
  std::vector<Trial> fitted(const Eigen::ArrayXd& angles) const
  {
    Eigen::ArrayXd columns = Eigen::ArrayXd::Zero(angles.size());
    Eigen::ArrayXd products = columns;
    Eigen::ArrayXd squares = columns;
    walk(angles,
         [&](std::size_t /*row*/, const auto& column, const auto& missing)
         {
           columns += column.square();
           products += column * missing;
           squares += missing.square();
         });
    std::vector<Trial> trials;
    for (Eigen::Index k = 0; k < angles.size(); ++k)
    {
      const double size = std::max(columns[k], 1e-12);
      const double share = std::clamp(products[k] / size, 0.0, 1.0);
      trials.push_back({ angles[k], share, squares[k] - share * (2.0 * products[k] - share * columns[k]), size });
    }
    return trials;
  }

  /// Number of correlated rows that count as one independent row, from the autocorrelation of the error.
  double correlation(const Trial& trial) const
  {
    Eigen::VectorXd error(static_cast<Eigen::Index>(samples_.size()));
    walk(Eigen::ArrayXd::Constant(1, trial.angle), [&](std::size_t row, const auto& column, const auto& missing)
         { error[static_cast<Eigen::Index>(row)] = missing[0] - trial.share * column[0]; });
    return correlationRows(error);
  }

  IdentifiedValue findAngle(const std::function<void()>& look) const
  {
    const double configured = telemetry_.presliding_angle;
    IdentifiedValue value{ "presliding angle",
                           "telemetry.presliding_angle",
                           "rad",
                           configured,
                           configured,
                           0.0,
                           "no reversal of the motion shows this angle" };
    constexpr int POINTS = 17;
    const Eigen::ArrayXd logarithms = Eigen::ArrayXd::LinSpaced(POINTS, std::log(1e-4), std::log(0.3));
    const double step = logarithms[1] - logarithms[0];
    look();
    const std::vector<Trial> trials = fitted(logarithms.exp());
    const auto best = std::min_element(trials.begin(), trials.end(),
                                       [](const Trial& a, const Trial& b) { return a.squares < b.squares; });
    if (best == trials.begin() || best == trials.end() - 1)
    {
      return value;
    }
    // Vertex of a parabola through the best trial and its two neighbours. Its abscissa is the logarithm of the angle.
    const double below = (best - 1)->squares;
    const double above = (best + 1)->squares;
    const double curvature = (above - 2.0 * best->squares + below) / (step * step);
    const double log_angle = std::log(best->angle) - 0.5 * (above - below) / step / curvature;
    const double variance = best->squares / static_cast<double>(samples_.size());
    const double half_width = NORMAL_95 * std::sqrt(2.0 * variance * correlation(*best) / curvature);
    if (half_width < WIDEST)
    {
      value.value = std::exp(log_angle);
      value.half_width = half_width * value.value;
      value.refusal.clear();
    }
    return value;
  }

  TelemetryParameters telemetry_;
  double ratio_;
  const std::vector<MotionSample>& samples_;
  std::vector<double> friction_;  // as in Lacking [A]
  std::vector<double> missing_;   // as in Lacking, minus the ripple [A]
};
}  // namespace

Identification identify(const Parameters& parameters, const std::vector<MotionSample>& train, const JudgedPart& judge,
                        bool load_recorded, const std::function<void()>& look)
{
  Identification result;
  result.parameters = parameters;
  storeFriction(FrictionFit(parameters, FrictionMap(parameters), train, look), load_recorded, result);

  Lacking lacking = lackingOf(result.parameters, train);
  const RippleFit ripple(std::move(lacking.moving), rowPeriod(train), parameters.telemetry,
                         nominalRatio(parameters.gear), look);
  ripple.store(result.parameters.telemetry);
  for (std::size_t i = 0; i < TorqueRipple::LINES; ++i)
  {
    result.lines.push_back({ RIPPLE_KEYS[i], ripple.line(i), ripple.orders()[i], ripple.amplitude(i),
                             ripple.halfWidth(i), ripple.phase(i), ripple.refusal(i) });
  }
  PreslidingFit(result.parameters, train, std::move(lacking)).run(result, look);
  const bool is_warmed = std::any_of(train.begin(), train.end(),
                                     [](const MotionSample& sample) { return std::isfinite(sample.temperature); });
  result.values.push_back(
      { "change of friction with temperature", "bearing.viscosity_slope", "-", parameters.bearing.viscosity_slope,
        parameters.bearing.viscosity_slope, 0.0,
        is_warmed ? "not identified; the configured value is used" : "the recording has no temperature" });
  result.values.push_back({ "torsional stiffness", "cup.torsion_stiffness", "N.m/rad",
                            parameters.cup.torsion_stiffness[0], parameters.cup.torsion_stiffness[0], 0.0,
                            "not identified; `joint_twin compare` measures it if both angles are recorded" });

  result.judged.configured = errorsOf(parameters, judge, look)[1];
  const std::array<CurrentError, 2> errors = errorsOf(result.parameters, judge, look);
  result.judged.without_ripple = errors[0];
  result.judged.identified = errors[1];
  result.judged.gain_coulomb_viscous = simpleModelError(train, judge);
  return result;
}

namespace
{
/// Adds the error of a part to the sum over the parts before it, as root mean squares over all rows.
void addError(const CurrentError& part, CurrentError& sum)
{
  const auto rms = [](double a, std::size_t n, double b, std::size_t m)
  {
    return n + m > 0 ? std::sqrt((a * a * static_cast<double>(n) + b * b * static_cast<double>(m)) /
                                 static_cast<double>(n + m)) :
                       0.0;
  };
  sum.moving = rms(sum.moving, sum.moving_rows, part.moving, part.moving_rows);
  sum.resting = rms(sum.resting, sum.rows - sum.moving_rows, part.resting, part.rows - part.moving_rows);
  sum.all = rms(sum.all, sum.rows, part.all, part.rows);
  sum.signal = rms(sum.signal, sum.rows, part.signal, part.rows);
  sum.rows += part.rows;
  sum.moving_rows += part.moving_rows;
}

/// Times that divide the motion into pieces of equal travel. In pieces of equal time, the joint could be at rest,
/// because the joints of a check-up move one after the other.
std::vector<double> endsOfPieces(const std::vector<MotionSample>& samples, const Span& train, int pieces)
{
  std::vector<double> ways(1, 0.0);  // travel up to each sample after the first [rad]
  for (std::size_t i = 1; i < samples.size(); ++i)
  {
    ways.push_back(ways.back() + std::abs(samples[i].position - samples[i - 1].position));
  }
  std::vector<double> ends(1, train.from);
  for (int piece = 1; piece < pieces; ++piece)
  {
    const auto end = std::lower_bound(ways.begin(), ways.end(), ways.back() * piece / pieces);
    ends.push_back(samples[static_cast<std::size_t>(end - ways.begin())].time);
  }
  ends.push_back(train.to);
  return ends;
}
}  // namespace

std::vector<MotionSample> samplesWithin(const std::vector<MotionSample>& all, const Span& span, const Span& hole)
{
  std::vector<MotionSample> samples;
  bool gap = true;
  for (const MotionSample& sample : all)
  {
    if (!span.contains(sample.time) || hole.contains(sample.time))
    {
      gap = true;
      continue;
    }
    samples.push_back(sample);
    samples.back().after_gap |= gap;
    gap = false;
  }
  return samples;
}

JudgedErrors leaveOneOut(const Parameters& parameters, const std::vector<MotionSample>& all, const Span& train,
                         int folds, bool load_recorded, const std::function<void()>& fitted,
                         const std::function<void()>& look)
{
  JudgedErrors sum;
  const std::vector<double> ends = endsOfPieces(samplesWithin(all, train), train, folds);
  for (std::size_t fold = 0; fold < static_cast<std::size_t>(folds); ++fold)
  {
    const Span hole{ ends[fold], ends[fold + 1] };
    const JudgedPart left_out{ samplesWithin(all, { train.from, hole.to }), hole.from };
    const JudgedErrors judged =
        identify(parameters, samplesWithin(all, train, hole), left_out, load_recorded, look).judged;
    addError(judged.configured, sum.configured);
    addError(judged.without_ripple, sum.without_ripple);
    addError(judged.identified, sum.identified);
    addError(judged.gain_coulomb_viscous, sum.gain_coulomb_viscous);
    fitted();
  }
  return sum;
}
}  // namespace hjt
