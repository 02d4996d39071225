// The steps of `swiftlet check vehicle --hand`: asks for each motion and records it.
#pragma once

#include <vector>

#include "swiftlet/ground/cli/check/operator_dialog.hpp"
#include "swiftlet/ground/cli/check/sample_recorder.hpp"
#include "swiftlet/ground/vehicle_check/hand_motion.hpp"

namespace swiftlet::ground {

// Steps that motion capture does not see within their time are not among the segments, and end the sequence. Throws
// Interrupted.
std::vector<HandSegment> guide_hand(const SampleRecorder& recorder, const OperatorDialog& dialog);

}  // namespace swiftlet::ground
