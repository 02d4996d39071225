#include "swiftlet/services/dds/fast_dds_library.hpp"

#include <atomic>
#include <cstdlib>
#include <memory>

#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/log/Log.hpp>
#include <fastdds/dds/log/StdoutErrConsumer.hpp>

#include "swiftlet/services/dds/fast_dds.hpp"

namespace swiftlet::comms {

namespace dds = eprosima::fastdds::dds;

namespace {

std::atomic<FastDdsWarningListener> warning_listener{nullptr};

class Consumer final : public dds::StdoutErrConsumer {
 public:
  void Consume(const dds::Log::Entry& entry) override {
    if (entry.kind == dds::Log::Kind::Error) return StdoutErrConsumer::Consume(entry);
    if (const FastDdsWarningListener listener = warning_listener)
      listener(entry.context.category, entry.message);
  }
};

}  // namespace

void log_fast_dds() {
  dds::Log::ClearConsumers();
  dds::Log::RegisterConsumer(std::make_unique<Consumer>());
}

void hear_fast_dds_warnings(FastDdsWarningListener listener) {
  set_up_fast_dds();
  warning_listener = listener;
  dds::Log::SetVerbosity(dds::Log::Kind::Warning);
}

void set_up_fast_dds() {
  static const bool done = [] {
    log_fast_dds();
    dds::Log::SetVerbosity(dds::Log::Kind::Error);
    // Otherwise Fast DDS makes a client of a server of each participant that uses multicast, peers or the loopback
    // interface. The options have read the variable.
    unsetenv("ROS_DISCOVERY_SERVER");
    // The default files of Fast DDS, so that what follows holds also if they say otherwise.
    dds::DomainParticipantFactory::get_instance()->load_profiles();
    // Two nodes in one process communicate as two processes do: publish() never runs a callback.
    switch_off_intraprocess_delivery();
    return true;
  }();
  static_cast<void>(done);
}

}  // namespace swiftlet::comms
