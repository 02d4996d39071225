#include "tests/support/px4/capture.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <string_view>
#include <utility>

#include "swiftlet/analysis/logs/compressed_file.hpp"
#include "swiftlet/io/byte_reader.hpp"
#include "swiftlet/io/mocap/capture_file.hpp"
#include "swiftlet/services/rtps/submessage.hpp"

namespace swiftlet::tests {
namespace {

using io::ByteReader;
using Bytes = std::vector<std::uint8_t>;

constexpr std::uint32_t kPublicationsWriter = 0x000003c2;  // of discovery (9.3.1.5)
constexpr std::uint16_t kSentinel = 1, kTopicName = 5, kEndpointGuid = 0x5a;
constexpr std::uint8_t kHasInlineQos = 2;
constexpr std::size_t kPrefixBytes = 12;

Bytes bytes(ByteReader reader) { return {reader.data(), reader.data() + reader.rest()}; }

template <class OnParameter>
void read_parameters(ByteReader& list, const OnParameter& on_parameter) {
  while (list.ok() && list.rest() >= 4) {
    const std::uint16_t id = list.u16();
    const std::uint16_t size = list.u16();
    if (id == kSentinel) return;
    on_parameter(id, list.part(size));
  }
}

class Reader {
 public:
  void take(const mocap::CapturedDatagram& datagram) {
    ByteReader message(datagram.payload.data(), datagram.payload.size(), true);
    if (datagram.payload.size() < rtps::kHeaderBytes || message.u32() != kRtps) return;
    message.skip(4);  // version, vendor
    const std::uint8_t* const prefix = message.take(kPrefixBytes);
    while (message.ok() && message.rest() >= 4) {
      const std::uint8_t kind = message.u8();
      const std::uint8_t flags = message.u8();
      const std::uint16_t stated = message.u16();
      ByteReader body = message.part(stated == 0 ? message.rest() : stated);
      if (kind == rtps::kData && body.ok()) take_data(datagram.time_ns, prefix, flags, body);
    }
  }
  std::vector<CapturedSample> samples;

 private:
  static constexpr std::uint32_t kRtps = 0x53505452;

  void take_data(std::int64_t time_ns, const std::uint8_t* prefix, std::uint8_t flags, ByteReader body) {
    body.skip(2);
    const std::uint16_t to_qos = body.u16();
    ByteReader rest = body;
    rest.skip(to_qos);
    body.skip(4);  // reader
    const std::uint8_t* const writer = body.take(4);
    const std::uint64_t number = body.u64();
    if (writer == nullptr) return;
    Bytes guid(prefix, prefix + kPrefixBytes);
    guid.insert(guid.end(), writer, writer + 4);
    if ((flags & kHasInlineQos) != 0) read_parameters(rest, [](std::uint16_t, ByteReader) {});
    if (!rest.ok()) return;
    const std::uint32_t entity = static_cast<std::uint32_t>(writer[2]) << 8 | writer[3];
    if (entity == kPublicationsWriter) return take_publication(rest);
    const auto topic = topics_.find(guid);
    if (topic == topics_.end() || !taken_.insert({guid, number}).second) return;
    samples.push_back({time_ns, topic->second, bytes(rest)});
  }

  void take_publication(ByteReader payload) {
    payload.skip(4);  // encapsulation
    Bytes guid;
    std::string name;
    read_parameters(payload, [&](std::uint16_t id, ByteReader value) {
      if (id == kEndpointGuid) guid = bytes(value);
      if (id == kTopicName) {
        value.skip(4);
        name = std::string(value.text());
      }
    });
    if (!guid.empty() && !name.empty()) topics_[guid] = name;
  }

  std::map<Bytes, std::string> topics_;
  std::set<std::pair<Bytes, std::uint64_t>> taken_;
};

}  // namespace

std::vector<CapturedSample> samples_of_capture(const std::string& file) {
  Reader reader;
  for (const mocap::CapturedDatagram& datagram : mocap::parse_capture(analysis::read_unpacked(file), file))
    reader.take(datagram);
  return reader.samples;
}

}  // namespace swiftlet::tests
