// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "recordings/decimated.hpp"
#include "recordings/residual_spectrum.hpp"

#include "tracking/joint_evidence.hpp"

namespace hjt
{
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
    if (std::abs(sample.velocity) > JointEvidence::MOVING && evidence_.tellsFriction(row.predicted))
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
}  // namespace hjt
