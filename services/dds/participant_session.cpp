#include "swiftlet/services/dds/participant_session.hpp"

#include <memory>
#include <mutex>
#include <set>
#include <stdexcept>

#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/log/Log.hpp>
#include <fastdds/dds/log/StdoutErrConsumer.hpp>
#include <fastrtps/xmlparser/XMLProfileManager.h>

#include "swiftlet/services/dds/discovery/discovery_ports.hpp"
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

dds::DomainParticipant* create_participant(const NodeSettings& settings,
                                           dds::DomainParticipantListener* listener,
                                           std::uint32_t announced) {
  return dds::DomainParticipantFactory::get_instance()->create_participant(
      static_cast<std::uint32_t>(settings.domain), participant_qos(settings, announced), listener,
      dds::StatusMask::requested_incompatible_qos() << dds::StatusMask::offered_incompatible_qos());
}

// One at a time: Fast DDS 2.9 asks getpwuid() for the user's name, which keeps it in one place for all
// threads. Nor does it say at which port it listens, or that it found none.
dds::DomainParticipant* join(const NodeSettings& settings, dds::DomainParticipantListener* listener) {
  static std::mutex mutex;
  const std::lock_guard<std::mutex> lock(mutex);
  const DiscoveryPorts ports = discovery_ports(settings.domain);
  const std::set<std::uint32_t> before = own_discovery_ports(settings.domain);
  const std::uint32_t expected = free_discovery_port(settings.domain, settings.localhost_only);
  for (const std::uint32_t announced : {announced_ports(ports, expected), ports.count}) {
    dds::DomainParticipant* const participant = create_participant(settings, listener, announced);
    if (participant == nullptr) return nullptr;
    // Others that start now may have taken so many ports meanwhile that it does not call all below its own.
    for (const std::uint32_t port : own_discovery_ports(settings.domain)) {
      if (before.count(port) == 0 && (port < announced || !settings.localhost_only)) return participant;
    }
    end(participant);
  }
  throw domain_is_full(settings.domain);
}

}  // namespace

ParticipantSession::ParticipantSession(const NodeSettings& settings,
                                       dds::DomainParticipantListener* listener) {
  set_up_library();
  participant = join(settings, listener);
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

ParticipantSession::~ParticipantSession() { end(participant); }

void ParticipantSession::announce_vehicles(const NodeSettings& settings) {
  dds::DomainParticipantQos qos = participant->get_qos();
  qos.user_data().data_vec(user_data(settings.vehicle));
  participant->set_qos(qos);
}

dds::Topic* ParticipantSession::topic(const std::string& wire_name, const dds::TypeSupport& type) {
  dds::Topic*& found = topics_[wire_name];
  if (found == nullptr && participant->register_type(type) == ReturnCode_t::RETCODE_OK)
    found = participant->create_topic(wire_name, type.get_type_name(), dds::TOPIC_QOS_DEFAULT);
  if (found == nullptr) throw std::runtime_error("cannot make DDS topic " + wire_name);
  return found;
}

}  // namespace swiftlet::comms
