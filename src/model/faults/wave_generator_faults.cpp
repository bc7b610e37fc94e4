// SPDX-License-Identifier: BSD-3-Clause
#include "model/faults/fault_edits.hpp"

namespace hjt
{
/// The lobes press hardest and wear; the bearing's races then sit looser on the plug by its smaller mean radius.
void editWaveGeneratorWear(const Fault& fault, const Parameters& parameters, FaultEdits& edits, BearingSag&) noexcept
{
  const double depth = fault.severity * parameters.fault_scale.wave_generator_wear_depth;
  for (int lobe = 0; lobe < 2; ++lobe)
  {
    if (fault.place == WHOLE_MEMBER || fault.place == lobe)
    {
      edits.lobe_wear[static_cast<std::size_t>(lobe)] += depth;
      edits.preload_loss += 0.25 * depth * parameters.fault_scale.race_fit_stiffness;
    }
  }
}
}  // namespace hjt
