// SPDX-License-Identifier: BSD-3-Clause
#include "ros_io/bag_recorder.hpp"

#include <limits>

namespace hjt
{
BagRecorder::BagRecorder(const Twin& twin, const std::string& joint_namespace, BagWriter& bag)
  : context_{ bag, joint_namespace + "/" }
  , names_(twin.parameters().joint.name)
  , recorded_faults_(twin.activeFaults().empty() ? twin.activeFaults().version() :
                                                   std::numeric_limits<std::uint64_t>::max())
  , outputs_(context_, twin.parameters())
{
}

void BagRecorder::record(Twin& twin)
{
  if (const FaultList& faults = twin.activeFaults(); faults.version() != recorded_faults_)
  {
    recorded_faults_ = faults.version();
    context_.bag.write(context_.prefix + topics::FAULTS, twin.stamp(), makeFaults(names_, twin.stamp(), faults));
  }
  outputs_.offer(twin);
}
}  // namespace hjt
