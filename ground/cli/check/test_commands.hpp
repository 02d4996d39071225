// Sends actuator commands to a vehicle that no controller flies, one for each IMU sample. Ends with rotors off, also if
// no sample comes any more.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>

#include "swiftlet/plant/model/samples.hpp"
#include "swiftlet/services/dds/node.hpp"

namespace swiftlet::ground {

// Thread-safe.
class TestCommands {
 public:
  // If renew() is not called for this long, the commands become rotors off: the program hangs.
  static constexpr std::int64_t kPatience_ns = 1'000'000'000;

  // Sends rotors off at first. term: of the commands, as that of a controller. Throws std::runtime_error.
  TestCommands(const dds::NodeSettings& settings, int rotor_count, std::uint32_t term);
  // Sends rotors off until a few commands have been sent, for half a second at most.
  ~TestCommands();
  TestCommands(const TestCommands&) = delete;
  TestCommands& operator=(const TestCommands&) = delete;

  // Rotors off, unless told otherwise.
  struct Order {
    bool silent = false;  // sends nothing
    bool lower_term = false;
    plant::RotorState state = plant::RotorState::kOff;
    plant::PerRotor throttle{};  // 0 .. 1
  };
  void set(const Order& order);
  void renew();

  std::uint32_t term() const { return term_; }
  std::uint32_t lower_term() const { return term_ - 1; }

 private:
  void answer(const messages::msg::Imu& imu);
  void send();  // answers the newest sample; the caller holds mutex_

  const std::uint32_t term_;
  const int rotor_count_;
  std::mutex mutex_;  // guards all below, up to the node
  std::condition_variable sent_;
  Order order_;
  std::int64_t renewed_ns_ = 0;
  struct Sample {
    std::int64_t stamp_ns = 0;
    std::uint64_t sequence = 0;
  };
  std::optional<Sample> newest_;
  std::uint64_t commands_ = 0;
  std::uint64_t commands_in_order_ = 0;  // since set()

  dds::Node node_;
  dds::Publisher<messages::msg::ActuatorCommand> publisher_;
  dds::Subscription imu_;  // last: its callback uses all members above
};

// A term that vehicle and controllers accept: above the one that the vehicle obeyed last, below that of the next
// takeover. obeyed_term: 0 if there is none.
std::uint32_t term_above(std::uint32_t obeyed_term);

}  // namespace swiftlet::ground
