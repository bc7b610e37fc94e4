// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "life/drive_ageing.hpp"
#include "life/remaining_life.hpp"

namespace hjt
{
/// What a duty cycle does to the nominal drive, in closed form: loads per revolution of the new drive, grease that
/// ages.
class NominalUse
{
public:
  NominalUse(const DriveAgeing& ageing, const LifeParameters& life, bool grease_changes);

  Usage until(double hours) const;  ///< from new
  /// `hours`: how far it looks; the use goes on as in its last stretch.
  FutureLoad from(double now, double hours, int stretches) const;

private:
  Usage hourly_;        // in fresh grease
  double grease_rate_;  // share of the grease's life by hour
  double grease_factor_;
  bool grease_changes_;
};
}  // namespace hjt
