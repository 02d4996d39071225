// Fuzzes the search for MAVLink frames.
#include <algorithm>

#include "swiftlet/io/mavlink/frame.hpp"
#include "swiftlet/io/mavlink/frame_parser.hpp"
#include "swiftlet/io/mavlink/messages.hpp"
#include "tests/fuzz/refusal.hpp"

using namespace swiftlet;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  mavlink::FrameParser parser;
  std::size_t frames = 0;
  parser.feed(data, size, [&](const mavlink::Frame& frame) {
    ++frames;
    const auto extra = mavlink::crc_extra_of(frame.message_id);
    tests::demand(extra.has_value(), "only known messages are frames");
    tests::demand(std::all_of(frame.payload.begin() + frame.length, frame.payload.end(),
                              [](std::uint8_t byte) { return byte == 0; }),
                  "what a payload does not have is 0");
    const mavlink::FrameBytes again = mavlink::encode(frame, *extra);
    mavlink::FrameParser second;
    std::size_t found = 0;
    second.feed(again.data.data(), again.size, [&](const mavlink::Frame& copy) {
      ++found;
      tests::demand(copy.payload == frame.payload && copy.message_id == frame.message_id,
                    "an encoded frame is read as it was");
    });
    tests::demand(found == 1, "an encoded frame is read once");
  });
  const mavlink::FrameParser::Counts& counts = parser.counts();
  tests::demand(counts.frames == frames, "each frame is counted");
  tests::demand(counts.skipped + counts.unknown + counts.frames <= size, "no byte counts twice");
  return 0;
}
