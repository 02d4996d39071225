// Counts refused datagrams by sender, and logs them at a limited rate.
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <vector>

#include <boost/container/static_vector.hpp>

#include "swiftlet/io/network/host_address.hpp"

namespace swiftlet::rtps {

// The shortest time between two log lines about a sender.
constexpr std::chrono::seconds kRefusalLogPeriod{10};

// Thread-safe.
class RefusalLog {
 public:
  // Called by the threads that receive. Neither waits nor logs; a call that meets another one counts the datagram for no
  // sender. rule: a string literal.
  void note(io::Ipv4 sender, const char* rule);
  // Logs what is due. Called by a thread that may wait.
  void write_due(std::chrono::steady_clock::time_point now);
  struct Refusal {
    io::Ipv4 sender = 0;  // 0: several
    const char* rule = nullptr;
  };
  // The last one of each sender, unless it has been silent for kRefusalLogPeriod or longer.
  std::vector<Refusal> last() const;
  std::uint64_t total() const { return total_; }

 private:
  struct Sender {
    io::Ipv4 address = 0;       // 0: those that came when the list was full
    std::uint64_t refused = 0;  // since the last line
    const char* last_rule = nullptr;
    std::chrono::steady_clock::time_point next_line{};
  };
  static constexpr std::size_t kSenders = 16;  // that are not silent for long

  mutable std::mutex mutex_;
  boost::container::static_vector<Sender, kSenders> senders_;
  std::atomic<std::uint64_t> total_{0};
};

}  // namespace swiftlet::rtps
