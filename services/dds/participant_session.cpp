#include "swiftlet/services/dds/participant_session.hpp"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <mutex>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "swiftlet/io/network/interfaces.hpp"
#include "swiftlet/services/dds/discovery/discovery_ports.hpp"
#include "swiftlet/services/dds/fast_dds.hpp"
#include "swiftlet/services/dds/fast_dds_library.hpp"
#include "swiftlet/services/dds/participant_qos.hpp"
#include "swiftlet/services/runtime/log.hpp"

namespace swiftlet::dds {
namespace {

namespace fastdds = eprosima::fastdds::dds;

// The numbers of this process's participants, each below that of the domain's ports. Left to itself, Fast DDS 2.9 counts them up
// for as long as the process runs and rejoins, computes a port from each, also if it is given another, and ends the process
// when that is above 65535. A number is part of the GUID: it is taken again only after all others were. One with which Fast DDS
// could not create a participant stays taken there; -1, when all are: it counts then.
class ParticipantNumbers {
 public:
  std::int32_t take(int domain) {
    const std::lock_guard<std::mutex> lock(mutex_);
    const std::uint32_t count = discovery_ports(domain).count;
    if (taken_.size() >= count) return -1;
    do {
      last_ = (last_ + 1) % static_cast<std::int32_t>(count);
    } while (!taken_.insert(last_).second);
    return last_;
  }
  void give_back(std::int32_t number) {
    const std::lock_guard<std::mutex> lock(mutex_);
    taken_.erase(number);
  }

