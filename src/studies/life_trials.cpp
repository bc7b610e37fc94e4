// SPDX-License-Identifier: BSD-3-Clause
#include "studies/life_trials.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <boost/random/bernoulli_distribution.hpp>
#include <boost/random/mersenne_twister.hpp>
#include <boost/random/normal_distribution.hpp>
#include <boost/random/uniform_01.hpp>

#include "life/read_wear.hpp"

namespace hjt
{
namespace
{
using namespace assessment_errors;

/// Simulates assessments of one drive with the errors of assessment_errors and of this class. Most errors are constant
/// for a drive; a small error changes from estimate to estimate. The true cause is the kind of wear that exceeds its
/// detection limit most. A wrong cause is always wave generator wear, which changes the indicators in a similar way.
class SimulatedAssessments
{
public:
  SimulatedAssessments(const FaultScaleParameters& scale, std::uint32_t seed) : scale_(scale), random_(seed)
  {
    const double square = std::log1p(assessment_counts::ESTIMATE_SPREAD * assessment_counts::ESTIMATE_SPREAD);
    for (std::size_t i = 0; i < KINDS.size(); ++i)
    {
      const double z = normal_(random_);
      found_from_[i] = boost::random::bernoulli_distribution<>(detectionShare(KINDS[i]))(random_) ?
                           DETECTED_SEVERITY * std::exp(DETECTED_SPREAD * z) :
                           HUGE_VAL;
      estimate_factor_[i] = ESTIMATE_MEAN[i] * std::exp(std::sqrt(square) * normal_(random_) - 0.5 * square);
      mistaken_[i] = boost::random::uniform_01<double>()(random_);
    }
  }

  Assessment of(const DriveAge& age)
  {
    const std::array<double, 3> severity{ age.meanFlank() / scale_.tooth_wear_depth,
                                          age.interface_wear / scale_.interface_wear_depth, OLD_GREASE * age.grease };
    std::size_t strongest = 0;
    for (std::size_t i = 1; i < KINDS.size(); ++i)
    {
      strongest = severity[i] / found_from_[i] > severity[strongest] / found_from_[strongest] ? i : strongest;
    }
    const double noise = std::exp(ESTIMATE_NOISE * normal_(random_));
    Assessment assessment;
    assessment.state = AssessmentState::ASSESSED;
    assessment.shows_play = true;
    if (severity[strongest] < found_from_[strongest])
    {
      return assessment;
    }
    const double estimate = std::clamp(severity[strongest] * estimate_factor_[strongest] * noise, 0.1, 1.0);
    assessment.level = HealthLevel::WARN;
    assessment.cause = causeOf(mistaken_[strongest] < RIGHT_CAUSE ? KINDS[strongest] : FaultKind::WAVE_GENERATOR_WEAR);
    assessment.confidence = STATED_CONFIDENCE;
    assessment.severity = estimate;
    assessment.severity_deviation = assessment_counts::STATED_DEVIATION * estimate;
    assessment.alternative_count = mistaken_[strongest] < IN_SET ? 1 : 0;
    assessment.alternatives[0] = { causeOf(mistaken_[strongest] < RIGHT_CAUSE ? FaultKind::WAVE_GENERATOR_WEAR :
                                                                                KINDS[strongest]),
                                   Assessment::SET - STATED_CONFIDENCE, estimate, assessment.severity_deviation };
    return assessment;
  }

private:
  static constexpr std::array KINDS{ FaultKind::TOOTH_WEAR, FaultKind::INTERFACE_WEAR,
                                     FaultKind::LUBRICANT_DEGRADATION };
  static constexpr double OLD_GREASE = 0.3;  // severity of grease that is due for a change, as in a plan of lives
  static constexpr std::array<double, 3> ESTIMATE_MEAN{ assessment_counts::TOOTH_WEAR_ESTIMATE,
                                                        assessment_counts::INTERFACE_WEAR_ESTIMATE,
                                                        assessment_counts::LUBRICANT_DEGRADATION_ESTIMATE };
  static constexpr double ESTIMATE_NOISE = 0.1;             // spread of an estimate's logarithm (assumption)
  static constexpr double STATED_CONFIDENCE = RIGHT_CAUSE;  // confidence of a calibrated assessment

  FaultScaleParameters scale_;
  boost::random::mt19937 random_;
  boost::random::normal_distribution<double> normal_;
  std::array<double, 3> found_from_;  // severity at which each kind of wear is found; infinite: never
  std::array<double, 3> estimate_factor_;
  std::array<double, 3> mistaken_;  // uniform random numbers in 0 ... 1; the cause is right below RIGHT_CAUSE
};

/// Simulates readings of one drive's wear with the errors of assessment_errors.
class SimulatedReadings
{
public:
  SimulatedReadings(const FaultScaleParameters& scale, std::uint32_t seed)
    : scale_(scale)
    , random_(seed)
    , flank_(drawn(FLANK_READING))
    , interface_(drawn(INTERFACE_READING))
    , of_flank_(FLANK_IN_INTERFACE * normal_(random_))
  {
  }

