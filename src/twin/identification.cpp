// SPDX-License-Identifier: BSD-3-Clause
#include "harmonic_joint_twin/twin/identification.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <optional>

#include <ceres/ceres.h>
#include <Eigen/Cholesky>
#include <Eigen/QR>

#include "harmonic_joint_twin/elements/motor.hpp"
#include "harmonic_joint_twin/gear/angle.hpp"
#include "harmonic_joint_twin/gear/ratio.hpp"
#include "harmonic_joint_twin/params/number_text.hpp"
#include "harmonic_joint_twin/params/parameter_error.hpp"
#include "harmonic_joint_twin/twin/motion_driven.hpp"

namespace hjt
{
namespace
{
constexpr double MOVING = 0.01;              // joint speed from which a row counts as moving [rad/s]
constexpr double WIDEST = 0.5;               // half width of an interval over its value
constexpr double SMALLEST_TOLERANCE = 1e-3;  // share of a column's square that the others do not explain
constexpr double NORMAL_95 = 1.96;           // half width of the 95 % interval of a normal distribution
constexpr std::size_t MOST_ROWS = 20000;     // in one fit; a longer recording is thinned out
constexpr std::size_t FEWEST_ROWS = 100;     // that move
constexpr double STRIBECK_SPEED = 5.0;       // of the motor, where the static rise has faded [rad/s]

/// Quantities in the order of their columns.
enum Quantity
{
  GAIN,
  OFFSET,
  INERTIA,
  PRELOAD,
  GREASE,
  FLANKS,
  VISCOUS,
  STRIBECK,
  QUANTITIES
};

constexpr std::size_t LINES = 7;
constexpr std::size_t FIRST_COGGING_LINE = 5;
constexpr std::size_t LOOP = QUANTITIES + 2 * LINES;  // frequency, damping, lag
constexpr std::size_t PARAMETERS = LOOP + 3;
using Values = std::array<double, PARAMETERS>;

/// Two waves a turn that sit on the circular spline or on the flexspline, the same doubled, and the motor's cogging.
std::array<double, LINES> lineOrders(double ratio)
{
  return { 2.0 * (ratio - 1.0), 2.0 * ratio, 4.0 * (ratio - 1.0), 4.0 * ratio, ratio, 12.0 * ratio, 24.0 * ratio };
}

/// One row of the regression.
struct Row
{
  double current;
  double known;                           // torque at the joint that nothing is asked of [N.m]
  std::array<double, QUANTITIES> column;  // torque at the joint by each quantity; gain and offset unused
  double position;
  double velocity;
  bool moving;
};

/// What a harmonic disturbance torque of angular frequency `w` makes the current: closed speed loop of second order.
template <class T>
void loopResponse(double w, const T& frequency, const T& damping, const T& lag, T& real, T& imaginary)
{
  using std::cos;
  using std::sin;
  const T natural = TWO_PI * frequency;
  const T a = natural * natural;
  const T b = 2.0 * damping * natural * w;
  const T c = a - w * w;
  const T size = c * c + b * b + 1e-12;
  const T re = (a * c + b * b) / size;
  const T im = (b * c - a * b) / size;
  const T turn = w * lag;
  real = re * cos(turn) - im * sin(turn);
  imaginary = re * sin(turn) + im * cos(turn);
}

template <class T>
T predictedCurrent(const Row& row, const std::array<double, LINES>& orders, const std::array<bool, LINES>& present,
                   const std::array<T, PARAMETERS>& values)
{
  T torque = T(row.known);
  for (std::size_t i = INERTIA; i < QUANTITIES; ++i)
  {
    torque += values[i] * row.column[i];
  }
  for (std::size_t i = 0; i < LINES; ++i)
  {
    if (present[i])
    {
      T real;
      T imaginary;
      loopResponse(orders[i] * row.velocity, values[LOOP], values[LOOP + 1], values[LOOP + 2], real, imaginary);
      const double c = std::cos(orders[i] * row.position);
      const double s = std::sin(orders[i] * row.position);
      torque += values[QUANTITIES + 2 * i] * (real * c - imaginary * s) +
                values[QUANTITIES + 2 * i + 1] * (real * s + imaginary * c);
    }
  }
  return values[GAIN] * torque + values[OFFSET];  // GAIN holds its inverse, [A/(N.m)]
}

/// Residual of one row by the values that are being fitted.
class RowResidual
{
public:
  RowResidual(const Row& row, const std::array<double, LINES>& orders, const std::array<bool, LINES>& present,
              const Values& start, const std::vector<std::size_t>& active)
    : row_(row), orders_(orders), present_(present), start_(start), active_(active)
  {
  }

