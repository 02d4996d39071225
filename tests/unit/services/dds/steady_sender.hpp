// Sends actuator commands at 500 Hz from its own thread.
#pragma once

#include <atomic>
#include <cstdint>
#include <thread>

#include "swiftlet/services/dds/node.hpp"
#include "swiftlet/services/runtime/periodic_timer.hpp"
#include "tests/unit/services/messages/messages.hpp"

namespace swiftlet::dds::fixtures {

class SteadySender {
 public:
  // All commands have this sequence number. The publisher must outlive the sender.
  SteadySender(Publisher<messages::msg::ActuatorCommand>& publisher, std::uint64_t sequence_number)
      : thread_([this, &publisher, sequence_number] {
          messages::msg::ActuatorCommand command =
              messages::fixtures::example<messages::msg::ActuatorCommand>();
          command.sequence_number(sequence_number);
          runtime::PeriodicTimer timer(2'000'000, 2'000'000);
          while (!stop_) {
            publisher.publish(command);
            timer.wait();
          }
        }) {}
  ~SteadySender() {
    stop_ = true;
    thread_.join();
  }
  SteadySender(const SteadySender&) = delete;
  SteadySender& operator=(const SteadySender&) = delete;

 private:
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace swiftlet::dds::fixtures
