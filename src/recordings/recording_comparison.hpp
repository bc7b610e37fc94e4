// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "gear/angle.hpp"
#include "output/json.hpp"
#include "recordings/recorded_motion.hpp"
#include "tracking/joint_evidence.hpp"
#include "tracking/verdict.hpp"

namespace hjt
{
/// Every nth of a stream of any length, at least MAX_ROWS / 2 of it once there are as many, never more than MAX_ROWS.
template <class Row>
class Decimated
{
public:
  static constexpr std::size_t MAX_ROWS = 16000;

  void add(const Row& row)
  {
    if (seen_++ % stride_ == 0)
    {
      rows_.push_back(row);
      if (rows_.size() == MAX_ROWS)
      {
        halve();
      }
    }
  }

  const std::vector<Row>& rows() const { return rows_; }

private:
  void halve()
  {
    for (std::size_t i = 0; i < MAX_ROWS / 2; ++i)
    {
      rows_[i] = rows_[2 * i];
    }
    rows_.resize(MAX_ROWS / 2);
    stride_ *= 2;
  }

  std::vector<Row> rows_;
  std::uint64_t seen_{};
  std::uint64_t stride_{ 1 };
};

/// One line of a spectrum by turns of the motor, for each way of turning.
struct SpectrumLine
{
  double order{};  ///< per turn of the motor [-]
  double forward{};
  double backward{};
};

/// The part of a residual that repeats with the joint's angle, in orders of the motor's turn.
///
/// The residual is averaged over narrow bins of the joint's angle, both ways apart; so memory does not grow, time needs
/// not be even and what does not stay in place goes out. The amplitude at order o is |2 / n sum r exp(-i o theta)| over
/// the bins that were visited; where these do not fill a turn of the joint, neighbouring orders leak into each other.
class ResidualSpectrum
{
public:
  static constexpr double MAX_ORDER = 16.0;

  explicit ResidualSpectrum(double ratio) : ratio_(ratio)
  {
    bins_.fill(std::vector<Bin>(static_cast<std::size_t>(BINS_PER_MOTOR_TURN * std::ceil(ratio))));
  }

  /// `angle` and `speed` of the joint [rad], [rad/s].
  void add(double angle, double speed, double residual)
  {
    std::vector<Bin>& bins = bins_[speed < 0.0 ? 0 : 1];
    const double turns = angle / TWO_PI;
    const double part = turns - std::floor(turns);
    Bin& bin = bins[static_cast<std::size_t>(part * static_cast<double>(bins.size())) % bins.size()];
    bin.sum += residual;
    bin.rows += 1.0;
  }

  /// Lines at every whole order of the joint's turn; amplitudes in the residual's unit. Empty: the joint passed less
  /// than a motor turn.
  std::vector<SpectrumLine> lines() const
  {
    const int highest = static_cast<int>(MAX_ORDER * ratio_);
    std::array<std::vector<double>, 2> found;
    bool any = false;
    for (std::size_t way = 0; way < 2; ++way)
    {
      const std::vector<Bin>& bins = bins_[way];
      std::vector<Place> places;
      double mean = 0.0;
      for (std::size_t i = 0; i < bins.size(); ++i)
      {
        if (bins[i].rows > 0.0)
        {
          const double angle = TWO_PI * (static_cast<double>(i) + 0.5) / static_cast<double>(bins.size());
          places.push_back({ angle, bins[i].sum / bins[i].rows });
          mean += places.back().residual;
        }
      }
      for (Place& place : places)
      {
        place.residual -= mean / static_cast<double>(places.size());
      }
      if (places.size() < BINS_PER_MOTOR_TURN)
      {
        places.clear();
      }
      any = any || !places.empty();
      found[way] = amplitudes(places, highest);
    }
    std::vector<SpectrumLine> lines;
    for (int order = 1; any && order <= highest; ++order)
    {
      const auto i = static_cast<std::size_t>(order - 1);
      lines.push_back({ order / ratio_, found[1][i], found[0][i] });
    }
    return lines;
  }

private:
  /// Mean residual at one angle of the joint.
  struct Place
  {
    double angle;
    double residual;
  };

  /// Amplitude of orders 1 ... highest of the joint's turn; each place's phasor is turned on from order to order.
  static std::vector<double> amplitudes(const std::vector<Place>& places, int highest)
  {
    using Phasor = std::complex<double>;
    std::vector<Phasor> phasors;
    std::vector<Phasor> steps;
    for (const Place& place : places)
    {
      phasors.emplace_back(place.residual);
      steps.push_back(std::polar(1.0, -place.angle));
    }
    std::vector<double> result;
    for (int order = 1; order <= highest; ++order)
    {
      Phasor sum;
      for (std::size_t i = 0; i < phasors.size(); ++i)
      {
        phasors[i] *= steps[i];
        sum += phasors[i];
      }
      result.push_back(phasors.empty() ? 0.0 : 2.0 * std::abs(sum) / static_cast<double>(phasors.size()));
    }
    return result;
  }

