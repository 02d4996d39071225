// The inside of dds::Participant: the session in the domain, the endpoints that survive a rejoin, and the other
// processes that were discovered.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>

#include "swiftlet/services/dds/discovery/address_watch.hpp"
#include "swiftlet/services/dds/discovery/rediscovery.hpp"
#include "swiftlet/services/dds/fast_dds.hpp"
#include "swiftlet/services/dds/limited_log.hpp"
#include "swiftlet/services/dds/node.hpp"
#include "swiftlet/services/dds/participant_session.hpp"
#include "swiftlet/services/dds/periodic_task.hpp"
#include "swiftlet/services/rtps/announcement.hpp"
#include "swiftlet/services/rtps/datagram_guard.hpp"
#include "swiftlet/services/runtime/realtime.hpp"

namespace swiftlet::dds {

struct Participant::Impl final : public DiscoveryListener {
  // vehicles: a list, "kl1,kl2"; may be empty
  Impl(const NodeSettings& node_settings, const std::string& vehicles);
  ~Impl() override;
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  // Call for each node of a vehicle that this process serves, and for each of them that ends: which is announced within
  // kCheckPeriod, not at all if the participant ends.
  void serve(const std::string& vehicle);
  void stop_serving(const std::string& vehicle);
  std::optional<std::string> become_source(const std::vector<std::string>& excluded,
                                           std::function<void(const std::string&)> on_lost);
  void add(Endpoint* endpoint);
  void remove(Endpoint* endpoint);
  // Number of the readers of a topic that this participant has.
  std::shared_ptr<std::atomic<int>> own_readers(const std::string& wire_name);
  // Leaves the domain and joins it again. Returns false if joining failed this time or the previous time.
  bool rejoin();

  std::vector<std::string> topics_seen() const;
  std::vector<ProcessIdentity> processes_seen() const;
  std::vector<std::string> mismatches_seen() const;
  std::vector<std::string> refused_keys() const;
  ProcessIdentity identity_of(const fastrtps::GuidPrefix_t& participant) const;
  // node: key of the callback; an empty callback removes it. Calls it at once for known peers of the vehicle.
  void listen(const Node* node, const std::string& vehicle, std::function<void(const PeerEvent&)> callback);

  // Raises the priority of a thread that is about to take locks of the middleware, or those of this class.
  runtime::RealtimeScope realtime() const { return runtime::RealtimeScope(settings.realtime_priority); }

  const NodeSettings settings;

 private:
  using Guid = fastrtps::GUID_t;
  using GuidPrefix = fastrtps::GuidPrefix_t;
  struct Peer {
    std::string name;
    rtps::Announcement announced;
    PeerEndpoints endpoints{};

    ProcessIdentity identity() const { return {name, announced.host, announced.pid}; }
  };
  using RemoteEndpoints = std::map<Guid, RemoteEndpoint>;
  struct PeerListener {
    std::string vehicle;
    std::function<void(const PeerEvent&)> callback;
  };

  // If a peer was rediscovered without its endpoints, rejoins the domain. The peers then discover a new process.
  void rejoin_if_rediscovery_failed();
  void leave();              // requires session_mutex_
  void end_session();        // requires session_mutex_; waits until what it announced last is that long ago
  void announce_when_due();  // a change of announcement_; requires session_mutex_
  void
  follow_addresses();  // of this host, whose changes are to be announced, and of others; requires session_mutex_

  void on_participant(const Guid& guid, const std::string& name,
                      const std::vector<std::uint8_t>& user_data) override;
  void on_participant_gone(const Guid& guid, bool said_goodbye) override;
  void on_authentication(const Guid& guid, bool authenticated) override;
  void on_writer(const Guid& guid, const RemoteEndpoint& writer) override;
  void on_writer_gone(const Guid& guid) override;
  void on_reader(const Guid& guid, const RemoteEndpoint& reader) override;
  void on_reader_gone(const Guid& guid) override;
  // Fast DDS reports which own reader or writer has a conflict, but not the peer. Logs every known peer
  // endpoint of the topic that does not match.
  void on_requested_incompatible_qos(eprosima::fastdds::dds::DataReader* reader,
                                     const eprosima::fastdds::dds::RequestedIncompatibleQosStatus&) override;
  void on_offered_incompatible_qos(eprosima::fastdds::dds::DataWriter* writer,
                                   const eprosima::fastdds::dds::OfferedIncompatibleQosStatus&) override;

  // All of these require peers_mutex_.
  static void tell(const PeerListener& listener, const PeerEvent& event) noexcept;
  void update_peer(const Guid& guid, Peer peer);  // a known peer may serve more vehicles now
  void drop_peer(const Guid& guid, bool said_goodbye);
  void add_endpoint(RemoteEndpoints& endpoints, const Guid& guid, const RemoteEndpoint& endpoint,
                    PeerEndpoints::Kind kind);
  const Peer* peer_of(const GuidPrefix& participant) const;
  std::string shared_vehicle(const Peer& peer) const;  // the first vehicle that both serve; empty if none
  bool is_own(const Peer& peer) const { return !shared_vehicle(peer).empty(); }
  template <class ConflictsWith>
  void log_conflicts(const std::string& topic, const RemoteEndpoints& others, const char* consequence,
                     const ConflictsWith& conflicts_with);

  // A sentence about another process to which this one must yield (become_source()); nullopt if there is none.
  std::optional<std::string> other_source(const std::vector<std::string>& excluded) const;
  std::optional<std::string> unannounced_source(const std::string& vehicle, const std::string& topic) const;
  bool is_on_probation() const;  // as a source (kSourceProbation); requires peers_mutex_
  // Two sources that joined at the same time, and discovered each other late.
  void yield_source_to(const Peer& peer);
  std::string in_use_by(const std::string& vehicle, const std::string& topic, const Peer& source) const;

  const std::shared_ptr<rtps::DatagramGuard> guard_;
  std::mutex session_mutex_;  // guards session_, announcement_changed_, endpoints_, nodes_of_, own_readers_
  std::unique_ptr<ParticipantSession> session_;
  bool announcement_changed_ = false;  // since session_ announced it
  std::vector<Endpoint*> endpoints_;
  std::map<std::string, int> nodes_of_;  // number of the nodes that serve a vehicle
  std::map<std::string, std::shared_ptr<std::atomic<int>>> own_readers_;  // by wire name

  mutable std::mutex peers_mutex_;   // guards all below; locked after session_mutex_
  rtps::Announcement announcement_;  // of this process; changed with both mutexes locked
  std::chrono::steady_clock::time_point established_at_;
  // When it could first hear of others: with a discovery server when it heard of that.
  std::optional<std::chrono::steady_clock::time_point> introduced_at_;
  std::function<void(const std::string&)> on_lost_source_;
  std::map<Guid, Peer>
      peers_;  // of any vehicle; with security only authenticated ones, also before they are discovered
  std::map<Guid, Peer> strangers_;       // with security: discovered, but not authenticated yet
  std::map<Guid, std::string> refused_;  // with security: their names
  RemoteEndpoints writers_;              // of other processes, any vehicle
  RemoteEndpoints readers_;
  LimitedLog log_;
  std::map<const Node*, PeerListener> peer_listeners_;
  std::map<GuidPrefix, unsigned> lost_;  // kinds of endpoints of those peers whose lease has expired
  RejoinPatience patience_;

  AddressWatch addresses_;
  std::atomic<bool> away_{false};  // the last rejoin failed
  std::optional<PeriodicTask> periodic_task_;
};

}  // namespace swiftlet::dds
