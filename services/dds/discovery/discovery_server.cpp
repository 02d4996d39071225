#include "swiftlet/services/dds/discovery/discovery_server.hpp"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <map>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include "swiftlet/io/config_error.hpp"
#include "swiftlet/io/network/interfaces.hpp"
#include "swiftlet/services/dds/discovery/discovery_ports.hpp"
#include "swiftlet/services/dds/fast_dds.hpp"
#include "swiftlet/services/dds/fast_dds_library.hpp"
#include "swiftlet/services/dds/guarded_transport.hpp"
#include "swiftlet/services/dds/node.hpp"
#include "swiftlet/services/dds/participant_qos.hpp"
#include "swiftlet/services/dds/periodic_task.hpp"
#include "swiftlet/services/dds/qos/duration.hpp"
#include "swiftlet/services/rtps/announcement.hpp"
#include "swiftlet/services/rtps/datagram_guard.hpp"

namespace swiftlet::dds {
namespace {

namespace fastdds = eprosima::fastdds::dds;
using eprosima::fastdds::rtps::UDPv4TransportDescriptor;

constexpr const char* kName = "discovery-server";
constexpr std::chrono::milliseconds kLogPeriod{250};
constexpr int kPortLooks = 10;  // until a port counts as taken
constexpr std::chrono::milliseconds kPortPeriod{50};

// Fast DDS does not say why it fails. A server that was killed with its parent gives the port back a moment later.
void require_free(int port) {
  int error = 0;
  for (int look = 0; look < kPortLooks; ++look, std::this_thread::sleep_for(kPortPeriod)) {
    error = error_of_binding(static_cast<std::uint32_t>(port), "");
    if (error == 0) return;
  }
  throw std::runtime_error("cannot listen on UDP port " + std::to_string(port) + ": " + std::strerror(error));
}

fastdds::DomainParticipantQos server_qos(const DiscoveryServerSettings& settings,
                                         const std::shared_ptr<rtps::DatagramGuard>& guard) {
  fastdds::DomainParticipantQos qos;
  qos.name(kName);
  auto& protocol = qos.wire_protocol();
  // The processes know the server by this prefix, that of ROS 2.
  eprosima::fastdds::rtps::get_server_client_default_guidPrefix(settings.number, protocol.prefix);
  protocol.builtin.discovery_config.discoveryProtocol = fastrtps::DiscoveryProtocol::SERVER;
  protocol.builtin.discovery_config.leaseDuration = duration(messages::kLivelinessLease);
  protocol.builtin.discovery_config.leaseDuration_announcementperiod = duration(messages::kLivelinessPeriod);
  // Fast DDS 3.1 takes the port for taken if it listens on all addresses of a host that is in no network.
  const std::vector<io::Interface> interfaces = io::interfaces_up();
  const bool in_a_network =
      !settings.on_loopback() && std::any_of(interfaces.begin(), interfaces.end(),
                                             [](const io::Interface& it) { return !it.is_loopback; });
  protocol.builtin.metatrafficUnicastLocatorList.push_back(
      udp_locator(in_a_network ? kAnyAddress : io::kLoopback, static_cast<std::uint32_t>(settings.port)));
  UDPv4TransportDescriptor udp;
  udp.interfaceWhiteList = io::addresses_of_interfaces(settings.interfaces);
  if (!settings.interfaces.empty() || !in_a_network)
    udp.interfaceWhiteList.emplace_back(io::kLoopback);  // for clients of this host
  qos.transport().use_builtin_transports = false;
  qos.transport().user_transports.push_back(guarded(udp, guard, std::nullopt));
  qos.allocation().participants = {0, rtps::kMostParticipants, 1};
  return qos;
}

}  // namespace

struct DiscoveryServer::Impl final : public DiscoveryListener {
  Impl(const DiscoveryServerSettings& settings, std::function<void(const DiscoveryServerEvent&)> event)
      : guard(std::make_shared<rtps::DatagramGuard>(settings.network_key_file, true, false)),
        on_event(std::move(event)) {}

  void on_participant(const fastrtps::GUID_t& guid, const std::string& name,
                      const std::vector<std::uint8_t>& user_data) override {
    const std::lock_guard<std::mutex> lock(mutex);
    if (processes.count(guid) > 0) return;
    const rtps::Announcement announced = rtps::from_user_data(user_data);
    const std::string process =
        announced.host.empty() ? name : ProcessIdentity{name, announced.host, announced.pid}.to_string();
    processes[guid] = process;
    on_event({process, true, false});
  }
  void on_participant_gone(const fastrtps::GUID_t& guid, bool said_goodbye) override {
    const std::lock_guard<std::mutex> lock(mutex);
    const auto known = processes.find(guid);
    if (known == processes.end()) return;
    on_event({known->second, false, said_goodbye});
    processes.erase(known);
  }

  const std::shared_ptr<rtps::DatagramGuard> guard;
  std::mutex mutex;
  std::map<fastrtps::GUID_t, std::string> processes;
  std::function<void(const DiscoveryServerEvent&)> on_event;
  fastdds::DomainParticipant* participant = nullptr;
  PeriodicTask log_refusals{kLogPeriod,
                            [this] { guard->refusals().write_due(std::chrono::steady_clock::now()); }};
};

DiscoveryServer::DiscoveryServer(const DiscoveryServerSettings& settings,
                                 std::function<void(const DiscoveryServerEvent&)> on_event)
    : impl_(std::make_unique<Impl>(settings, std::move(on_event))) {
  if (settings.on_loopback() && !settings.interfaces.empty())
    throw io::ConfigError(
        "an interface (--interface) is given, but the server stays on the loopback interface without "
        "--network-key FILE or --open-network");
  set_up_fast_dds();
  require_free(settings.port);
  impl_->guard->listen(false);
  impl_->guard->set_own_interfaces(io::interfaces_up());
  impl_->participant = fastdds::DomainParticipantFactory::get_instance()->create_participant(
      static_cast<std::uint32_t>(settings.domain), server_qos(settings, impl_->guard), impl_.get(),
      fastdds::StatusMask::none());
  if (impl_->participant == nullptr)
    throw std::runtime_error("cannot start the discovery server on UDP port " +
                             std::to_string(settings.port));
}

void DiscoveryServer::serve() { impl_->guard->listen(true); }

DiscoveryServer::~DiscoveryServer() {
  impl_->participant->set_listener(nullptr);
  fastdds::DomainParticipantFactory::get_instance()->delete_participant(impl_->participant);
}

}  // namespace swiftlet::dds
