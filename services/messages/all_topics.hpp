// All topics of a vehicle, for tools that handle every one.
#pragma once

#include "swiftlet/services/messages/topics.hpp"

namespace swiftlet::messages {

// Calls use(topic) with each Topic<T>.
template <class Use>
void for_each_topic(const Use& use) {
  use(topics::kImu);
  use(topics::kVehicleOdometry);
  use(topics::kActuatorCommand);
  use(topics::kRatesSetpoint);
  use(topics::kAttitudeSetpoint);
  use(topics::kTrajectorySetpoint);
  use(topics::kControllerState);
  use(topics::kMocapPose);
  use(topics::kRotorSpeeds);
  use(topics::kSetpoint);
  use(topics::kClockRequest);
  use(topics::kClockReply);
  use(topics::kBattery);
  use(topics::kEstimate);
  use(topics::kReference);
  use(topics::kGroundTruth);
  use(topics::kClockStatus);
  use(topics::kControlStatus);
  use(topics::kMissionStatus);
  use(topics::kVehicleInfo);
  use(topics::kGroundLink);
  use(topics::kSimulationClock);
  use(topics::kCommand);
  use(topics::kMission);
  use(topics::kTrajectory);
  use(topics::kControlSettings);
  use(topics::kFlownMission);
  use(topics::kFlownTrajectory);
  use(topics::kCommandAck);
}

}  // namespace swiftlet::messages
