// What a NatNet server sends, in each layout. Written from the protocol, apart from the parsers.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "swiftlet/io/mocap/natnet.hpp"

namespace swiftlet::tests::natnet {

using Bytes = std::vector<std::uint8_t>;
using mocap::natnet::Version;

struct Body {
  std::string name;
  std::int32_t id = 0;
  float position[3] = {};
  float q_xyzw[4] = {0, 0, 0, 1};
  bool tracked = true;
  int markers = 4;
  int lost_markers = 0;
};

struct Frame {
  std::int32_t number = 1;
  std::uint64_t exposed_ticks = 0;
  std::uint64_t received_ticks = 0;
  std::uint64_t sent_ticks = 0;
  bool models_changed = false;
  bool with_others =
      true;  // marker sets, skeletons, assets, force plates and devices stand beside the bodies
  std::vector<Body> bodies;
};

struct Server {
  std::string application = "Motive";
  Version version{4, 1};
  std::uint64_t clock_hz = 10'000'000;
  std::uint16_t data_port = mocap::natnet::kDataPort;
  bool multicast = false;
};

Bytes server_info(const Server& server);
// bones_with_markers: servers before 4.1 differ in it.
Bytes models(Version version, const std::vector<Body>& bodies, bool with_others = true,
             bool bones_with_markers = false);
Bytes frame(Version version, const Frame& frame);
Bytes echo_response(std::uint64_t request, std::uint64_t received_ticks);

}  // namespace swiftlet::tests::natnet
