#include "swiftlet/services/dds/fast_dds_library.hpp"

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <string_view>

#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/log/Log.hpp>
#include <fmt/core.h>

#include "swiftlet/services/dds/fast_dds.hpp"
#include "swiftlet/services/runtime/token_bucket.hpp"

namespace swiftlet::dds {

namespace fastdds = eprosima::fastdds::dds;

namespace {

// Called by the thread of Fast DDS's log, which outlives the log of the process: it writes lines of the same form itself.
class Consumer final : public fastdds::LogConsumer {
 public:
  void Consume(const fastdds::Log::Entry& entry) override {
    const bool is_error = entry.kind == fastdds::Log::Kind::Error;
    if (!is_error && !is_told(entry)) return;
    const std::string time = entry.timestamp.substr(entry.timestamp.find(' ') + 1);
    fmt::print(stderr, "{} fastdds {}: {}: {}\n", time, is_error ? "error" : "warning",
               entry.context.category, entry.message);
  }

 private:
  bool is_told(const fastdds::Log::Entry& warning) {
    const auto now = std::chrono::steady_clock::now().time_since_epoch() / std::chrono::nanoseconds(1);
    return std::string_view(warning.context.category) == "SECURITY_AUTHENTICATION" && warnings_.take(now);
  }

  runtime::TokenBucket warnings_{16.0, 1.6};
};

}  // namespace

void set_up_fast_dds(bool tells_refusals) {
  static const bool done = [] {
    fastdds::Log::ClearConsumers();
    fastdds::Log::RegisterConsumer(std::make_unique<Consumer>());
    fastdds::Log::SetVerbosity(fastdds::Log::Kind::Error);
    // Otherwise Fast DDS makes a client of a server of each participant that uses multicast, peers or the loopback
    // interface. The options have read the variable.
    unsetenv("ROS_DISCOVERY_SERVER");
    // The default files of Fast DDS, so that what follows holds also if they say otherwise.
    fastdds::DomainParticipantFactory::get_instance()->load_profiles();
    // Two nodes in one process communicate as two processes do: publish() never runs a callback.
    switch_off_intraprocess_delivery();
    return true;
  }();
  static_cast<void>(done);
  if (tells_refusals) fastdds::Log::SetVerbosity(fastdds::Log::Kind::Warning);
}

}  // namespace swiftlet::dds
