// The samples of DDS topics in captured traffic.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/support/serialization.hpp"

namespace swiftlet::tests {

struct CapturedSample {
  std::int64_t time_ns = 0;           // of the capture, since 1970
  std::string topic;                  // "rt/fmu/out/vehicle_status_v1"
  std::vector<std::uint8_t> payload;  // CDR, with its encapsulation
};

// From a file of pcap or pcapng, which may be compressed by gzip. Its discovery data gives the topics. In order; a sample that
// was sent to several addresses is there once. Throws ConfigError.
std::vector<CapturedSample> samples_of_capture(const std::string& file);

// Throws std::runtime_error if the sample is no message of this type.
template <class PubSubType>
typename PubSubType::type message_of(const CapturedSample& sample) {
  typename PubSubType::type message;
  PubSubType type;
  if (!deserialize(type, sample.payload.data(), sample.payload.size(), &message))
    throw std::runtime_error(sample.topic + ": no message of this type");
  return message;
}

}  // namespace swiftlet::tests