  static constexpr int BINS_PER_MOTOR_TURN = 128;
  struct Bin
  {
    double sum{};
    double rows{};
  };

  double ratio_;
  std::array<std::vector<Bin>, 2> bins_;  // over one turn of the joint: backward, forward
};

/// One row, measured beside predicted.
struct ComparedRow
{
  MotionSample measured;
  MotionPrediction predicted;

  double residual() const { return measured.current - predicted.current; }  ///< [A]
};

/// A recorded joint beside the twin that makes the same motion: what is judged of it, and what a page shows besides.
/// Memory does not grow with the rows.
class RecordingComparison
{
public:
  /// `baseline`: of the sound joint; empty: learned from the first windows. `watch`: is given every window.
  /// @throws ParameterError if the ring finds no equilibrium under load.
  RecordingComparison(const Parameters& parameters, LoadOrigin load, std::vector<ReferenceBin> baseline,
                      std::function<void(const JudgedWindow&)> watch)
    : evidence_(parameters, load), spectrum_(evidence_.ratio()), watch_(std::move(watch))
  {
    evidence_.setReference(std::move(baseline));
  }

  void update(const MotionSample& sample)
  {
    const JointEvidence::Row taken = evidence_.update(sample);
    if (taken == JointEvidence::Row::IMPOSSIBLE)
    {
      return;
    }
    const ComparedRow row{ sample, evidence_.predicted() };
    course_.add(row);
    if (taken == JointEvidence::Row::TOUCHED)
    {
      return;
    }
    if (std::abs(sample.velocity) > FrictionPoints::SLOWEST && row.predicted.tellsFriction())
    {
      spectrum_.add(sample.position, sample.velocity, row.residual());
    }
    if (taken == JointEvidence::Row::WINDOW)
    {
      const Assessor& assessor = evidence_.assessor();
      watch_({ evidence_.indicators(), assessor.deviations(), assessor.assessment() });
    }
  }

  const JointEvidence& evidence() const { return evidence_; }
  const Decimated<ComparedRow>& course() const { return course_; }
  const ResidualSpectrum& spectrum() const { return spectrum_; }

private:
  JointEvidence evidence_;
  Decimated<ComparedRow> course_;
  ResidualSpectrum spectrum_;
  const std::function<void(const JudgedWindow&)> watch_;
};

/// A topic or column that a comparison can use.
struct ContentLine
{
  std::string name;
  std::string gives;
  std::uint64_t messages{};  ///< rows of a CSV file; of temperatures: rows that have one
  bool found{};
};

/// Contents of a recording.
struct RecordingContents
{
  std::vector<ContentLine> lines;
  std::vector<std::string> joints;        ///< named in the telemetry's first message
  std::vector<std::string> other_topics;  ///< that a comparison does not use
};

/// One instant of the twin that ran when the bag was made.
struct TwinState
{
  double time{};           ///< since the first row of the telemetry [s]
  double position{};       ///< of the joint [rad]
  double velocity{};       ///< [rad/s]
  double motor_current{};  ///< [A]
};

/// `twin_topic`: the joint states of a twin that was recorded beside the robot. `count`: of the reading;
/// `temperature_rows`: those with a received temperature.
/// @throws InputError if the file cannot be read.
RecordingContents readContents(const MotionSource& source, const std::string& twin_topic, const MotionCount& count,
                               std::uint64_t motor_rows, std::uint64_t temperature_rows, bool has_load);

/// The twin's recorded states; none where the recording has no such topic, or it is the telemetry itself.
Decimated<TwinState> readTwinStates(const MotionSource& source, const std::string& twin_topic, double start);

/// All that a report is made of.
struct ComparisonRecord
{
  std::string recording;
  std::string joint;
  std::string made_with;  ///< name and version of the program
  MotionFindings found;
  FrictionFactor friction;
  bool is_friction_judged{};
  RecordingContents contents;
  Decimated<TwinState> twin_states;
  Verdict verdict;
};

/// The fields of Verdict.msg; level and reason by name.
Json verdictFields(const Verdict& verdict);

/// Writes COMPARISON_FILE, BASELINE_FILE and tables beside them, as CSV: course, friction, friction_twin, spectrum,
/// teeth, health, and where the recording has them torsion, torsion_twin, twin_states. Solves the ring under the loads
/// of the recording. Gives what COMPARISON_FILE holds; with an empty `directory` that alone, and nothing is written.
/// @throws InputError if a file cannot be written.
Json writeComparison(const std::string& directory, const RecordingComparison& comparison, const Parameters& parameters,
                     const ComparisonRecord& record);
}  // namespace hjt