  template <class T>
  bool operator()(T const* const* parameters, T* residual) const
  {
    std::array<T, PARAMETERS> values;
    for (std::size_t i = 0; i < PARAMETERS; ++i)
    {
      values[i] = T(start_[i]);
    }
    for (std::size_t i = 0; i < active_.size(); ++i)
    {
      values[active_[i]] = parameters[0][i];
    }
    residual[0] = predictedCurrent(row_, orders_, present_, values) - row_.current;
    return true;
  }

private:
  const Row& row_;
  const std::array<double, LINES>& orders_;
  const std::array<bool, LINES>& present_;
  const Values& start_;
  const std::vector<std::size_t>& active_;
};

/// Rows of the regression from samples; friction from the twin's own table.
std::vector<Row> makeRows(const Parameters& parameters, const FrictionMap& friction,
                          const std::vector<MotionSample>& samples)
{
  const double ratio = nominalRatio(parameters.gear);
  const double preload_torque = parameters.bearing.load_factor * parameters.bearing.pitch_diameter;  // [N.m/N]
  Presliding presliding(parameters.telemetry.presliding_angle);
  std::vector<Row> rows;
  rows.reserve(samples.size());
  MotionSample last = samples.empty() ? MotionSample() : samples.front();
  for (const MotionSample& sample : samples)
  {
    if (sample.after_gap)
    {
      presliding.reset();
      last = sample;
    }
    const double share = presliding.move(ratio * (sample.position - last.position), sample.time - last.time);
    last = sample;
    const double motor_speed = ratio * sample.velocity;
    const FrictionShares shares = friction.at(motor_speed, sample.load, parameters.input.temperature);
    Row row{};
    row.current = sample.current;
    row.known = sample.load + ratio * share * shares.rest;
    row.column[INERTIA] = ratio * ratio * sample.acceleration;
    row.column[PRELOAD] = ratio * share * preload_torque;
    row.column[GREASE] = ratio * share * shares.grease;
    row.column[FLANKS] = ratio * share * shares.flanks;
    row.column[VISCOUS] = ratio * share * std::abs(motor_speed);
    row.column[STRIBECK] = ratio * share * std::exp(-std::pow(motor_speed / STRIBECK_SPEED, 2));
    row.position = sample.position;
    row.velocity = sample.velocity;
    row.moving = std::abs(sample.velocity) > MOVING;
    rows.push_back(row);
  }
  return rows;
}

/// The fit of the quantities that are still asked for, and what it says about itself.
class Fit
{
public:
  Fit(const Parameters& parameters, std::vector<Row> rows)
    : orders_(lineOrders(nominalRatio(parameters.gear))), rows_(std::move(rows))
  {
    values_[GAIN] = 1.0 / parameters.telemetry.torque_per_current;
    values_[OFFSET] = parameters.telemetry.current_offset;
    values_[INERTIA] = Motor(parameters.motor).inertia() - parameters.telemetry.inertia_in_load;
    values_[PRELOAD] = parameters.bearing.race_preload;
    values_[GREASE] = 1.0;
    values_[FLANKS] = 1.0;
    values_[VISCOUS] = parameters.motor.viscous_friction;
    values_[LOOP] = 20.0;     // [Hz]
    values_[LOOP + 1] = 0.5;  // [-]
    asked_.fill(true);
    present_.fill(true);
    start_ = values_;
  }

  /// Fits what is asked; refuses one quantity after the other until the rest is sound.
  void run()
  {
    chooseLoop();
    do
    {
      solve();
      judge();
    } while (refuseWorst());
  }

  const Values& values() const { return values_; }
  const std::array<double, LINES>& orders() const { return orders_; }
  const std::array<bool, LINES>& present() const { return present_; }
  double halfWidth(std::size_t parameter) const { return half_width_[parameter]; }
  const std::string& refusal(std::size_t parameter) const { return refusal_[parameter]; }
  double correlationRows() const { return correlation_rows_; }

private:
  std::vector<std::size_t> active() const
  {
    std::vector<std::size_t> list;
    for (std::size_t i = 0; i < QUANTITIES; ++i)
    {
      if (asked_[i])
      {
        list.push_back(i);
      }
    }
    bool any = false;
    for (std::size_t i = 0; i < LINES; ++i)
    {
      if (present_[i])
      {
        list.push_back(QUANTITIES + 2 * i);
        list.push_back(QUANTITIES + 2 * i + 1);
        any = true;
      }
    }
    if (any)
    {
      list.insert(list.end(), { LOOP, LOOP + 1, LOOP + 2 });
    }
    return list;
  }

