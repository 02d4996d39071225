// A process on the network: a DDS participant, and nodes that each publish and subscribe the topics of one
// vehicle. This header includes no Fast DDS header.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "swiftlet/services/messages/topics.hpp"

namespace swiftlet::dds {

// How a process finds the processes of other hosts.
struct NetworkSettings {
  // Hosts to which it announces itself, "HOST" or "HOST:PORT"; without a port to the first discovery ports of
  // the domain. If there are any, it uses no multicast. Own processes of this host are found without.
  std::vector<std::string> peers{};
  // It sends and receives on these interfaces, by name or IPv4 address, and the loopback interface only. Empty: on all.
  std::vector<std::string> interfaces{};

  // The servers that tell it of the others, "HOST[:PORT][;...]" (io/network/host_address.hpp). It uses no multicast then. Not
  // with peers. Empty: none.
  std::string discovery_servers{};
  // An XML file of Fast DDS, whose default participant profile applies under what Swiftlet sets itself
  // (dds_profile.hpp). Empty: none.
  std::string dds_profile{};

  std::string file{};  // that was applied (node_options.hpp); empty: none

  bool uses_multicast() const { return peers.empty() && discovery_servers.empty(); }
};

struct NodeSettings {
  std::string name;             // process: "plant", "mocap", "control", "ground"
  std::string vehicle = "kl1";  // namespace of the topics: see messages/vehicle_names.hpp
  int domain = 0;               // 0 .. 232
  bool localhost_only = false;  // loopback interface only, also with a key
  NetworkSettings network{};    // needs the network: see on_loopback()
  // Uses the network without network_key_file or security too: whoever is in it can then command the vehicles.
  bool open_network = false;
  // This process hears of all others of the domain. False: not of those that neither serve a vehicle of its own nor hear of
  // all, and with a discovery server, unless it is a source, only of those that exchange topics with it, which keeps the traffic of a fleet in
  // proportion to its vehicles; on_peer() and topics_seen() miss the others.
  bool hears_of_all = true;
  // File with the keys of the network (io/network_key.hpp): only datagrams of processes with one of them are
  // received. Empty: from everyone.
  std::string network_key_file{};
  // Folder with the keys of DDS Security (io/security/security_folder.hpp). Empty: no security.
  std::string security{};
  // Period of its announcements: kFixturePeriod for vehicle and motion capture.
  std::chrono::milliseconds announcement_period = messages::kLivelinessPeriod;
  // SCHED_FIFO priority of all threads that hold locks of the middleware, 0: ordinary. A real-time thread that publishes or
  // receives waits for such locks: one priority for all lets nothing else delay who holds them.
  int realtime_priority = 0;
  // Name of the topic of which this process is to be the only source for its vehicle, such as "imu"; then
  // call become_source() before it publishes. Empty: none.
  std::string source_of{};

  // Whether it uses the loopback interface only, without multicast: it was told so, or has nothing that makes the network safe.
  bool on_loopback() const {
    return localhost_only || (!open_network && network_key_file.empty() && security.empty());
  }
};

// A process of the domain, as it announces itself. Programs of others announce neither host nor process.
struct ProcessIdentity {
  std::string name;  // "plant"
  std::string host;
  int pid = 0;

