#include "swiftlet/services/dds/payload.hpp"

#include <type_traits>

#include <gtest/gtest.h>

#include "swiftlet/services/messages/topics.hpp"

namespace swiftlet::dds::payload_test {

constexpr std::size_t kUdpInFrame = 1472;  // bytes of a datagram that one frame of Ethernet holds
// Header of the message, INFO_DST, INFO_TS, header of DATA, and the seal or the statistics of Fast DDS.
constexpr std::size_t kOverhead = 20 + 16 + 12 + 24 + 60;

// A lossy network loses a sample of two fragments more often than one of a single frame. What is reliable is sent again.
TEST(Payload, OfEveryStreamFitsIntoOneFrame) {
  int streams = 0;
  messages::for_each_topic([&](const auto& topic) {
    if (topic.qos != messages::Qos::kStream && topic.qos != messages::Qos::kTelemetry) return;
    ++streams;
    EXPECT_LE(to_payload(typename std::decay_t<decltype(topic)>::Message()).size(), kUdpInFrame - kOverhead)
        << topic.name;
  });
  EXPECT_GT(streams, 10);
}

}  // namespace swiftlet::dds::payload_test
