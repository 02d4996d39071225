// Section numbers are those of "DDS Interoperability Wire Protocol (DDSI-RTPS)", version 2.5.
#include "swiftlet/services/rtps/reply_check.hpp"

#include <algorithm>
#include <array>

#include "swiftlet/io/byte_reader.hpp"
#include "swiftlet/services/rtps/submessage.hpp"

namespace swiftlet::rtps {
namespace {

using io::ByteReader;

template <std::size_t kSize>
std::array<std::uint8_t, kSize> bytes_of(ByteReader& in) {
  std::array<std::uint8_t, kSize> bytes{};
  if (const std::uint8_t* const taken = in.take(kSize)) std::copy_n(taken, kSize, bytes.begin());
  return bytes;
}

}  // namespace

ReplyCheck::ReplyCheck(std::uint32_t gaps_ahead) : gaps_ahead_(gaps_ahead), acknowledged_(kWriters) {}

bool ReplyCheck::concerns_replies(const std::uint8_t* message, std::size_t size) {
  bool concerns = false;
  for_each_submessage(message, size, [&](std::uint8_t kind, const ByteReader&) {
    concerns = concerns || kind == kAcknack || kind == kDataFrag;
  });
  return concerns;
}

void ReplyCheck::note_sent(const std::uint8_t* message, std::size_t size) {
  GuidPrefix destination{};
  for_each_submessage(message, size, [&](std::uint8_t kind, ByteReader body) {
    if (kind == kInfoDestination) {
      destination = bytes_of<12>(body);
    } else if (kind == kAcknack) {
      body.skip(4);  // the reader
      const auto writer = bytes_of<4>(body);
      body.skip(4);  // the high word of the number
      const std::uint32_t base = body.u32();
      if (body.ok()) acknowledged_[place_of(destination, writer)] = {destination, writer, base};
    } else if (kind == kDataFrag) {
      body.skip(4 + 4);  // flags, place of the inline QoS, and the reader
      const auto writer = bytes_of<4>(body);
      body.skip(4);
      const std::uint32_t number = body.u32();
      body.skip(4 + 2);  // the first fragment, and how many
      const std::uint32_t fragment_bytes = body.u16();
      const std::uint32_t sample_bytes = body.u32();
      if (!body.ok() || fragment_bytes == 0) return;
      auto& samples = fragments_[writer];
      samples[number] = (sample_bytes + fragment_bytes - 1) / fragment_bytes;
      if (samples.size() > kSamplesOfWriter) samples.erase(samples.begin());
    }
  });
}

std::size_t ReplyCheck::place_of(const GuidPrefix& participant, const EntityId& writer) {
  return fnv(writer.data(), writer.size(), fnv(participant.data(), participant.size())) % kWriters;
}

std::uint32_t ReplyCheck::acknowledged(const GuidPrefix& participant, const EntityId& writer) const {
  const Acknowledged& known = acknowledged_[place_of(participant, writer)];
  return known.participant == participant && known.writer == writer ? known.base : 0;
}

const char* ReplyCheck::fault_of(const CheckedDatagram& received) const {
  for (const FragmentRequest& request : received.requests) {
    if (request.destination != GuidPrefix{} && request.destination != own_) continue;
    const auto samples = fragments_.find(request.writer);
    if (samples == fragments_.end()) return "NACK_FRAG of a writer without fragments (8.3.8.12)";
    const auto sample = samples->second.find(request.number);
    if (sample == samples->second.end() || request.last > sample->second)
      return "NACK_FRAG of fragments that were not sent (8.3.8.12)";
  }
  for (const Gap& gap : received.gaps) {
    const std::uint32_t ahead = is_builtin(gap.writer) ? gaps_ahead_ : kGapsAhead;
    if (gap.end > ahead && gap.end - ahead > acknowledged(received.source, gap.writer))
      return "GAP far beyond what was acknowledged (8.3.8.4)";
  }
  return nullptr;
}

}  // namespace swiftlet::rtps
