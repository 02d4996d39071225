// Settings of an external autopilot that flies the simulated vehicle in place of the control service.
#pragma once

#include <cstdint>
#include <string>

namespace swiftlet::services {

struct AutopilotSettings {
  // The simulator is the TCP server, as PX4 expects it.
  std::string address = "127.0.0.1";
  int port = 4560;
  std::string device;  // of a serial link instead of TCP; empty: TCP
  int baud = 921'600;
  int system_id = 0;  // MAVLink system to obey; 0: the first that is heard
  // Which control drives which rotor: "px4", "direct", or the number of the control, from 1, of each rotor.
  std::string controls = "px4";
  double control_at_zero = 0.0;  // control at throttle 0
  double control_at_full = 1.0;  // control at throttle 1
  // Only ground_truth is published, with stamps of the vehicle on the network: another process, such as swiftlet-px4, is that.
  bool truth_only = false;
  // Lockstep: after this time without an answer, simulated time goes on at the pace of real time.
  double answer_timeout_s = 0.5;

  // "MAVLink on TCP port 4560"
  std::string description() const;
};

}  // namespace swiftlet::services
