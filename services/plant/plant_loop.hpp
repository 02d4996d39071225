// The simulated vehicle in real time, on the network.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>

#include <boost/lockfree/spsc_queue.hpp>

#include "plant/simulation/actuator_watchdog.hpp"
#include "plant/simulation/plant_simulation.hpp"
#include "services/comms/convert.hpp"
#include "services/comms/node.hpp"
#include "services/plant/answer_times.hpp"
#include "services/runtime/mailbox.hpp"
#include "services/runtime/periodic_timer.hpp"
#include "services/runtime/realtime.hpp"

namespace swiftlet::services {

// What the loop tells the rest of the process.
struct PlantReport {
  std::int64_t stamp_ns = 0;
  bool rotors_running = false;
  bool timed_out = false;  // the vehicle stopped its rotors itself: commands ceased
  std::uint64_t answered = 0;
  std::uint64_t unanswered = 0;
  std::int64_t answer_p50_ns = 0;
  std::int64_t answer_p99_ns = 0;
  std::int64_t answer_max_ns = 0;
  std::uint64_t commands = 0;  // that were obeyed
  std::uint64_t refused_commands = 0;
  comms::Fault refusal;         // of the last of those
  std::uint64_t slips = 0;      // times that the loop fell behind real time
  std::int64_t slipped_ns = 0;  // in all
};

class PlantLoop {
 public:
  PlantLoop(const plant::Vehicle& vehicle, const plant::SimulationSettings& settings, std::uint64_t seed,
            comms::Node& node, const runtime::RealtimeSettings& realtime);

  // Steps in real time until `stop`. Behind by more than an IMU period, simulated time is put off instead of
  // made up for: no burst of samples that nobody could answer.
  void run(const std::atomic<bool>& stop);

  runtime::Mailbox<PlantReport>& reports() { return reports_; }

 private:
  struct ReceivedCommand {
    plant::ActuatorCommand command;
    std::int64_t received_ns = 0;
    comms::Fault fault;
  };

  void on_command(const comms::msg::ActuatorCommand& message);
  void take_commands();
  void step();
  void publish_samples();
  void report();

  plant::PlantSimulation simulation_;
  plant::ActuatorWatchdog watchdog_;
  std::int64_t step_ns_;
  std::int64_t imu_period_ns_;
  runtime::RealtimeSettings realtime_;

  PlantReport report_;
  bool told_running_ = false;
  bool told_timed_out_ = false;
  std::int64_t reported_ns_ = 0;
  AnswerTimes answers_;
  runtime::Mailbox<PlantReport> reports_;

  comms::Publisher<comms::msg::Imu> imu_;
  comms::Publisher<comms::msg::GroundTruth> ground_truth_;
  comms::Publisher<comms::msg::RotorSpeeds> rotor_speeds_;
  comms::Publisher<comms::msg::Battery> battery_;

  boost::lockfree::spsc_queue<ReceivedCommand, boost::lockfree::capacity<64>> received_;
  bool listener_scheduled_ = false;
  comms::Subscription commands_;  // last: its callback uses what stands above
};

}  // namespace swiftlet::services
