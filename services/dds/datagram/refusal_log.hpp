// Counts refused datagrams by sender, and logs them at a limited rate.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <mutex>

namespace swiftlet::comms {

// Of a host: an IPv4 or IPv6 address as in a locator.
using SenderAddress = std::array<std::uint8_t, 16>;
// The part of it that is an IPv4 address: 127.0.0.1 is 0x7f000001.
inline std::uint32_t ipv4_of(const SenderAddress& address) {
  std::uint32_t ipv4 = 0;
  for (std::size_t i = 12; i < address.size(); ++i) ipv4 = ipv4 << 8U | address[i];
  return ipv4;
}

// The shortest time between two log lines about a sender.
constexpr std::chrono::seconds kRefusalLogPeriod{10};

// Thread-safe.
class RefusalLog {
 public:
  // Called by the threads that receive. Neither waits nor logs; a call that meets another one counts the datagram for no
  // sender. rule: a string literal.
  void note(const SenderAddress& sender, const char* rule);
  // Logs what is due. Called by a thread that may wait.
  void write_due(std::chrono::steady_clock::time_point now);
  std::uint64_t total() const { return total_; }

 private:
  struct Sender {
    SenderAddress address{};
    std::uint64_t refused = 0;  // since the last line
    const char* last_rule = nullptr;
    std::chrono::steady_clock::time_point next_line{};
  };
  static constexpr std::size_t kSenders =
      16;  // that are not silent for long; further ones share the last entry

  std::mutex mutex_;
  std::array<Sender, kSenders> senders_{};
  std::atomic<std::uint64_t> total_{0};
};

}  // namespace swiftlet::comms
