// One process on the network: a DDS participant that publishes and subscribes the topics of one vehicle.
// No Fast DDS header is seen through this file.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <string>

#include "services/comms/topics.hpp"

namespace swiftlet::comms {

enum class Transport {
  kUdp,           // works everywhere, leaves nothing behind
  kSharedMemory,  // between processes of one user on one host; UDP for others
};

struct NodeSettings {
  std::string name;             // of the process: "plant", "mocap", "control", "ground"
  std::string vehicle = "kl1";  // namespace of the topics
  int domain = 0;               // 0 .. 232
  Transport transport = Transport::kUdp;
  bool localhost_only = false;  // discover and talk over the loopback interface only, without multicast
};

// Another process of the same vehicle appeared or went away (ended, died or was cut off).
struct PeerEvent {
  std::string name;
  bool alive = false;
};

namespace detail {
class Writer {
 public:
  virtual ~Writer() = default;
  virtual bool write(const void* sample) = 0;
  virtual int matched() const = 0;
};
class Reader {
 public:
  virtual ~Reader() = default;
  virtual int matched() const = 0;
};
struct TypeSupportOf;  // maps a message type to its generated DDS type support
}  // namespace detail

template <class T>
class Publisher {
 public:
  Publisher() = default;
  explicit Publisher(std::unique_ptr<detail::Writer> writer) : writer_(std::move(writer)) {}
  // False if the sample was not handed to the network (no resources, time-out of a reliable writer).
  bool publish(const T& sample) { return writer_->write(&sample); }
  int matched() const { return writer_->matched(); }  // readers that hear it

 private:
  std::unique_ptr<detail::Writer> writer_;
};

// Deliveries stop when it is destroyed; the destructor waits for a callback that is running.
class Subscription {
 public:
  Subscription() = default;
  explicit Subscription(std::unique_ptr<detail::Reader> reader) : reader_(std::move(reader)) {}
  int matched() const { return reader_->matched(); }  // writers that are heard

 private:
  std::unique_ptr<detail::Reader> reader_;
};

class Node {
 public:
  // Throws std::runtime_error with a sentence if the participant cannot be made.
  explicit Node(const NodeSettings& settings);
  ~Node();
  Node(const Node&) = delete;
  Node& operator=(const Node&) = delete;

  // strength: of an owned stream; the strongest living writer is heard.
  template <class T>
  Publisher<T> publish(const Topic<T>& topic, int strength = 0);

  // The callback runs in the thread that received the sample, once for each sample, and must not block.
  // on_deadline_missed (may be empty) runs when a stream's deadline passes without a sample.
  template <class T>
  Subscription subscribe(const Topic<T>& topic, std::function<void(const T&)> callback,
                         std::function<void()> on_deadline_missed = {});

  // Tells of peers that come and go, also of those that were there before the call. Runs in a middleware thread.
  void on_peer(std::function<void(const PeerEvent&)> callback);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace swiftlet::comms