  double squares(const Values& values) const
  {
    double sum = 0.0;
    for (const Row& row : rows_)
    {
      sum += std::pow(predictedCurrent(row, orders_, present_, values) - row.current, 2);
    }
    return sum;
  }

  /// The loop's start: the best of a coarse grid, everything linear fitted to each.
  void chooseLoop()
  {
    std::optional<Values> best;
    double least = 0.0;
    for (const double frequency : { 8.0, 20.0, 50.0 })
    {
      for (const double damping : { 0.2, 0.6 })
      {
        for (const double lag : { -0.006, -0.003, 0.0, 0.003, 0.006 })
        {
          values_[LOOP] = frequency;
          values_[LOOP + 1] = damping;
          values_[LOOP + 2] = lag;
          const Values trial = linearFit();
          const double sum = squares(trial);
          if (!best || sum < least)
          {
            best = trial;
            least = sum;
          }
        }
      }
    }
    values_ = *best;
  }

  /// Lines and a constant Coulomb torque fitted by one linear solve at the present loop, as a start only.
  Values linearFit() const
  {
    constexpr int COLUMNS = 2 * LINES + 3;
    Eigen::Matrix<double, COLUMNS, COLUMNS> normal = Eigen::Matrix<double, COLUMNS, COLUMNS>::Identity() * 1e-9;
    Eigen::Matrix<double, COLUMNS, 1> right = Eigen::Matrix<double, COLUMNS, 1>::Zero();
    Values values = values_;
    for (std::size_t i = 0; i < 2 * LINES; ++i)
    {
      values[QUANTITIES + i] = 0.0;
    }
    for (const Row& row : rows_)
    {
      Eigen::Matrix<double, COLUMNS, 1> columns;
      for (std::size_t i = 0; i < LINES; ++i)
      {
        double real{};
        double imaginary{};
        loopResponse(orders_[i] * row.velocity, values[LOOP], values[LOOP + 1], values[LOOP + 2], real, imaginary);
        const double c = std::cos(orders_[i] * row.position);
        const double s = std::sin(orders_[i] * row.position);
        columns[2 * static_cast<int>(i)] = values[GAIN] * (real * c - imaginary * s);
        columns[2 * static_cast<int>(i) + 1] = values[GAIN] * (real * s + imaginary * c);
      }
      columns[COLUMNS - 3] = values[GAIN] * row.column[PRELOAD];
      columns[COLUMNS - 2] = values[GAIN] * row.column[GREASE];
      columns[COLUMNS - 1] = row.known;
      const double residual = row.current - predictedCurrent(row, orders_, present_, values);
      normal += columns * columns.transpose();
      right += columns * residual;
    }
    const Eigen::Matrix<double, COLUMNS, 1> step = normal.ldlt().solve(right);
    for (std::size_t i = 0; i < 2 * LINES; ++i)
    {
      values[QUANTITIES + i] = step[static_cast<int>(i)];
    }
    values[PRELOAD] += step[COLUMNS - 3];
    values[GREASE] += step[COLUMNS - 2];
    values[GAIN] += step[COLUMNS - 1];
    return values;
  }

