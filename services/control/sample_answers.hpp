// Answers the samples of the vehicle: a step of the inner loop, its command, and what other controllers have to know of it.
#pragma once

#include <cstdint>

#include "swiftlet/services/control/command_publisher.hpp"
#include "swiftlet/services/control/failover.hpp"
#include "swiftlet/services/control/inner_loop.hpp"
#include "swiftlet/services/control/loop_delay.hpp"
#include "swiftlet/services/control/semaphore.hpp"
#include "swiftlet/services/control/vehicle_restarts.hpp"
#include "swiftlet/services/control/vehicle_sample.hpp"
#include "swiftlet/services/dds/node.hpp"
#include "swiftlet/services/messages/convert.hpp"

namespace swiftlet::services {

// In which role a sample is answered.
struct Authority {
  Role role = Role::kStandby;
  std::uint32_t term = 0;           // of the command
  std::uint32_t followed_term = 0;  // standby: of the active controller whose state it adopts; 0: none
  LoopDelay::Figures loop_delay;    // for telemetry
};

// Used by one thread at a time. Does not block, allocate or log.
class SampleAnswers {
 public:
  // Posts `wake` when there is new output for telemetry. controller: its random number.
  SampleAnswers(InnerLoop& loop, CommandPublisher& commands, Semaphore& wake, dds::Node& node,
                std::uint64_t controller, int failover_priority, int rotor_count);

  // A standby's step too, of which no command is sent.
  void answer(const VehicleSample& sample, const Authority& authority);
  // A plant in lockstep repeats a sample while its time stands still, since the command for it may be lost: the pending requests
  // are answered, and the same command is published again.
  void repeat();

  VehicleRestarts& restarts() { return restarts_; }

 private:
  void publish_command();
  void finish();
  void report(std::int64_t stamp_ns);

  InnerLoop& loop_;
  CommandPublisher& commands_;
  Semaphore& wake_;
  dds::Publisher<messages::msg::ControllerState> reports_;
  messages::ControllerReport report_;
  VehicleRestarts restarts_;
  Authority authority_;  // of the last sample
  plant::VehicleCommand last_answer_;
};

}  // namespace swiftlet::services
