// Authenticates datagrams with a shared key: a trailer that the sender appends and the receiver checks before anything is
// parsed. It is a vendor-specific submessage, which programs of others skip (RTPS 2.5, 8.3.4.1).
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "swiftlet/io/network_key.hpp"
#include "swiftlet/services/rtps/rtps_ids.hpp"

namespace swiftlet::rtps {

// The size of the trailer. It replaces the statistics submessage of Fast DDS, which has the same size: the datagram does not
// grow.
constexpr std::size_t kSealBytes = 60;
// How much the clocks of two hosts may differ. A process that never heard a participant accepts a recording of it for this
// long.
constexpr std::int64_t kSealTolerance_ns = 30'000'000'000;

// A datagram may come after so many others that its sender sealed later, for whomever: those of 16 vehicles at 500 Hz in 0.1 s.
constexpr std::uint64_t kSealWindow = 2048;

// Fast DDS sends a datagram to each address of a host with several networks: no fault, but of no use either.
inline constexpr char kSentTwice[] = "sent to several addresses of this host";

// Appends trailers. Thread-safe.
class DatagramSealer {
 public:
  explicit DatagramSealer(const io::NetworkKeys& keys);

  // Appends the trailer to a datagram without one. now_ns: since 1970.
  void seal(std::vector<std::uint8_t>& datagram, std::int64_t now_ns);

 private:
  const io::NetworkKey key_;
  const std::uint32_t key_id_;
  std::atomic<std::uint64_t> count_;
};

// Checks trailers. Allocates only when constructed.
class DatagramOpener {
 public:
  explicit DatagramOpener(const io::NetworkKeys& keys);

  // Each returns the broken rule as a string literal, nullptr if there is none; the datagram is then kSealBytes shorter.

  // Whether the trailer is valid. Thread-safe. now_ns: since 1970.
  const char* verify(const std::uint8_t* data, std::size_t size, std::int64_t now_ns) const;
  // Whether a datagram with a valid trailer is taken for the first time: once on each port. port is the local one, because a
  // participant may receive it on several. Not thread-safe. steady_ns: of a monotonic clock.
  const char* take(const std::uint8_t* data, std::size_t size, std::uint32_t port, std::int64_t steady_ns);

 private:
  struct Key {
    io::NetworkKey secret;
    std::uint32_t id;
  };
  // What was received from a participant on a port.
  struct Sender {
    GuidPrefix participant{};
    std::uint32_t port = 0;
    std::int64_t heard_ns = 0;                               // of the monotonic clock
    std::int64_t sent_ns = 0;                                // when the newest was sealed
    std::uint64_t newest = 0;                                // count
    std::array<std::uint64_t, kSealWindow / 64> received{};  // a bit for each of the counts up to the newest
    // Returns the broken rule, or nullptr.
    const char* take(std::uint64_t count, std::int64_t sealed_ns);
  };
  static constexpr std::size_t kSenders = 2048;  // a power of two
  static constexpr std::size_t kPlaces = 8;

  Sender& sender(const std::uint8_t* participant, std::uint32_t port);

  std::vector<Key> keys_;
  std::vector<Sender> senders_;
};

}  // namespace swiftlet::rtps
