// Records a standing vehicle and checks it.
#pragma once

#include <chrono>
#include <functional>

#include "swiftlet/ground/cli/check/sample_recorder.hpp"
#include "swiftlet/ground/vehicle_check/check_result.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::ground {

struct StandingRequest {
  const plant::Vehicle* vehicle = nullptr;  // null if its file is not known
  bool mocap_required = false;
  std::chrono::milliseconds time{2000};     // of a recording
  std::chrono::milliseconds timeout{5000};  // longest wait for the first IMU sample
  std::function<bool()> cancelled = [] { return false; };
};

struct StandingExamination {
  VehicleRecording recording;
  CheckResults results;
};

// Records again if something fails, three times at most: a busy moment of this computer looks like a gap. What it
// returns is of the last recording; of a cancelled one if cancelled() returns true.
StandingExamination examine_standing(SampleRecorder& recorder, const StandingRequest& request);

}  // namespace swiftlet::ground