  WearReading of(const DriveAge& age)
  {
    WearReading reading;
    reading.is_read = true;
    reading.alike = 1.0;
    reading.flank = read(age.meanFlank() / scale_.tooth_wear_depth, FLANK_READING, flank_) - FLANK_SHORT;
    reading.interface = read(age.interface_wear / scale_.interface_wear_depth, INTERFACE_READING, interface_) +
                        (of_flank_ - INTERFACE_SHORT) * reading.flank;
    return reading;
  }

private:
  struct Stays
  {
    double gain;
    double offset;
  };
  Stays drawn(const ReadingErrors& errors)
  {
    const double gain = errors.gain * normal_(random_);
    return { gain, errors.offset * normal_(random_) };
  }
  double read(double severity, const ReadingErrors& errors, const Stays& stays)
  {
    const double shown = severity * (1.0 + stays.gain);
    const double noise = std::hypot(errors.noise, errors.noise_share * shown);
    return shown + stays.offset + noise * normal_(random_);
  }

  FaultScaleParameters scale_;
  boost::random::mt19937 random_;
  boost::random::normal_distribution<double> normal_;
  Stays flank_;
  Stays interface_;
  double of_flank_;
};

/// Forecasts the remaining life of one drive from its use, its assessments and its readings.
class Watch
{
public:
  Watch(const Parameters& parameters, const DriveAgeing& ageing, const LifeTrialOptions& options, std::uint32_t seed)
    : options_(options)
    , fault_scale_(parameters.fault_scale)
    , use_(ageing, parameters.life, options.grease_changes)
    , drives_(parameters)
    , assessments_(parameters.fault_scale, seed)
    , simulated_(parameters.fault_scale, seed + READINGS_SEED)
  {
  }

  LifeForecast forecast(double hours, double remaining, const DriveAge& age)
  {
    constexpr int STRETCHES = 400;
    constexpr double HORIZON = 3.0;  // length of the tabulated future use, over the age of the drive
    const Usage so_far = use_.until(hours);
    const FutureLoad ahead = use_.from(hours, HORIZON * (hours + options_.every), STRETCHES);
    const Assessment assessment = assessments_.of(age);
    read_.readings.push_back({ hours, simulated_.of(age) });
    const WearTrends trends = trendsOf(read_, use_, fault_scale_, 0.0);
    return { hours,
             remaining,
             assessment,
             drives_.remaining(so_far, ahead, &assessment, {}),
             drives_.remaining(so_far, ahead, nullptr, {}, trends),
             drives_.remaining(so_far, ahead, nullptr, {}) };
  }

private:
  static constexpr std::uint32_t READINGS_SEED = 1'000'000;

  LifeTrialOptions options_;
  FaultScaleParameters fault_scale_;
  NominalUse use_;
  RemainingLife drives_;
  SimulatedAssessments assessments_;
  SimulatedReadings simulated_;
  ReadWear read_;
};
}  // namespace

Coverage coverage(const std::vector<LifeTrial>& trials, double from)
{
  Coverage coverage;
  for (const LifeTrial& trial : trials)
  {
    for (const LifeForecast& forecast : trial.forecasts)
    {
      if (forecast.hours >= from * trial.life.hours)
      {
        ++coverage.forecasts;
        coverage.held += forecast.held() ? 1 : 0;
      }
    }
  }
  return coverage;
}

std::vector<LifeTrial> runLifeTrials(const Parameters& parameters, const DriveAgeing& ageing,
                                     const LifeTrialOptions& options, double longest,
                                     const std::function<void(double)>& progress)
{
  const BearingLife bearing(parameters.life);
  boost::random::mt19937 random(options.seed);
  std::vector<LifeTrial> trials;
  for (int i = 0; i < options.lives; ++i)
  {
    const UnitVariation variation = drawVariation(parameters.life, bearing, random);
    LifeTrial trial{ variation, ageing.live(variation, longest, longest, options.grease_changes, {}), {} };
    if (trial.life.end)
    {
      Watch watch(parameters, ageing, options, options.seed + static_cast<std::uint32_t>(i) + 1u);
      ageing.live(variation, trial.life.hours, options.every, options.grease_changes,
                  [&](double hours, const DriveAge& age)
                  {
                    if (hours > 0.0 && hours < trial.life.hours)
                    {
                      trial.forecasts.push_back(watch.forecast(hours, trial.life.hours - hours, age));
                    }
                  });
    }
    trials.push_back(std::move(trial));
    progress((i + 1.0) / options.lives);
  }
  return trials;
}
}  // namespace hjt
