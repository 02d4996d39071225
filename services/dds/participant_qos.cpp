#include "swiftlet/services/dds/participant_qos.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "swiftlet/services/dds/datagram/guarded_transport.hpp"
#include "swiftlet/services/dds/dds_profile.hpp"
#include "swiftlet/services/dds/discovery/discovery_ports.hpp"
#include "swiftlet/services/dds/fast_dds.hpp"
#include "swiftlet/services/dds/network_qos.hpp"
#include "swiftlet/services/dds/qos/duration.hpp"
#include "swiftlet/services/dds/qos/profiles.hpp"
#include "swiftlet/services/dds/security/security_qos.hpp"

namespace swiftlet::comms {

namespace dds = eprosima::fastdds::dds;
using eprosima::fastdds::rtps::UDPv4TransportDescriptor;

dds::DomainParticipantQos participant_qos(const NodeSettings& settings, std::uint32_t announced_ports,
                                          const std::shared_ptr<DatagramGuard>& guard) {
  const std::string& file = settings.network.dds_profile;
  const DdsProfile profile = file.empty() ? DdsProfile{} : load_dds_profile(file);
  dds::DomainParticipantQos qos = profile.participant;
  qos.name(settings.name);
  // Writers tell the readers of other participants from their own by their number: all of these match.
  auto& properties = qos.properties().properties();
  properties.erase(
      std::remove_if(properties.begin(), properties.end(),
                     [](const auto& one) { return one.name() == "fastdds.ignore_local_endpoints"; }),
      properties.end());
  if (!settings.security.empty()) {
    if (!settings.network.discovery_servers.empty())
      throw std::invalid_argument(
          "--security and --discovery-server exclude each other: a discovery server of Fast DDS 2.9 has no "
          "security");
    set_security(settings.security, settings.name, qos);
  }

  auto& builtin = qos.wire_protocol().builtin;
  builtin.discovery_config.leaseDuration = duration(kLivelinessLease);
  builtin.discovery_config.leaseDuration_announcementperiod = duration(settings.announcement_period);
  builtin.discovery_config.initial_announcements.count = kFirstAnnouncements;
  builtin.discovery_config.initial_announcements.period = duration(kFirstAnnouncementPeriod);

  // If a port is taken, try the next ones of this domain only.
  const DiscoveryPorts ports = discovery_ports(settings.domain);
  builtin.mutation_tries = ports.count - 1;

  if (kHasFlowControllers) qos.flow_controllers().push_back(long_message_flow());

  // Forged announcements must not fill the memory. When a limit is reached, Fast DDS ignores newcomers.
  qos.allocation().participants = {0, kMostParticipants, 1};
  // Fast DDS bounds the endpoints of all participants together, at so many for each.
  qos.allocation().readers = {0, kMostEndpoints / kMostParticipants, 1};
  qos.allocation().writers = {0, kMostEndpoints / kMostParticipants, 1};

  UDPv4TransportDescriptor udp = profile.udp;
  udp.non_blocking_send = true;  // a full socket buffer drops a sample instead of blocking the sender
  if (settings.on_loopback()) {
    udp.interfaceWhiteList = {runtime::kLoopback};
    udp.maxInitialPeersRange = announced_ports;
    // Listen on the first free port of the domain, whatever ID the middleware assigns to the participant, and
    // on no multicast address. For the peers (port 0) the middleware tries maxInitialPeersRange ports.
    builtin.metatrafficUnicastLocatorList.push_back(udp_locator(runtime::kLoopback, ports.first));
    builtin.initialPeersList.push_back(udp_locator(runtime::kLoopback, 0));
  } else {
    set_network(settings, announced_ports, qos, udp);
  }
  // Samples are received on one port, the first free one after the discovery port. If it is left to Fast DDS, the port of the
  // first process of the host is announced from the first change of the user data on: by 2.9 as a further one, by 3.1 in
  // place of the own one, and the others send there.
  auto& addresses = qos.wire_protocol().default_unicast_locator_list;
  if (addresses.empty()) addresses = own_locators(settings, 0);
  qos.transport().use_builtin_transports = false;
  qos.transport().user_transports.push_back(guarded(udp, guard, settings.domain));
  return qos;
}

}  // namespace swiftlet::comms