 private:
  std::mutex mutex_;
  std::int32_t last_ = -1;
  std::set<std::int32_t> taken_;
};

ParticipantNumbers& numbers() {
  static ParticipantNumbers numbers;
  return numbers;
}

void end(fastdds::DomainParticipant* participant) {
  const std::int32_t number = participant->get_qos().wire_protocol().participant_id;
  participant->set_listener(nullptr);
  participant->delete_contained_entities();
  fastdds::DomainParticipantFactory::get_instance()->delete_participant(participant);
  numbers().give_back(number);
}

fastdds::DomainParticipant* create_participant(const NodeSettings& settings,
                                               const rtps::Announcement& announcement,
                                               const std::shared_ptr<rtps::DatagramGuard>& guard,
                                               fastdds::DomainParticipantListener* listener,
                                               std::uint32_t announced) {
  fastdds::DomainParticipantQos qos = participant_qos(settings, announced, guard);
  qos.user_data().data_vec(rtps::to_user_data(announcement));
  const std::int32_t number = numbers().take(settings.domain);
  qos.wire_protocol().participant_id = number;
  guard->listen(false);
  auto* const participant = fastdds::DomainParticipantFactory::get_instance()->create_participant(
      static_cast<std::uint32_t>(settings.domain), qos, listener,
      fastdds::StatusMask::requested_incompatible_qos() << fastdds::StatusMask::offered_incompatible_qos());
  guard->listen(true);
  return participant;
}

// Empty: all addresses of this host.
std::string listening_address(const NodeSettings& settings) {
  if (settings.on_loopback()) return io::addresses_of_interfaces({io::kLoopback}).front();
  const std::vector<std::string> addresses = io::addresses_of_interfaces(settings.network.interfaces);
  return addresses.empty() ? "" : addresses.front();
}

// Serialized by a mutex, because Fast DDS 2.9 calls getpwuid(), which is not thread-safe. Fast DDS reports neither the port at
// which it listens nor that it found none: the transport does, to the guard.
fastdds::DomainParticipant* join(const NodeSettings& settings, const rtps::Announcement& announcement,
                                 const std::shared_ptr<rtps::DatagramGuard>& guard,
                                 fastdds::DomainParticipantListener* listener) {
  static std::mutex mutex;
  const std::lock_guard<std::mutex> lock(mutex);
  const DiscoveryPorts ports = discovery_ports(settings.domain);
  const std::uint32_t expected = free_discovery_port(settings.domain, listening_address(settings));
  guard->expect_participants(expected + 1, rtps::Now::read());  // as ports are taken in their order
  const bool announces_to_ports = settings.on_loopback() || !settings.network.peers.empty();
  for (const std::uint32_t announced : {announced_ports(ports, expected), ports.count}) {
    guard->set_discovery_port(0);
    fastdds::DomainParticipant* const participant =
        create_participant(settings, announcement, guard, listener, announced);
    if (participant == nullptr) return nullptr;
    // Other processes may have taken ports meanwhile. If the own port is then too high to announce itself to
    // all ports below it, try again with all ports.
    const auto own = ports.index_of(guard->discovery_port());
    if (own && (*own < announced || !announces_to_ports)) return participant;
    end(participant);
  }
  throw domain_is_full(settings.domain);
}

}  // namespace

rtps::GuidPrefix bytes_of(const fastrtps::GuidPrefix_t& participant) {
  rtps::GuidPrefix bytes;
  std::copy_n(participant.value, bytes.size(), bytes.begin());
  return bytes;
}

std::shared_ptr<rtps::DatagramGuard> guard_of(const NodeSettings& settings) {
  return std::make_shared<rtps::DatagramGuard>(
      settings.network_key_file, !settings.network.discovery_servers.empty(), !settings.security.empty());
}

ParticipantSession::ParticipantSession(const NodeSettings& settings, const rtps::Announcement& announcement,
                                       const std::shared_ptr<rtps::DatagramGuard>& guard,
                                       fastdds::DomainParticipantListener* listener)
    : guard_(guard),
      spacing_(settings.network.discovery_servers.empty() ? std::chrono::milliseconds(0)
                                                          : kAnnouncementSpacing) {
  set_up_fast_dds(!settings.security.empty());
  guard->set_participant({});  // of a session before
  participant = join(settings, announcement, guard, listener);
  if (participant == nullptr) {
    throw std::runtime_error("cannot join DDS domain " + std::to_string(settings.domain) +
                             ": no port could be opened or the transport could not be set up");
  }
  guard->set_participant(bytes_of(participant->guid().guidPrefix));
  // Fast DDS 3 remembers the addresses of the host from the first participant of the process on; this lets it read them again.
  set_qos(participant->get_qos());
  publisher = participant->create_publisher(fastdds::PUBLISHER_QOS_DEFAULT);
  subscriber = participant->create_subscriber(fastdds::SUBSCRIBER_QOS_DEFAULT);
  if (publisher == nullptr || subscriber == nullptr) {
    end(participant);
    throw std::runtime_error("cannot set up publishing in DDS domain " + std::to_string(settings.domain));
  }
  next_announcement_ = std::chrono::steady_clock::now() + spacing_;  // after the first one
}

ParticipantSession::~ParticipantSession() { end(participant); }

void ParticipantSession::announce(const rtps::Announcement& announcement) {
  fastdds::DomainParticipantQos qos = participant->get_qos();
  qos.user_data().data_vec(rtps::to_user_data(announcement));
  set_qos(qos);
  next_announcement_ = std::chrono::steady_clock::now() + spacing_;
}

void ParticipantSession::set_qos(const fastdds::DomainParticipantQos& qos) {
  const std::lock_guard<std::mutex> lock(guard_->turn_mutex());
  if (!succeeded(participant->set_qos(qos)))
    runtime::log_error("the middleware refuses to announce a change of this process to the others");
}

fastdds::Topic* ParticipantSession::topic(const std::string& wire_name, const fastdds::TypeSupport& type) {
  fastdds::Topic*& found = topics_[wire_name];
  if (found == nullptr && succeeded(participant->register_type(type)))
    found = participant->create_topic(wire_name, type.get_type_name(), fastdds::TOPIC_QOS_DEFAULT);
  if (found == nullptr) throw std::runtime_error("cannot create DDS topic " + wire_name);
  return found;
}

// kShared: the socket of the participant. kOwn: a further one. The first reader of any other delivery opens one, which Fast DDS keeps until the
// participant ends; those that follow name its addresses.
void ParticipantSession::receive_in(Delivery delivery, fastdds::DataReaderQos& qos) const {
  if (delivery == Delivery::kShared) return;
  const fastrtps::LocatorList_t& opened = receivers_[static_cast<std::size_t>(delivery)];
  if (opened.empty()) {
    qos.properties().properties().emplace_back("fastdds.unique_network_flows", "");
  } else {
    for (const fastrtps::Locator_t& address : opened) qos.endpoint().unicast_locator_list.push_back(address);
  }
}

void ParticipantSession::note_receiver(Delivery delivery, const fastdds::DataReader& reader) {
  fastrtps::LocatorList_t& opened = receivers_[static_cast<std::size_t>(delivery)];
  if (delivery == Delivery::kShared || delivery == Delivery::kOwn || !opened.empty()) return;
  eprosima::fastdds::rtps::LocatorList addresses;
  if (!succeeded(reader.get_listening_locators(addresses))) return;
  for (const fastrtps::Locator_t& address : addresses) opened.push_back(address);
}

}  // namespace swiftlet::dds