  void solve()
  {
    active_ = active();
    // Each value by its own size, so that one tolerance serves all.
    std::vector<double> x(active_.size());
    for (std::size_t i = 0; i < active_.size(); ++i)
    {
      x[i] = values_[active_[i]];
    }
    const double scale = std::sqrt(squares(values_) / static_cast<double>(rows_.size()));
    ceres::Problem problem;
    for (const Row& row : rows_)
    {
      auto* cost = new ceres::DynamicAutoDiffCostFunction<RowResidual, 8>(
          new RowResidual(row, orders_, present_, values_, active_));
      cost->AddParameterBlock(static_cast<int>(x.size()));
      cost->SetNumResiduals(1);
      problem.AddResidualBlock(cost, new ceres::HuberLoss(2.0 * scale), x.data());
    }
    for (std::size_t i = 0; i < active_.size(); ++i)
    {
      if (active_[i] == LOOP)
      {
        problem.SetParameterLowerBound(x.data(), static_cast<int>(i), 1.0);
        problem.SetParameterUpperBound(x.data(), static_cast<int>(i), 500.0);
      }
      else if (active_[i] == LOOP + 1)
      {
        problem.SetParameterLowerBound(x.data(), static_cast<int>(i), 0.02);
        problem.SetParameterUpperBound(x.data(), static_cast<int>(i), 3.0);
      }
      else if (active_[i] == LOOP + 2)
      {
        problem.SetParameterLowerBound(x.data(), static_cast<int>(i), -0.02);
        problem.SetParameterUpperBound(x.data(), static_cast<int>(i), 0.02);
      }
    }
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_QR;
    options.max_num_iterations = 60;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);

    ceres::Problem::EvaluateOptions evaluate;
    evaluate.apply_loss_function = false;
    std::vector<double> residuals;
    ceres::CRSMatrix sparse;
    problem.Evaluate(evaluate, nullptr, &residuals, nullptr, &sparse);
    const auto columns = static_cast<Eigen::Index>(x.size());
    jacobian_ = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(rows_.size()), columns);
    for (int row = 0; row < sparse.num_rows; ++row)
    {
      for (int k = sparse.rows[row]; k < sparse.rows[row + 1]; ++k)
      {
        jacobian_(row, sparse.cols[k]) = sparse.values[k];
      }
    }
    residuals_ = Eigen::Map<Eigen::VectorXd>(residuals.data(), static_cast<Eigen::Index>(residuals.size()));
    for (std::size_t i = 0; i < active_.size(); ++i)
    {
      values_[active_[i]] = x[i];
    }
  }

  /// Intervals and tolerances from the Jacobian.
  void judge()
  {
    const Eigen::Index n = jacobian_.cols();
    Eigen::VectorXd size = jacobian_.colwise().norm();
    norm_ = size;
    for (Eigen::Index i = 0; i < n; ++i)
    {
      size[i] = size[i] > 0.0 ? size[i] : 1.0;
    }
    const Eigen::MatrixXd scaled = jacobian_ * size.cwiseInverse().asDiagonal();
    const Eigen::MatrixXd normal = scaled.transpose() * scaled + 1e-12 * Eigen::MatrixXd::Identity(n, n);
    inverse_ = normal.ldlt().solve(Eigen::MatrixXd::Identity(n, n));
    const double variance =
        residuals_.squaredNorm() / std::max(1.0, static_cast<double>(residuals_.size() - jacobian_.cols()));
    correlation_rows_ = correlationLength();
    half_width_.fill(0.0);
    for (Eigen::Index i = 0; i < n; ++i)
    {
      half_width_[active_[static_cast<std::size_t>(i)]] =
          NORMAL_95 * std::sqrt(variance * correlation_rows_ * inverse_(i, i)) / size[i];
    }
  }

  /// 1 + 2 sum of the residual's correlations until they first turn negative.
  double correlationLength() const
  {
    const Eigen::Index rows = residuals_.size();
    const double power = residuals_.squaredNorm();
    double length = 1.0;
    for (Eigen::Index lag = 1; lag < rows / 4 && power > 0.0; ++lag)
    {
      const double correlation = residuals_.head(rows - lag).dot(residuals_.tail(rows - lag)) / power;
      if (correlation <= 0.0)
      {
        break;
      }
      length += 2.0 * correlation;
    }
    return length;
  }

