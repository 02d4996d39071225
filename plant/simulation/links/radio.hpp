// A radio between the vehicle and the computers on the ground: it delays every packet, by a constant time and by jitter,
// and loses some. Packets keep their order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "swiftlet/math/random.hpp"
#include "swiftlet/plant/simulation/links/delay_line.hpp"
#include "swiftlet/plant/simulation/settings.hpp"

namespace swiftlet::plant {

// One direction for one kind of packet: what becomes of each. Other packets do not change its draws.
class RadioLink {
 public:
  // stream: of streams.hpp.
  RadioLink(const RadioSettings& settings, std::uint64_t seed, std::uint64_t stream)
      : settings_(settings), random_(seed, stream) {}

  bool on() const { return settings_.on(); }
  // Call for each packet, sent at now_ns. Returns the time that it takes, ns; nullopt if it is lost. Packets of stamp 0
  // arrive at once: with them the link is established.
  std::optional<std::int64_t> send(std::int64_t now_ns);

 private:
  RadioSettings settings_;
  math::RandomStream random_;
};

// A link and the packets that are on the way.
template <class Packet>
class RadioLine {
 public:
  // Without a radio, packets arrive at once.
  RadioLine(const SimulationSettings& settings, std::uint64_t seed, std::uint64_t stream)
      : link_(settings.radio, seed, stream), packets_(packets_under_way(settings)) {}

  bool on() const { return link_.on(); }
  void send(const Packet& packet, std::int64_t now_ns) {
    const std::optional<std::int64_t> takes_ns = link_.send(now_ns);
    if (takes_ns) packets_.put(packet, now_ns + *takes_ns);
  }
  // The next packet that has arrived by now_ns and was not taken; null if there is none. Valid until the next send().
  const Packet* take(std::int64_t now_ns) { return packets_.take_oldest(now_ns); }

 private:
  // At most one packet for each IMU sample, and those of one sample that wait for each other.
  static std::size_t packets_under_way(const SimulationSettings& settings) {
    const double longest_s = settings.radio.delay_s + settings.radio.jitter_s;
    return static_cast<std::size_t>(longest_s * settings.imu.rate_hz) + 4;
  }

  RadioLink link_;
  DelayLine<Packet> packets_;
};

}  // namespace swiftlet::plant
