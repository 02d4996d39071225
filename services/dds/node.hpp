// One process on the network: a DDS participant, and nodes that publish and subscribe the topics of one vehicle
// each. No Fast DDS header is seen through this file.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "swiftlet/services/messages/topics.hpp"

namespace swiftlet::comms {

enum class Transport {
  kUdp,           // works everywhere, leaves nothing behind
  kSharedMemory,  // between processes of one user on one host; UDP for others
  kDataSharing,   // streams through memory that writer and reader map, the rest as kUdp; for measurements
};

struct NodeSettings {
  std::string name;             // of the process: "plant", "mocap", "control", "ground"
  std::string vehicle = "kl1";  // namespace of the topics: letters, digits and _, at most 64
  int domain = 0;               // 0 .. 232
  Transport transport = Transport::kUdp;
  bool localhost_only = false;  // discover and talk over the loopback interface only, without multicast
  // Offer and ask for the topics' deadlines. Not in lockstep, where time stands still; who asks for one does
  // not hear who offers none.
  bool deadlines = true;
  // How often it announces itself: kFixturePeriod for what a controller cannot fly without.
  std::chrono::milliseconds announcement_period = kLivelinessPeriod;
};

// Another process of the same vehicle appeared or went away.
struct PeerEvent {
  std::string name;
  bool alive = false;
  bool said_goodbye = false;  // of one that went away: it ended cleanly; otherwise it died or was cut off
};

// Which thread runs the callback.
enum class Delivery {
  // One that all such subscriptions of the node share.
  kShared,
  // One of its own, with a socket of its own: nothing else that arrives delays a sample. Over shared memory
  // as kShared.
  kOwnThread,
};

namespace detail {
class Writer {
 public:
  virtual ~Writer() = default;
  virtual bool write(const void* sample) = 0;
  virtual int matched() const = 0;
  virtual std::uint64_t changes() const = 0;
  virtual void set_strength(std::uint32_t strength) = 0;
};
class Reader {
 public:
  virtual ~Reader() = default;
  virtual int matched() const = 0;
};
}  // namespace detail

// May outlive its node. One thread at a time calls publish().
template <class T>
class Publisher {
 public:
  Publisher() = default;
  explicit Publisher(std::unique_ptr<detail::Writer> writer) : writer_(std::move(writer)) {}
  // False if the sample was not handed to the network (no resources, time-out of a reliable writer).
  bool publish(const T& sample) { return writer_->write(&sample); }
  int matched() const { return writer_->matched(); }  // readers that hear it
  // How often one of these has come or gone: what was sent before the last change may not have reached all.
  std::uint64_t changes() const { return writer_->changes(); }
  // Of an owned stream, from now on; the readers know it within milliseconds. By any thread.
  void set_strength(std::uint32_t strength) { writer_->set_strength(strength); }

 private:
  std::unique_ptr<detail::Writer> writer_;
};

// Deliveries stop when it is destroyed; the destructor waits for a callback that is running, so it must not
// be destroyed from there. May outlive its node.
class Subscription {
 public:
  Subscription() = default;
  explicit Subscription(std::unique_ptr<detail::Reader> reader) : reader_(std::move(reader)) {}
  int matched() const { return reader_->matched(); }  // writers that are heard

 private:
  std::unique_ptr<detail::Reader> reader_;
};

// A process's place in a domain, which the nodes of any number of vehicles share: one set of sockets, threads and
// discoveries for all of them.
class Participant {
 public:
  // Of no vehicle at first: that of the settings is not looked at. Throws std::runtime_error with a sentence if it
  // cannot be made. Its threads have the scheduling of the thread that makes it. With kSharedMemory, what dead
  // processes of this user left in /dev/shm is removed at its start and its end.
  explicit Participant(const NodeSettings& settings);

  // The topics that others in the domain publish now, whichever vehicle's, by their names on the wire
  // ("rt/kl1/imu"); sorted, each once. Those of processes that keep to the loopback interface are there only
  // for who does so too.
  std::vector<std::string> topics_seen() const;

 private:
  friend class Node;
  struct Impl;
  explicit Participant(std::shared_ptr<Impl> impl) : impl_(std::move(impl)) {}
  std::shared_ptr<Impl> impl_;
};

class Node {
 public:
  // With a participant of its own. Throws as Participant does, and for a vehicle's name that cannot be one.
  explicit Node(const NodeSettings& settings);
  // One of those that share the participant.
  Node(const Participant& participant, const std::string& vehicle);
  ~Node();
  Node(const Node&) = delete;
  Node& operator=(const Node&) = delete;

  // strength: of an owned stream; the strongest living writer is heard. Throws std::runtime_error.
  template <class T>
  Publisher<T> publish(const Topic<T>& topic, std::uint32_t strength = 0);

  // The callback runs in the thread that received the sample, once for each sample, one at a time, and must
  // not block. Throws std::runtime_error.
  template <class T>
  Subscription subscribe(const Topic<T>& topic, std::function<void(const T&)> callback,
                         Delivery delivery = Delivery::kShared);

  std::vector<std::string> topics_seen() const { return participant_.topics_seen(); }

  // Tells of the vehicle's peers that come and go, also of those that were there before the call. Runs in a middleware
  // thread. A later call takes the place of an earlier one; when it returns, the earlier callback runs no
  // more.
  void on_peer(std::function<void(const PeerEvent&)> callback);

  // Leaves the domain and joins it anew, with all that it publishes and subscribes: others take it for a new
  // process. Callbacks run in new threads from then on. It does so by itself where a peer came back and
  // cannot be heard. Not from a callback.
  void rejoin();

 private:
  Participant participant_;
  const std::string vehicle_;
};

}  // namespace swiftlet::comms