  /// True if something was refused, and the rest must be fitted anew. What the twin does without comes first: a Stribeck rise,
  /// viscous friction beside the grease's, more friction of the flanks.
  bool refuseWorst()
  {
    double worst = 0.0;
    std::size_t parameter = PARAMETERS;
    std::string reason;
    const auto consider = [&](double badness, std::size_t which, const std::string& why)
    {
      const bool extra = which == STRIBECK || which == VISCOUS || which == FLANKS;
      badness *= extra ? 1e6 : 1.0;
      if (badness > worst)
      {
        worst = badness;
        parameter = which;
        reason = why;
      }
    };
    for (std::size_t k = 0; k < active_.size(); ++k)
    {
      const std::size_t i = active_[k];
      const auto at = static_cast<Eigen::Index>(k);
      if (i >= QUANTITIES)
      {
        continue;
      }
      const double value = std::abs(values_[i]);
      const double tolerance = 1.0 / inverse_(at, at);
      if (norm_[at] <= 0.0)
      {
        consider(1e3, i, "nothing in this motion depends on it");
      }
      else if (tolerance < SMALLEST_TOLERANCE)
      {
        consider(SMALLEST_TOLERANCE / tolerance, i,
                 "the other quantities explain all but " + percent(tolerance) + " of its effect");
      }
      else if (values_[i] < 0.0 && i != OFFSET && i != INERTIA)
      {
        consider(1e3, i, "comes out negative");
      }
      else if (i != INERTIA && half_width_[i] > WIDEST * value)
      {
        consider(half_width_[i] / (WIDEST * value), i,
                 "its 95 % interval is " + percent(half_width_[i] / value) + " of the value wide to either side");
      }
      else if (i == INERTIA && half_width_[i] > WIDEST * std::abs(start_[i]))
      {
        consider(half_width_[i] / (WIDEST * std::abs(start_[i])), i,
                 "its 95 % interval is " + percent(half_width_[i] / std::abs(start_[i])) +
                     " of the configured inertia wide to either side");
      }
    }
    for (std::size_t line = 0; line < LINES; ++line)
    {
      const std::size_t i = QUANTITIES + 2 * line;
      if (present_[line])
      {
        const double amplitude = std::hypot(values_[i], values_[i + 1]);
        const double half_width = std::max(half_width_[i], half_width_[i + 1]);
        if (half_width > WIDEST * amplitude)
        {
          consider(half_width / (WIDEST * amplitude), i, "lost in the residual");
        }
      }
    }
    if (parameter == PARAMETERS)
    {
      return false;
    }
    refusal_[parameter] = reason;
    half_width_[parameter] = 0.0;
    if (parameter < QUANTITIES)
    {
      asked_[parameter] = false;
      values_[parameter] = start_[parameter];
    }
    else
    {
      present_[(parameter - QUANTITIES) / 2] = false;
      values_[parameter] = values_[parameter + 1] = 0.0;
    }
    return true;
  }

  static std::string percent(double share)
  {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.2g %%", 100.0 * share);
    return text.data();
  }

private:
  std::array<double, LINES> orders_;
  std::vector<Row> rows_;
  Values values_{};
  Values start_;
  std::array<bool, QUANTITIES> asked_{};
  std::array<bool, LINES> present_{};
  std::vector<std::size_t> active_;
  Eigen::MatrixXd jacobian_;
  Eigen::VectorXd residuals_;
  Eigen::VectorXd norm_;
  Eigen::MatrixXd inverse_;
  Values half_width_{};
  std::array<std::string, PARAMETERS> refusal_;
  double correlation_rows_{ 1.0 };
};

/// Sums up squares of an error over all, moving and resting rows.
class ErrorSum
{
public:
  void add(const MotionSample& sample, double predicted)
  {
    const double square = std::pow(predicted - sample.current, 2);
    const bool moving = std::abs(sample.velocity) > MOVING;
    squares_[moving ? 1 : 0] += square;
    ++rows_[moving ? 1 : 0];
    signal_ += sample.current * sample.current;
  }

  CurrentError result() const
  {
    const auto rms = [](double squares, std::size_t rows)
    { return rows > 0 ? std::sqrt(squares / static_cast<double>(rows)) : 0.0; };
    const std::size_t rows = rows_[0] + rows_[1];
    return { rows, rms(squares_[0] + squares_[1], rows), rms(squares_[1], rows_[1]), rms(squares_[0], rows_[0]),
             rms(signal_, rows) };
  }

private:
  std::array<double, 2> squares_{};
  std::array<std::size_t, 2> rows_{};
  double signal_{};
};

/// Error of the motion-driven twin with these parameters; `ripple` adds to its current.
template <class Ripple>
CurrentError errorOf(const Parameters& parameters, const std::vector<MotionSample>& samples, Ripple&& ripple)
{
  MotionDriven twin(parameters);
  ErrorSum sum;
  for (const MotionSample& sample : samples)
  {
    sum.add(sample, twin.step(sample).current + ripple(sample));
  }
  return sum.result();
}

double noRipple(const MotionSample& /*sample*/)
{
  return 0.0;
}

