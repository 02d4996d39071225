#include "swiftlet/services/dds/participant_qos.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

#include "swiftlet/io/config_error.hpp"
#include "swiftlet/io/network/host_address.hpp"
#include "swiftlet/io/network/interfaces.hpp"
#include "swiftlet/services/dds/dds_profile.hpp"
#include "swiftlet/services/dds/discovery/discovery_ports.hpp"
#include "swiftlet/services/dds/fast_dds.hpp"
#include "swiftlet/services/dds/guarded_transport.hpp"
#include "swiftlet/services/dds/qos/duration.hpp"
#include "swiftlet/services/dds/qos/profiles.hpp"
#include "swiftlet/services/dds/security/security_qos.hpp"

namespace swiftlet::dds {

namespace fastdds = eprosima::fastdds::dds;
using eprosima::fastdds::rtps::UDPv4TransportDescriptor;

namespace {

// All first ports of the domain on a host, as its processes take the first that are free there.
void add_host(const std::string& ipv4, const DiscoveryPorts& ports, std::uint32_t count,
              fastrtps::LocatorList_t& peers) {
  for (std::uint32_t i = 0; i < count; ++i) peers.push_back(udp_locator(ipv4, ports.first + i * ports.gap));
}

// Fast DDS 2.9 fails an assertion if a server of this host has another address than that of the loopback interface.
void add_servers(const NodeSettings& settings, fastrtps::DiscoverySettings& discovery) {
  const std::string& list = settings.network.discovery_servers;
  if (const std::string fault = io::fault_of_discovery_servers(list); !fault.empty())
    throw io::ConfigError("discovery server (--discovery-server, ROS_DISCOVERY_SERVER) " + fault);
  // A plain client hears only of those with which it exchanges topics: a source would not hear of another one.
  const bool hears_of_all = settings.hears_of_all || !settings.source_of.empty();
  discovery.discoveryProtocol =
      hears_of_all ? fastrtps::DiscoveryProtocol::SUPER_CLIENT : fastrtps::DiscoveryProtocol::CLIENT;
  for (const io::DiscoveryServerAddress& server : io::parse_discovery_servers(list)) {
    std::vector<fastrtps::Locator_t> addresses;
    for (const std::string& address : io::ipv4_addresses_of(server.address.host)) {
      addresses.push_back(
          udp_locator(io::is_own_address(address) ? io::kLoopback : address, server.address.port));
    }
    add_discovery_server(discovery, server.number, addresses);
  }
}

// A locator with this port for each address at which the node is to be found: those of its interfaces, by default of all that
// are up but the loopback interface, which it has if there is no other. Of this moment: Fast DDS 3 remembers those of the
// first participant of the process.
fastrtps::LocatorList_t own_locators(const NodeSettings& settings, std::uint32_t port) {
  std::vector<std::string> addresses;
  if (!settings.on_loopback()) addresses = io::addresses_of_interfaces(settings.network.interfaces);
  if (!settings.on_loopback() && addresses.empty()) {
    for (const io::Interface& it : io::interfaces_up()) {
      if (!it.is_loopback) addresses.push_back(it.address);
    }
  }
  if (addresses.empty()) addresses.emplace_back(io::kLoopback);
  fastrtps::LocatorList_t locators;
  for (const std::string& address : addresses) locators.push_back(udp_locator(address, port));
  return locators;
}

// Sets the interfaces of the transport, and with peers or servers the addresses of discovery.
void set_network(const NodeSettings& settings, std::uint32_t announced_ports,
                 eprosima::fastdds::dds::DomainParticipantQos& qos,
                 eprosima::fastdds::rtps::UDPv4TransportDescriptor& udp) {
  const NetworkSettings& network = settings.network;
  const std::vector<std::string> own_addresses = io::addresses_of_interfaces(network.interfaces);
  if (!own_addresses.empty()) {
    udp.interfaceWhiteList = own_addresses;
    // The processes of this host reach each other whatever becomes of the interfaces.
    if (std::count(own_addresses.begin(), own_addresses.end(), io::kLoopback) == 0)
      udp.interfaceWhiteList.emplace_back(io::kLoopback);
  }
  if (network.uses_multicast()) return;

  auto& builtin = qos.wire_protocol().builtin;
  const DiscoveryPorts ports = discovery_ports(settings.domain);
  // Instead of the multicast address, only this: the first free port of the domain.
  builtin.metatrafficUnicastLocatorList = own_locators(settings, ports.first);
  if (network.peers.empty()) return add_servers(settings, builtin.discovery_config);
  add_host(io::kLoopback, ports, announced_ports,
           builtin.initialPeersList);  // the processes of this host
  for (const std::string& peer : network.peers) {
    if (const std::string fault = io::fault_of_host_address(peer); !fault.empty())
      throw io::ConfigError("peer (--peer, ROS_STATIC_PEERS) " + fault);
    const io::HostAddress host = io::parse_host_address(peer);
    for (const std::string& address : io::ipv4_addresses_of(host.host)) {
      if (host.port != 0) {
        builtin.initialPeersList.push_back(udp_locator(address, host.port));
      } else {
        add_host(address, ports, announced_ports, builtin.initialPeersList);
      }
    }
  }
}

}  // namespace

fastrtps::Locator_t udp_locator(const std::string& ipv4, std::uint32_t port) {
  fastrtps::Locator_t locator;
  locator.kind = LOCATOR_KIND_UDPv4;
  fastrtps::IPLocator::setIPv4(locator, ipv4);
  locator.port = port;
  return locator;
}

fastdds::DomainParticipantQos participant_qos(const NodeSettings& settings, std::uint32_t announced_ports,
                                              const std::shared_ptr<rtps::DatagramGuard>& guard) {
  const std::string& file = settings.network.dds_profile;
  const DdsProfile profile = file.empty() ? DdsProfile{} : load_dds_profile(file);
  fastdds::DomainParticipantQos qos = profile.participant;
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
  builtin.discovery_config.leaseDuration = duration(messages::kLivelinessLease);
  builtin.discovery_config.leaseDuration_announcementperiod = duration(settings.announcement_period);
  builtin.discovery_config.initial_announcements.count = messages::kFirstAnnouncements;
  builtin.discovery_config.initial_announcements.period = duration(messages::kFirstAnnouncementPeriod);

  // If a port is taken, try the next ones of this domain only.
  const DiscoveryPorts ports = discovery_ports(settings.domain);
  builtin.mutation_tries = ports.count - 1;

  if (kHasFlowControllers) qos.flow_controllers().push_back(long_message_flow());

  // Forged announcements must not fill the memory. When a limit is reached, Fast DDS ignores newcomers.
  qos.allocation().participants = {0, rtps::kMostParticipants, 1};
  // Fast DDS bounds the endpoints of all participants together, at so many for each.
  qos.allocation().readers = {0, rtps::kMostEndpoints / rtps::kMostParticipants, 1};
  qos.allocation().writers = {0, rtps::kMostEndpoints / rtps::kMostParticipants, 1};

  UDPv4TransportDescriptor udp = profile.udp;
  udp.non_blocking_send = true;  // a full socket buffer drops a sample instead of blocking the sender
  if (settings.on_loopback()) {
    udp.interfaceWhiteList = {io::kLoopback};
    udp.maxInitialPeersRange = announced_ports;
    // Listen on the first free port of the domain, whatever ID the middleware assigns to the participant, and
    // on no multicast address. For the peers (port 0) the middleware tries maxInitialPeersRange ports.
    builtin.metatrafficUnicastLocatorList.push_back(udp_locator(io::kLoopback, ports.first));
    builtin.initialPeersList.push_back(udp_locator(io::kLoopback, 0));
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

}  // namespace swiftlet::dds
