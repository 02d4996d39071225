#pragma once

#include <chrono>

#include <fastdds/rtps/common/Time_t.h>

namespace swiftlet::comms {

inline eprosima::fastrtps::Duration_t duration(std::chrono::milliseconds time) {
  return {static_cast<std::int32_t>(time.count() / 1000),
          static_cast<std::uint32_t>(time.count() % 1000 * 1'000'000)};
}

}  // namespace swiftlet::comms