/// The usual model: current by load, sign of the speed and speed, fitted to all rows.
CurrentError simpleModelError(const std::vector<MotionSample>& train, const std::vector<MotionSample>& judge)
{
  constexpr double STANDSTILL = 0.005;  // [rad/s]
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
  for (const MotionSample& sample : judge)
  {
    sum.add(sample, coefficients.dot(columns(sample)));
  }
  return sum.result();
}

/// Those rows that move, thinned out evenly if they are too many.
std::vector<Row> movingRows(std::vector<Row> rows)
{
  rows.erase(std::remove_if(rows.begin(), rows.end(), [](const Row& row) { return !row.moving; }), rows.end());
  const std::size_t stride = rows.size() / MOST_ROWS + 1;
  std::vector<Row> kept;
  for (std::size_t i = 0; i < rows.size(); i += stride)
  {
    kept.push_back(rows[i]);
  }
  return kept;
}

/// The presliding angle by the error over all rows, resting ones too: the other values are known by then.
IdentifiedValue identifyPresliding(Parameters& parameters, const std::vector<MotionSample>& train,
                                   double correlation_rows)
{
  IdentifiedValue value{ "presliding angle",
                         "telemetry.presliding_angle",
                         "rad",
                         parameters.telemetry.presliding_angle,
                         parameters.telemetry.presliding_angle,
                         0.0,
                         "" };
  const auto squares = [&](double log_angle)
  {
    Parameters trial = parameters;
    trial.telemetry.presliding_angle = std::exp(log_angle);
    const CurrentError error = errorOf(trial, train, noRipple);
    return error.all * error.all * static_cast<double>(error.rows);
  };
  const double lowest = std::log(1e-4);
  const double highest = std::log(0.3);
  constexpr int POINTS = 17;
  double best = lowest;
  double least = HUGE_VAL;
  const double step = (highest - lowest) / (POINTS - 1);
  for (int i = 0; i < POINTS; ++i)
  {
    const double sum = squares(lowest + step * i);
    if (sum < least)
    {
      least = sum;
      best = lowest + step * i;
    }
  }
  if (best <= lowest || best >= highest)
  {
    value.refusal = "no reversal of this motion shows it";
    return value;
  }
  // A parabola through the best point and its neighbours, in the logarithm.
  const double below = squares(best - step);
  const double above = squares(best + step);
  const double curvature = (above - 2.0 * least + below) / (step * step);
  const double log_angle = best - 0.5 * (above - below) / step / curvature;
  const double variance = least / static_cast<double>(train.size());
  const double half_width = NORMAL_95 * std::sqrt(2.0 * variance * correlation_rows / curvature);
  if (!(curvature > 0.0) || half_width > WIDEST)
  {
    value.refusal = "no reversal of this motion shows it";
    return value;
  }
  value.value = std::exp(log_angle);
  value.half_width = half_width * value.value;
  parameters.telemetry.presliding_angle = value.value;
  return value;
}
}  // namespace

