// Checks a received RTPS datagram before the middleware parses it. Fast DDS trusts lengths, counts and numbers of a
// datagram in many places, where it then asserts, allocates without bound or reads beyond the end.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <boost/container/static_vector.hpp>

#include "swiftlet/services/rtps/parameter_list.hpp"
#include "swiftlet/services/rtps/rtps_ids.hpp"

namespace swiftlet::rtps {

// A discovery server skips all announcements that do not concern a client.
constexpr std::uint32_t kLongestBuiltinGap = 65'536;

struct DatagramLimits {
  // With DDS Security every message is encrypted, but for announcements and handshakes. Fast DDS takes others for genuine.
  bool security = false;
  // Discovery servers announce other participants than themselves.
  bool discovery_servers = false;
  std::uint32_t largest_sample_bytes = 1 << 20;  // of a sample sent in fragments
};

// Samples of a writer that are irrelevant to a reader.
struct Gap {
  EntityId writer{};
  std::uint32_t end = 0;  // the highest number
};

// Fragments of a sample that a NACK_FRAG asks for.
struct FragmentRequest {
  GuidPrefix destination{};  // of the writer; all zeros: none is named
  EntityId writer{};
  std::uint32_t number = 0;  // of the sample
  std::uint32_t last = 0;    // fragment
};

// The result of a check. Allocates nothing.
struct CheckedDatagram {
  // The broken rule with its section of the RTPS 2.5 specification, a string literal; nullptr if there is none. Only
  // then the rest is valid.
  const char* fault = nullptr;
  GuidPrefix source{};
  // Bytes to hand to the middleware: less than received if the datagram ends with a submessage that it must not see.
  std::size_t length = 0;
  bool announces_itself = false;  // holds an announcement of its source
  Announced announced;            // in that announcement; in the datagram that was checked
  bool handshake = false;         // holds a message of the handshake of DDS Security
  // An announcement of a participant that this process ignores.
  bool is_ignored = false;

  boost::container::static_vector<Gap, 32> gaps;
  boost::container::static_vector<FragmentRequest, 8> requests;
  bool fragment = false;  // holds a DATA_FRAG
  PlacesToChange places;  // see hide_parameters() and name_source()
};

// Checks the header, the submessages with their elements, and the parameter lists of discovery.
CheckedDatagram check_datagram(const std::uint8_t* data, std::size_t size, const DatagramLimits& limits);

// Removes the statistics submessage that Fast DDS appends to a message that it sends.
void remove_statistics(std::vector<std::uint8_t>& message);

// Turns the hidden parameters into padding, which receivers skip (9.6.3.2). copy: of the datagram that was checked.
void hide_parameters(const CheckedDatagram& checked, std::uint8_t* copy);

// Puts the address from which the datagram came in place of those of the loopback interface: a process that joined while its host
// had no network announces no other. copy: of the datagram that was checked.
void name_source(const CheckedDatagram& checked, Ipv4 address, std::uint8_t* copy);

}  // namespace swiftlet::rtps
