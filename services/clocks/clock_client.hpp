// Translates the stamps of a clock of its own to the vehicle's clock.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>

#include "swiftlet/services/clocks/clock_filter.hpp"
#include "swiftlet/services/dds/node.hpp"
#include "swiftlet/services/runtime/latest_value.hpp"

namespace swiftlet::clocks {

// For a process with a clock of its own: it asks the vehicle for its clock and filters the answers. Neither clock needs to
// be right or steady.
class ClockClient {
 public:
  enum class Reporting {
    kPublished,  // what is known, as clock_status, and in the log: for motion capture, whose frames carry stamps of that clock
    kNone
  };

  static constexpr std::chrono::milliseconds kPeriod{50};       // of the requests
  static constexpr std::chrono::milliseconds kFirstPeriod{10};  // while the vehicle's clock is unknown

  // own_ns: reads the own clock; each may have any origin. Called in several threads.
  ClockClient(dds::Node& node, std::function<std::int64_t()> own_ns,
              Reporting reporting = Reporting::kPublished);

  // Call these two in one thread, for each measurement. Neither waits.
  void ask_if_due();
  // nullopt as long as the vehicle's clock is unknown: at first, and while one of the clocks may have been set.
  std::optional<std::int64_t> to_vehicle(std::int64_t own_ns);

 private:
  using Time = std::chrono::steady_clock::time_point;
  struct Knowledge {
    ClockEstimate clock;
    bool is_certain = false;
  };

  // Called by the thread that receives.
  void take(const messages::msg::ClockReply& reply);
  void log_changes(bool is_known, const ClockEstimate& clock, std::int64_t now_ns);
  void publish_status(bool is_known, const ClockEstimate& clock, std::int64_t now_ns);

  const std::function<std::int64_t()> own_ns_;
  const std::uint64_t id_;
  runtime::LatestValue<Knowledge> latest_;

  // Only the thread that asks uses these.
  Knowledge known_;
  std::atomic<std::uint64_t> requests_sent_{0};  // read by the other thread
  Time due_;

  // Only the thread that receives uses these.
  ClockFilter filter_;
  std::uint64_t last_answered_ = 0;
  bool was_known_ = false;
  int steps_logged_ = 0;
  std::uint64_t statuses_ = 0;
  Time status_due_;

  dds::Publisher<messages::msg::ClockRequest> requests_;
  std::optional<dds::Publisher<messages::msg::ClockStatus>> status_;
  dds::Subscription replies_;  // last: its callback uses all members above
};

}  // namespace swiftlet::clocks
