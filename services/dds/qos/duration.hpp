#pragma once

#include <chrono>

#include <fastdds/dds/core/policy/QosPolicies.hpp>

namespace swiftlet::dds {

using Duration = decltype(eprosima::fastdds::dds::DeadlineQosPolicy::period);

inline Duration duration(std::chrono::milliseconds time) {
  return {static_cast<std::int32_t>(time.count() / 1000),
          static_cast<std::uint32_t>(time.count() % 1000 * 1'000'000)};
}

}  // namespace swiftlet::dds