Identification identify(const Parameters& parameters, const std::vector<MotionSample>& train,
                        const std::vector<MotionSample>& judge, bool load_recorded)
{
  const FrictionMap friction(parameters);
  std::vector<Row> rows = movingRows(makeRows(parameters, friction, train));
  if (rows.size() < FEWEST_ROWS)
  {
    throw InputError("the joint hardly moves in the part to identify on: " + std::to_string(rows.size()) +
                     " rows are faster than " + numberText(MOVING) + " rad/s, " + std::to_string(FEWEST_ROWS) +
                     " are needed");
  }
  Fit fit(parameters, std::move(rows));
  fit.run();

  Identification result;
  result.parameters = parameters;
  result.correlation_rows = fit.correlationRows();
  const Values& found = fit.values();
  const auto add = [&](Quantity quantity, const char* name, const char* key, const char* unit, double configured,
                       double value, double half_width)
  {
    result.values.push_back({ name, key, unit, configured, value, half_width, fit.refusal(quantity) });
    return fit.refusal(quantity).empty();
  };
  const auto hw = [&](Quantity quantity) { return fit.halfWidth(quantity); };
  Parameters& p = result.parameters;
  const double gain = 1.0 / found[GAIN];
  add(GAIN, "gain", "telemetry.torque_per_current", "N.m/A", p.telemetry.torque_per_current, gain,
      hw(GAIN) * gain * gain);
  p.telemetry.torque_per_current = gain;
  add(OFFSET, "offset of the current", "telemetry.current_offset", "A", p.telemetry.current_offset, found[OFFSET],
      hw(OFFSET));
  p.telemetry.current_offset = found[OFFSET];
  // Without inertia beside the load, all of it is in the load.
  if (load_recorded)
  {
    const double held = Motor(p.motor).inertia() - found[INERTIA];
    add(INERTIA, "motor's inertia that the load holds", "telemetry.inertia_in_load", "kg.m^2",
        p.telemetry.inertia_in_load, held, hw(INERTIA));
    p.telemetry.inertia_in_load = held;
  }
  else
  {
    const double rotor = found[INERTIA] - p.motor.wave_generator_inertia + p.telemetry.inertia_in_load;
    add(INERTIA, "rotor inertia", "motor.rotor_inertia", "kg.m^2", p.motor.rotor_inertia, rotor, hw(INERTIA));
    p.motor.rotor_inertia = rotor;
  }
  add(PRELOAD, "Coulomb friction (bearing preload)", "bearing.race_preload", "N", p.bearing.race_preload,
      found[PRELOAD], hw(PRELOAD));
  p.bearing.race_preload = found[PRELOAD];
  const double viscosity = p.bearing.viscosity * std::pow(std::max(found[GREASE], 0.0), 1.5);
  add(GREASE, "friction by speed to the power 2/3 (viscosity)", "bearing.viscosity", "m^2/s", p.bearing.viscosity,
      viscosity, 1.5 * viscosity / found[GREASE] * hw(GREASE));
  p.bearing.viscosity = viscosity;
  add(FLANKS, "load-dependent friction (flanks)", "mesh.friction_kinetic", "-", p.mesh.friction_kinetic,
      found[FLANKS] * p.mesh.friction_kinetic, hw(FLANKS) * p.mesh.friction_kinetic);
  p.mesh.friction_kinetic *= found[FLANKS];
  p.mesh.friction_static *= found[FLANKS];
  add(VISCOUS, "viscous friction", "motor.viscous_friction", "N.m.s/rad", p.motor.viscous_friction, found[VISCOUS],
      hw(VISCOUS));
  p.motor.viscous_friction = found[VISCOUS];
  add(STRIBECK, "Stribeck rise at the motor", "", "N.m", 0.0, found[STRIBECK], hw(STRIBECK));

  // A joint at rest does not show its transmission error, since the output settles; cogging it does.
  std::array<bool, LINES> at_rest = fit.present();
  std::fill(at_rest.begin(), at_rest.begin() + FIRST_COGGING_LINE, false);
  Values ripple_only = found;
  ripple_only[OFFSET] = 0.0;
  const auto ripple = [&](const MotionSample& sample)
  {
    Row row{};
    row.position = sample.position;
    row.velocity = sample.velocity;
    const bool moving = std::abs(sample.velocity) > MOVING;
    return predictedCurrent(row, fit.orders(), moving ? fit.present() : at_rest, ripple_only);
  };
  result.values.push_back(identifyPresliding(p, train, result.correlation_rows));
  result.values.push_back({ "temperature of the friction", "bearing.viscosity_slope", "-", p.bearing.viscosity_slope,
                            p.bearing.viscosity_slope, 0.0, "the recording has no temperature" });
  result.values.push_back({ "torsional stiffness", "cup.torsion_stiffness", "N.m/rad", p.cup.torsion_stiffness[0],
                            p.cup.torsion_stiffness[0], 0.0,
                            "the recording has one angle a joint; motor and output are needed" });

  for (std::size_t i = 0; i < LINES; ++i)
  {
    const std::size_t at = QUANTITIES + 2 * i;
    result.lines.push_back({ fit.orders()[i], std::hypot(found[at], found[at + 1]),
                             std::max(fit.halfWidth(at), fit.halfWidth(at + 1)), std::atan2(-found[at + 1], found[at]),
                             fit.refusal(at) });
  }
  result.loop_frequency = found[LOOP];
  result.loop_damping = found[LOOP + 1];
  result.lag = found[LOOP + 2];
  result.before = errorOf(parameters, judge, noRipple);
  result.after = errorOf(p, judge, noRipple);
  result.with_lines = errorOf(p, judge, ripple);
  result.gain_coulomb_viscous = simpleModelError(train, judge);
  return result;
}
}  // namespace hjt
