// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "harmonic_joint_twin/health/baseline.hpp"
#include "harmonic_joint_twin/health/fault_signatures.hpp"

namespace hjt
{
/// Level of the drive's health, with the values of diagnostic_msgs/DiagnosticStatus.
enum class HealthLevel : std::uint8_t
{
  OK = 0,
  WARN = 1,
  ERROR = 2
};

const char* levelName(HealthLevel level) noexcept;  ///< name of a level, for example "WARN"

enum class AssessmentState : std::uint8_t
{
  WAITING = 0,          ///< no window has been completed
  LEARNING = 1,         ///< the reference of this operating point is still being learned
  ASSESSED = 2,         ///< the last window was compared with the reference, and the level is a verdict
  NO_REFERENCE = 3,     ///< the given reference does not contain this operating point
  TOO_FEW_WINDOWS = 4,  ///< the windows show no deviation so far, but are too few for the verdict OK
  OTHER_PAYLOAD = 5     ///< the reference does not cover the payload or load of the last window
};

/// One indicator that supports the level.
struct Evidence
{
  std::size_t indicator{};
  double value{};     ///< value of the indicator in its unit
  double expected{};  ///< mean of a sound drive at this operating point, in the indicator's unit
  double score{};     ///< normal score of the deviation from `expected` [-]
};

/// Another cause that would change the indicators in a similar way.
struct Alternative
{
  Cause cause{};
  double confidence{};          ///< probability of the cause [-]
  double severity{};            ///< mean severity of the fault, if this is the cause; 0 with NONE [-]
  double severity_deviation{};  ///< standard deviation of that severity [-]
};

/// State of the drive according to its indicators.
struct Assessment
{
  static constexpr std::size_t MAX_EVIDENCE = 3;
  static constexpr std::size_t MAX_ALTERNATIVES = 3;
  static constexpr double SET = 0.9;  ///< least probability of the cause and its alternatives together [-]

  std::int64_t stamp{};     ///< end of the last window [ns]
  std::uint64_t windows{};  ///< number of completed windows
  AssessmentState state{};
  /// windows at the last operating point: those in its reference while learning, then those compared with it
  int windows_here{};
  int windows_needed{};  ///< number of windows that a reference or a verdict needs
  HealthLevel level{};
  Cause cause{};        ///< most likely cause; NONE at level OK, or if no known fault explains the deviation
  bool shows_play{};    ///< the load of the last window changed its sign, so that its lost motion was compared
  Cause pattern{};      ///< cause whose pattern has the largest score; NONE if a single indicator has a larger score
  double confidence{};  ///< probability of the cause; 0 at level OK [-]
  double severity{};    ///< mean severity of the fault, if this is the cause; 0 with NONE [-]
  double severity_deviation{};  ///< standard deviation of that severity [-]
  /// largest score of the mean of the last windows over its threshold; beyond 1 it is an alarm [-]
  double largest_score{};
  std::size_t alternative_count{};
  /// most likely first; with the cause they reach the probability SET
  std::array<Alternative, MAX_ALTERNATIVES> alternatives;
  std::size_t evidence_count{};
  /// indicators beyond the threshold, strongest first; at least one in an alarm
  std::array<Evidence, MAX_EVIDENCE> evidence;
};

/// Reason why the last window has no verdict, as a clause; empty if it has a verdict.
std::string whyNotJudged(const Assessment& assessment);

/// Derives level, most likely cause and evidence from the windows. The storage has a fixed size.
///
/// The assessor judges the mean of the last windows of an operating point (Baseline). WARN: an indicator or a cause's
/// pattern exceeds the baseline's threshold. ERROR: it exceeds indicators.error_factor times the threshold. The level
/// rises after three successive means that show the higher level; each mean is of at least three windows. The level
/// falls after three successive means that show a lower level, at the operating point that last showed the present
/// level. With indicators.evidence_windows < 3 that number replaces three. OK is no verdict before enough means could
/// have shown another level. The last verdict stays while the reference lacks the operating point or the payload.
class Assessor
{
public:
  /// @throws ParameterError if the file of indicators.signatures is invalid (loadSignatures).
  explicit Assessor(const Parameters& parameters);

  void reset() noexcept;
  void setReference(std::vector<ReferenceBin> bins, bool carried = false)
  {
    baseline_.setReference(std::move(bins), carried);
  }

  /// Assesses a completed window. `model`: indicators of a model that were subtracted from it.
  const Assessment& update(const SignalIndicators& indicators, const SignalIndicators* model = nullptr) noexcept;

  /// Does the same as `update` in parts, for a control loop. After `begin`, each call of `advance` compares the window
  /// with a given number of signatures. After all of them the assessment is that of the new window.
  void begin(const SignalIndicators& indicators, const SignalIndicators* model = nullptr) noexcept;
  void advance(std::size_t signatures) noexcept
  {
    if (is_searching_)
    {
      search(signatures);
    }
  }

  const Assessment& assessment() const noexcept { return settled_; }
  const Baseline& baseline() const noexcept { return baseline_; }
  const SignatureSet& signatures() const noexcept { return *signatures_; }
  /// Number of steps of a search, for `advance`.
  std::size_t searchLength() const noexcept { return cause_search_.signatures(); }
  const Deviations& deviations() const noexcept { return deviations_; }  ///< deviations of the last window

private:
  void judge(const SignalIndicators& indicators, const SignalIndicators* model) noexcept;
  void search(std::size_t signatures) noexcept;
  void setState(BaselineState compared) noexcept;
  HealthLevel levelOf(const FeatureScores& scores, const OperatingPoint& point) noexcept;
  void updateLevel(HealthLevel level) noexcept;
  void explain(const CausePosterior& posterior) noexcept;
  void listEvidence(const SignalIndicators& indicators, const FeatureScores& scores) noexcept;

  std::shared_ptr<const SignatureSet> signatures_;
  const int least_windows_;
  const double error_factor_;
  Baseline baseline_;
  Deviations deviations_;
  Assessment assessment_;  // of the last window; its cause is missing during the search
  Assessment settled_;     // of the last window, with its cause
  CausePatterns patterns_;
  CauseSearch cause_search_;
  OperatingPoint point_;  // operating point of the window whose cause is being searched
  bool is_searching_{};
  OperatingBin shown_in_;  // operating point at which the level was last seen
  int worse_{};            // successive windows that show a higher level
  int better_{};           // successive windows that show a lower level
  HealthLevel least_worse_{};
  HealthLevel most_better_{};
};
}  // namespace hjt
