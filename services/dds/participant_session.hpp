// The Fast DDS entities of a process while it is in a domain, and the endpoints that survive leaving and
// rejoining it.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantListener.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/Topic.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>

#include "swiftlet/services/dds/fast_dds.hpp"
#include "swiftlet/services/dds/node.hpp"
#include "swiftlet/services/rtps/announcement.hpp"
#include "swiftlet/services/rtps/datagram_guard.hpp"

namespace swiftlet::dds {

rtps::GuidPrefix bytes_of(const fastrtps::GuidPrefix_t& participant);

// What checks the datagrams of a session with these settings. Throws io::ConfigError for a bad key file.
std::shared_ptr<rtps::DatagramGuard> guard_of(const NodeSettings& settings);

// Between two changes that a participant announces to a discovery server, and before it leaves: the server of Fast DDS, up to 3.6
// at least, frees an announcement of which it takes the next one before it has sent it on, then sends it all the same, and fails
// the assertion "min_seq <= last_seq" (DiscoveryDataBase::update_participant_from_change_ leaves it in pdp_to_send_).
constexpr std::chrono::milliseconds kAnnouncementSpacing{200};

// A participant with its publisher, subscriber and topics. Its destructor announces to the peers that it
// leaves; it does not wait until next_announcement().
class ParticipantSession {
 public:
  // Throws std::runtime_error if the participant cannot be created.
  ParticipantSession(const NodeSettings& settings, const rtps::Announcement& announcement,
                     const std::shared_ptr<rtps::DatagramGuard>& guard,
                     eprosima::fastdds::dds::DomainParticipantListener* listener);
  ~ParticipantSession();
  ParticipantSession(const ParticipantSession&) = delete;
  ParticipantSession& operator=(const ParticipantSession&) = delete;

  // Returns the topic, created on first use. Not thread-safe. Throws std::runtime_error.
  eprosima::fastdds::dds::Topic* topic(const std::string& wire_name,
                                       const eprosima::fastdds::dds::TypeSupport& type);

  // Before a reader is created with this QoS: gives it the socket and the thread of its delivery. After: remembers those of
  // the first one. Not thread-safe.
  void receive_in(Delivery delivery, eprosima::fastdds::dds::DataReaderQos& qos) const;
  void note_receiver(Delivery delivery, const eprosima::fastdds::dds::DataReader& reader);

  // Announces a change to the peers. Does not wait until next_announcement().
  void announce(const rtps::Announcement& announcement);
  // When the next change may be announced: with a discovery server kAnnouncementSpacing after the last one.
  std::chrono::steady_clock::time_point next_announcement() const { return next_announcement_; }

  eprosima::fastdds::dds::DomainParticipant* participant = nullptr;
  eprosima::fastdds::dds::Publisher* publisher = nullptr;
  eprosima::fastdds::dds::Subscriber* subscriber = nullptr;

 private:
  void set_qos(const eprosima::fastdds::dds::DomainParticipantQos& qos);

  const std::shared_ptr<rtps::DatagramGuard> guard_;
  const std::chrono::milliseconds spacing_;
  std::chrono::steady_clock::time_point next_announcement_{};
  std::map<std::string, eprosima::fastdds::dds::Topic*> topics_;
  std::array<fastrtps::LocatorList_t, kDeliveryCount> receivers_;  // by Delivery; empty: none yet
};

// A writer or reader that outlives a session.
class Endpoint {
 public:
  virtual ~Endpoint() = default;
  virtual void join(ParticipantSession& session) = 0;   // throws std::runtime_error
  virtual void leave(ParticipantSession& session) = 0;  // no effect if it did not join
};

// A pointer for threads that must not block; another thread that may block can take it away.
template <class T>
class GuardedPointer {
 public:
  class Use {
   public:
    explicit Use(const GuardedPointer& handle) : handle_(handle) {
      ++handle_.users_;
      target_ = handle_.target_.load();
    }
    ~Use() { --handle_.users_; }
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;
    explicit operator bool() const { return target_ != nullptr; }
    T& operator*() const { return *target_; }
    T* operator->() const { return target_; }

   private:
    const GuardedPointer& handle_;
    T* target_;
  };

  void give(T* target) { target_ = target; }
  // Clears the pointer, waits until nobody uses it, and returns its old value.
  T* take() {
    T* const target = target_.exchange(nullptr);
    while (users_ != 0) std::this_thread::yield();
    return target;
  }

 private:
  mutable std::atomic<int> users_{0};
  std::atomic<T*> target_{nullptr};
};

}  // namespace swiftlet::dds