  std::string to_string() const;  // "plant (process 4711 on host lab1)"
};

// Two processes that send samples of the same topic of a vehicle.
struct SourceConflict {
  ProcessIdentity used;
  ProcessIdentity ignored;
};

// Samples of another process are taken once the source of a fast stream has been silent for this time.
constexpr std::chrono::milliseconds kSourceSilence{200};
// source_of of who starts a simulated vehicle (sole_source.hpp).
constexpr const char* kFlight = "flight";

// How long become_source() looks for another source: an announcement is sent several times in that time.
constexpr std::chrono::milliseconds kSourceSearchTime{250};
// With security, where Fast DDS repeats a lost handshake after 0.5 s, and with a discovery server, which tells of a source only
// after it has heard of what searches for it.
constexpr std::chrono::milliseconds kLongSourceSearchTime{1000};
// So long after become_source(), and after it has heard of a discovery server, the later of two sources yields.
constexpr std::chrono::milliseconds kSourceProbation{3000};
// How long a SourceConflict is reported after the last ignored sample.
constexpr std::chrono::milliseconds kConflictReportTime{2000};

// Another process of the same vehicle was discovered or lost.
struct PeerEvent {
  std::string name;
  bool alive = false;
  bool said_goodbye = false;  // if not alive: it ended cleanly; else it died or was cut off
};

// The thread that runs the callback. Each has a socket of its own, so that no other message delays its samples, and serves all
// subscriptions of the participant that name it, of any vehicle.
enum class Delivery {
  kShared,  // requests, status, and what else is not named below
  kSamples,  // what is answered at once: samples of the IMU, the truth at motion capture, commands at the vehicle
  kSensors,  // poses and rotor speeds
  kPlans,    // long messages, and what other controllers say of themselves
  kOwn,  // of this subscription alone: a recorder's, for which one buffer would be too small for all vehicles
};
constexpr std::size_t kDeliveryCount = 5;

// A sample as it came: its payload is not checked.
struct RawSample {
  const std::uint8_t* payload = nullptr;  // CDR with the encapsulation header; valid during the callback
  std::size_t size = 0;
  std::int64_t source_stamp_ns = 0;   // system clock of the writer; 0: not sent
  std::uint64_t sequence_number = 0;  // counts the samples of the writer: a gap is a lost sample
  std::uint64_t writer = 0;           // another number for each writer
};

namespace detail {
class Writer {
 public:
  virtual ~Writer() = default;
  virtual bool write(const void* sample) = 0;
  virtual bool wait_until_received(std::chrono::milliseconds timeout) = 0;
  virtual int matched() const = 0;
  virtual std::uint64_t changes() const = 0;
};
class Reader {
 public:
  virtual ~Reader() = default;
  virtual int matched() const = 0;
  virtual std::optional<SourceConflict> source_conflict() const = 0;
};
}  // namespace detail

// May outlive its node. publish() must not be called concurrently.
template <class T>
class Publisher {
 public:
  Publisher() = default;
  explicit Publisher(std::unique_ptr<detail::Writer> writer) : writer_(std::move(writer)) {}
  // Returns false if the sample was not sent (no resources, or time-out of a reliable writer).
  bool publish(const T& sample) { return writer_->write(&sample); }
  // Waits until all matched readers of a reliable topic have received all samples. A reader drops what arrives
  // after it has heard that the writer is gone: wait before the writer of an important last sample ends.
  // Returns false after the timeout.
  bool wait_until_received(std::chrono::milliseconds timeout) {
    return writer_->wait_until_received(timeout);
  }
  int matched() const { return writer_->matched(); }  // number of matched readers
  // Number of matches and unmatches of readers. A sample sent before the last one may not have reached all.
  std::uint64_t changes() const { return writer_->changes(); }

 private:
  std::unique_ptr<detail::Writer> writer_;
};

// Its destructor stops the deliveries and waits for a running callback, so the callback must not destroy it.
// May outlive its node.
class Subscription {
 public:
  Subscription() = default;
  explicit Subscription(std::unique_ptr<detail::Reader> reader) : reader_(std::move(reader)) {}
  int matched() const { return reader_->matched(); }  // number of matched writers
  // Set while a subscription with one source ignores samples that arrive from another process.
  std::optional<SourceConflict> source_conflict() const { return reader_->source_conflict(); }

 private:
  std::unique_ptr<detail::Reader> reader_;
};

// A DDS participant that the nodes of any number of vehicles share: one set of sockets, threads and discovery
// data for all of them.
class Participant {
 public:
  // Creates a participant without a vehicle; ignores settings.vehicle. Throws std::runtime_error with a sentence.
  explicit Participant(const NodeSettings& settings);
  // The same, and announces at once that it serves these vehicles; then construct a node for each.
  Participant(const NodeSettings& settings, const std::vector<std::string>& vehicles);

