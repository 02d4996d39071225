#include "swiftlet/services/dds/membership.hpp"

#include <memory>
#include <mutex>
#include <stdexcept>

#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/log/Log.hpp>
#include <fastdds/dds/log/StdoutErrConsumer.hpp>
#include <fastrtps/xmlparser/XMLProfileManager.h>

#include "swiftlet/services/dds/participant_qos.hpp"
#include "swiftlet/services/dds/shared_memory.hpp"

namespace swiftlet::comms {
namespace {

namespace dds = eprosima::fastdds::dds;
using eprosima::fastrtps::types::ReturnCode_t;

// Once in a process, before its first participant.
void set_up_library() {
  static const bool done = [] {
    dds::Log::ClearConsumers();
    dds::Log::RegisterConsumer(
        std::make_unique<dds::StdoutErrConsumer>());  // to stderr: stdout is the program's own
    dds::Log::SetVerbosity(dds::Log::Kind::Error);
    // Two nodes in one process talk as two processes do: a callback never runs inside the publisher's call.
    auto settings = eprosima::fastrtps::xmlparser::XMLProfileManager::library_settings();
    settings.intraprocess_delivery = eprosima::fastrtps::INTRAPROCESS_OFF;
    eprosima::fastrtps::xmlparser::XMLProfileManager::library_settings(settings);
    return true;
  }();
  static_cast<void>(done);
}

void end(dds::DomainParticipant* participant) {
  participant->set_listener(nullptr);
  participant->delete_contained_entities();
  dds::DomainParticipantFactory::get_instance()->delete_participant(participant);
}

// One at a time: Fast DDS 2.9 asks getpwuid() for the user's name, which keeps it in one place for all
// threads.
dds::DomainParticipant* create_participant(const NodeSettings& settings,
                                           dds::DomainParticipantListener* listener) {
  static std::mutex mutex;
  const std::lock_guard<std::mutex> lock(mutex);
  return dds::DomainParticipantFactory::get_instance()->create_participant(
      static_cast<std::uint32_t>(settings.domain), participant_qos(settings), listener,
      dds::StatusMask::requested_incompatible_qos() << dds::StatusMask::offered_incompatible_qos());
}

}  // namespace

Membership::Membership(const NodeSettings& settings, dds::DomainParticipantListener* listener) {
  set_up_library();
  participant = create_participant(settings, listener);
  if (participant == nullptr) {
    throw std::runtime_error("cannot join DDS domain " + std::to_string(settings.domain) +
                             ": no port could be opened or the transport could not be set up");
  }
  publisher = participant->create_publisher(dds::PUBLISHER_QOS_DEFAULT);
  subscriber = participant->create_subscriber(dds::SUBSCRIBER_QOS_DEFAULT);
  if (publisher == nullptr || subscriber == nullptr) {
    end(participant);
    throw std::runtime_error("cannot set up publishing in DDS domain " + std::to_string(settings.domain));
  }
}

Membership::~Membership() { end(participant); }

void Membership::tell_vehicles(const NodeSettings& settings) {
  dds::DomainParticipantQos qos = participant->get_qos();
  qos.user_data() = participant_qos(settings).user_data();
  participant->set_qos(qos);
}

dds::Topic* Membership::topic(const std::string& wire_name, const dds::TypeSupport& type) {
  dds::Topic*& found = topics_[wire_name];
  if (found == nullptr && participant->register_type(type) == ReturnCode_t::RETCODE_OK)
    found = participant->create_topic(wire_name, type.get_type_name(), dds::TOPIC_QOS_DEFAULT);
  if (found == nullptr) throw std::runtime_error("cannot make DDS topic " + wire_name);
  return found;
}

}  // namespace swiftlet::comms