  // The wire names ("rt/kl1/imu") of the topics that other participants of the domain publish now, of any
  // vehicle; sorted, without duplicates.
  std::vector<std::string> topics_seen() const;
  // The other processes of the domain that are known now, of any vehicle.
  std::vector<ProcessIdentity> processes_seen() const;
  // A sentence for each two of the other known processes that do not receive each other's topic, "rt/kl1/imu: control (...) does
  // not receive from plant (...): reliability (...)", and for each topic of Swiftlet that one has with another type, or without "rt/".
  std::vector<std::string> mismatches_seen() const;
  // A sentence with what to do for each host, and with security for each process, that is refused since it has no key, or another
  // than this process: neither side discovers the other.
  std::vector<std::string> refused_keys() const;

  // Checks that this process is the only source of settings.source_of for the vehicles that it serves, and that
  // none of `excluded` has a source either. Blocks for kSourceSearchTime, or kLongSourceSearchTime.
  // Returns a sentence that names the vehicle, the other process and its host, if there is one; then this process must
  // not publish the topic. A process that joined at the same time is refused on one side only. on_lost: called with such
  // a sentence if an earlier source is discovered only within kSourceProbation after; the process must end then. It runs
  // in a middleware thread and must not call this class.
  std::optional<std::string> become_source(const std::vector<std::string>& excluded,
                                           std::function<void(const std::string&)> on_lost = {});

 private:
  friend class Node;
  struct Impl;
  explicit Participant(std::shared_ptr<Impl> impl) : impl_(std::move(impl)) {}
  std::shared_ptr<Impl> impl_;
};

// One of the processes that publish a topic is heard: that which was first, until it has been silent for this time.
struct OneSource {
  std::chrono::milliseconds silence;
  // Called before the first sample of the next one, in the thread of the callback.
  std::function<void()> on_next = {};
};

class Node {
 public:
  // With its own participant. Throws as Participant does, and for an invalid vehicle name.
  explicit Node(const NodeSettings& settings);
  // Shares the participant with other nodes. When the last node of a vehicle ends, the process no longer announces
  // that it serves the vehicle. on_fault: called with the text of an exception that a callback of a subscription throws,
  // in its thread; that subscription delivers nothing more. Without it such an exception ends the process.
  Node(const Participant& participant, const std::string& vehicle,
       std::function<void(const std::string&)> on_fault = {});
  ~Node();
  Node(const Node&) = delete;
  Node& operator=(const Node&) = delete;

  // Throws std::runtime_error.
  template <class T>
  Publisher<T> publish(const messages::Topic<T>& topic);

  // The callback runs in the thread that received the sample, once per sample, never concurrently. It must
  // not block. What this participant publishes itself is not delivered. source: if given, the samples of only one process are.
  // Throws std::runtime_error.
  template <class T>
  Subscription subscribe(const messages::Topic<T>& topic, std::function<void(const T&)> callback,
                         Delivery delivery = Delivery::kShared,
                         std::optional<OneSource> source = std::nullopt);

  // As subscribe(), for recorders.
  template <class T>
  Subscription subscribe_raw(const messages::Topic<T>& topic, std::function<void(const RawSample&)> callback,
                             Delivery delivery = Delivery::kShared);

  std::vector<std::string> topics_seen() const { return participant_.topics_seen(); }
  std::vector<std::string> refused_keys() const { return participant_.refused_keys(); }
  // As Participant::mismatches_seen(), of the topics of the vehicle.
  std::vector<std::string> mismatches_seen() const;

  // As Participant::become_source(), for settings.source_of alone. Throws std::logic_error if that is empty.
  std::optional<std::string> become_source(std::function<void(const std::string&)> on_lost = {});

  // Sets the callback for discovered and lost peers of the vehicle; it is called at once for known peers. It
  // runs in a middleware thread, and ends the process if it throws. A new callback replaces the previous one,
  // which no longer runs when this returns; the last one runs until the node is destroyed.
  void on_peer(std::function<void(const PeerEvent&)> callback);

  // Leaves the domain and joins it again with all publishers and subscriptions. Other processes see a new
  // process, and callbacks run in new threads. The participant does so by itself when a peer is rediscovered
  // without its endpoints. Must not be called from a callback.
  void rejoin();

 private:
  Participant participant_;
  const std::string vehicle_;
  const std::string source_of_;
  const std::function<void(const std::string&)> on_fault_;
  const bool shares_participant_ = false;
};

}  // namespace swiftlet::dds
