// The writers and readers of a Node. A source file that includes this header and instantiates Node::publish() and
// Node::subscribe() for message types makes these types topics: node.cpp does for those of Swiftlet.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>

#include "swiftlet/services/dds/checked_type_support.hpp"
#include "swiftlet/services/dds/fast_dds.hpp"
#include "swiftlet/services/dds/node.hpp"
#include "swiftlet/services/dds/participant.hpp"
#include "swiftlet/services/dds/participant_session.hpp"
#include "swiftlet/services/dds/qos/duration.hpp"
#include "swiftlet/services/dds/qos/profiles.hpp"
#include "swiftlet/services/dds/single_source.hpp"
#include "swiftlet/services/rtps/rtps_ids.hpp"
#include "swiftlet/services/runtime/log.hpp"
#include "swiftlet/services/runtime/log_label.hpp"
#include "swiftlet/services/runtime/realtime.hpp"

namespace swiftlet::dds {

// The generated type support of a message: specialize it for each.
template <class T>
struct PubSubTypeOf;

// The hash by which ROS 2 knows the type of a message, "RIHS01_..."; null: its endpoints state none.
template <class T>
struct RosTypeHash {
  static const char* value() { return nullptr; }
};

namespace detail {

namespace fastdds = eprosima::fastdds::dds;

// A process as the sender of samples. Fast DDS begins the identifiers of all participants of a process, also
// of one that rejoined the domain, with the same octets.
struct SenderId {
  static constexpr std::size_t kProcessOctets = 8;

  fastrtps::GuidPrefix_t participant;

  bool operator==(const SenderId& other) const {
    return std::equal(participant.value, participant.value + kProcessOctets, other.participant.value);
  }
};

inline std::uint64_t number_of(const fastrtps::GUID_t& guid) {
  return rtps::fnv(guid.entityId.value, 4, rtps::fnv(guid.guidPrefix.value, 12));
}

// As names in ROS 2: one that begins with / is absolute, any other is in the namespace of the vehicle.
inline std::string wire_name(const std::string& vehicle, const std::string& name) {
  return name.front() == '/' ? "rt" + name : "rt/" + vehicle + "/" + name;
}

template <class T>
fastdds::Topic* topic_in(ParticipantSession& session, const std::string& vehicle, const char* name) {
  return session.topic(wire_name(vehicle, name),
                       fastdds::TypeSupport(new CheckedTypeSupport<typename PubSubTypeOf<T>::type>()));
}

// Endpoints share the participant, so that they may be destroyed in any order.
template <class Impl, class T>
class DdsWriter final : public Writer, private Endpoint {
 public:
  DdsWriter(std::shared_ptr<Impl> node, std::string vehicle, const messages::Topic<T>& topic)
      : node_(std::move(node)),
        vehicle_(std::move(vehicle)),
        topic_(topic),
        own_readers_(node_->own_readers(wire_name(vehicle_, topic_.name))) {
    node_->add(this);
  }
  ~DdsWriter() override { node_->remove(this); }
  DdsWriter(const DdsWriter&) = delete;
  DdsWriter& operator=(const DdsWriter&) = delete;

  bool write(const void* sample) override {
    const runtime::RealtimeScope scope = node_->realtime();
    if (is_latched(topic_.qos)) {
      const std::lock_guard<std::mutex> lock(last_mutex_);
      last_ = *static_cast<const T*>(sample);
    }
    const typename GuardedPointer<fastdds::DataWriter>::Use writer(writer_);
    if (!writer) return false;
    if (!is_reliable(topic_.qos) && !is_heard(*writer)) return true;
    if (topic_.qos == messages::Qos::kRequest && ++unacknowledged_ > messages::kKeptRequests)
      unacknowledged_ = wait_until_received(messages::kReliableWriteTimeout) ? 1 : messages::kKeptRequests;
    return dds::write(*writer, sample);
  }

  bool wait_until_received(std::chrono::milliseconds timeout) override {
    const runtime::RealtimeScope scope = node_->realtime();
    const typename GuardedPointer<fastdds::DataWriter>::Use writer(writer_);
    return writer && succeeded(writer->wait_for_acknowledgments(duration(timeout)));
  }

  int matched() const override { return readers().current_count; }
  std::uint64_t changes() const override {
    const fastdds::PublicationMatchedStatus now = readers();
    return changes_before_ + static_cast<std::uint64_t>(2 * now.total_count - now.current_count);
  }

 private:
  void join(ParticipantSession& session) override {
    fastdds::DataWriterQos qos = writer_qos(topic_.qos);
    state_type_hash(qos, RosTypeHash<T>::value());
    fastdds::DataWriter* const writer =
        session.publisher->create_datawriter(topic_in<T>(session, vehicle_, topic_.name), qos);
    if (writer == nullptr) throw std::runtime_error(std::string("cannot publish ") + topic_.name);
    const std::lock_guard<std::mutex> lock(last_mutex_);
    if (last_) dds::write(*writer, &*last_);
    writer_.give(writer);
  }
  void leave(ParticipantSession& session) override {
    fastdds::DataWriter* const writer = writer_.take();
    if (writer == nullptr) return;
    fastdds::PublicationMatchedStatus last;
    writer->get_publication_matched_status(last);
    changes_before_ += 2 * static_cast<std::uint64_t>(last.total_count);  // all readers unmatched
    // The destructor of a writer of Fast DDS 2.9 releases samples that its thread for heartbeats still reads if a peer has
    // not acknowledged them, and that thread may then never end (Fast DDS #4076).
    writer->clear_history(nullptr);
    session.publisher->delete_datawriter(writer);
  }
  // True if another participant reads the topic.
  bool is_heard(fastdds::DataWriter& writer) const {
    fastdds::PublicationMatchedStatus status;
    writer.get_publication_matched_status(status);
    return status.current_count > own_readers_->load(std::memory_order_relaxed);
  }
  fastdds::PublicationMatchedStatus readers() const {
    const runtime::RealtimeScope scope = node_->realtime();
    const typename GuardedPointer<fastdds::DataWriter>::Use writer(writer_);
    fastdds::PublicationMatchedStatus status;
    if (writer) writer->get_publication_matched_status(status);
    return status;
  }

  std::shared_ptr<Impl> node_;
  const std::string vehicle_;
  const messages::Topic<T> topic_;
  const std::shared_ptr<std::atomic<int>> own_readers_;
  GuardedPointer<fastdds::DataWriter> writer_;
  std::atomic<std::uint64_t> changes_before_{0};  // in ended sessions
  int unacknowledged_ = 0;                        // at most; requests, with the one that is being written
  std::mutex last_mutex_;
  std::optional<T> last_;  // of a latched topic, sent again after rejoining
};

template <class Impl, class T>
class DdsReader final : public Reader, private Endpoint, private fastdds::DataReaderListener {
 public:
  using Callback = std::function<void(const T&)>;
  using RawCallback = std::function<void(const RawSample&)>;

  // One of the two callbacks is given.
  DdsReader(std::shared_ptr<Impl> node, std::string vehicle, const messages::Topic<T>& topic,
            Callback callback, RawCallback raw_callback, Delivery delivery, std::optional<OneSource> source,
            std::function<void(const std::string&)> on_fault)
      : node_(std::move(node)),
        vehicle_(std::move(vehicle)),
        topic_(topic),
        own_readers_(node_->own_readers(wire_name(vehicle_, topic_.name))),
        delivery_(delivery),
        log_label_(runtime::LogLabel::current()),
        on_fault_(std::move(on_fault)),
        callback_(std::move(callback)),
        raw_callback_(std::move(raw_callback)) {
    sample_.raw = raw_callback_ != nullptr;
    if (source) {
      source_.emplace(source->silence);
      on_next_source_ = std::move(source->on_next);
    }
    node_->add(this);
  }
  ~DdsReader() override { node_->remove(this); }
  DdsReader(const DdsReader&) = delete;
  DdsReader& operator=(const DdsReader&) = delete;

  int matched() const override {
    const runtime::RealtimeScope scope = node_->realtime();
    const typename GuardedPointer<fastdds::DataReader>::Use reader(reader_);
    fastdds::SubscriptionMatchedStatus status;
    if (reader) reader->get_subscription_matched_status(status);
    return status.current_count;
  }

  std::optional<SourceConflict> source_conflict() const override {
    std::optional<Conflict> last;
    {
      const std::lock_guard<std::mutex> lock(conflict_mutex_);
      last = conflict_;
    }
    if (!last || std::chrono::steady_clock::now() - last->at > kConflictReportTime) return std::nullopt;
    return SourceConflict{node_->identity_of(last->used.participant),
                          node_->identity_of(last->ignored.participant)};
  }

 private:
  struct Conflict {
    SenderId used;
    SenderId ignored;
    std::chrono::steady_clock::time_point at;
  };

  void join(ParticipantSession& session) override {
    open(true);
    own_participant_ = session.participant->guid().guidPrefix;
    fastdds::DataReaderQos qos = reader_qos(topic_.qos);
    state_type_hash(qos, RosTypeHash<T>::value());
    session.receive_in(delivery_, qos);
    fastdds::DataReader* const reader = session.subscriber->create_datareader(
        topic_in<T>(session, vehicle_, topic_.name), qos, this, fastdds::StatusMask::data_available());
    if (reader == nullptr) throw std::runtime_error(std::string("cannot subscribe to ") + topic_.name);
    session.note_receiver(delivery_, *reader);
    ++*own_readers_;
    reader_.give(reader);
  }
  void leave(ParticipantSession& session) override {
    fastdds::DataReader* const reader = reader_.take();
    if (reader == nullptr) return;
    open(false);
    --*own_readers_;
    reader->set_listener(nullptr);
    session.subscriber->delete_datareader(reader);
  }
  void open(bool open) {
    const std::lock_guard<std::mutex> lock(mutex_);
    open_ = open;
  }

  void on_data_available(fastdds::DataReader* reader) override {
    const std::lock_guard<std::mutex> lock(mutex_);
    const runtime::LogLabel label(log_label_);
    fastdds::SampleInfo info;
    while (open_ && !faulty_ && succeeded(reader->take_next_sample(&sample_, &info))) {
      if (!info.valid_data) continue;
      if (info.sample_identity.writer_guid().guidPrefix == own_participant_) continue;
      if (source_ && !is_from_source(info)) continue;
      deliver(info);
    }
  }

  void deliver(const fastdds::SampleInfo& info) {
    if (!on_fault_) return call_or_end(info);
    try {
      call(info);
    } catch (const std::exception& error) {
      faulty_ = true;
      on_fault_(error.what());
    }
  }

  // Ends the process if the callback throws: the transport below would take its exception for one of Fast DDS.
  void call_or_end(const fastdds::SampleInfo& info) noexcept { call(info); }

  void call(const fastdds::SampleInfo& info) {
    if (callback_) return callback_(sample_.message);
    raw_callback_({sample_.payload.data(), sample_.payload.size(), info.source_timestamp.to_ns(),
                   info.sample_identity.sequence_number().to64long(),
                   number_of(info.sample_identity.writer_guid())});
  }

  // Never waits: what a reader of the conflict misses, the next ignored sample reports.
  bool is_from_source(const fastdds::SampleInfo& info) {
    const SenderId sender{info.sample_identity.writer_guid().guidPrefix};
    const auto now = std::chrono::steady_clock::now();
    const std::optional<SenderId> before = source_->id();
    if (source_->accepts(sender, now)) {
      if (on_next_source_ && before && !(*before == sender)) on_next_source_();
      return true;
    }
    const std::unique_lock<std::mutex> lock(conflict_mutex_, std::try_to_lock);
    if (lock) conflict_ = Conflict{*source_->id(), sender, now};
    return false;
  }

  std::shared_ptr<Impl> node_;
  const std::string vehicle_;
  const messages::Topic<T> topic_;
  const std::shared_ptr<std::atomic<int>> own_readers_;
  const Delivery delivery_;
  const std::string log_label_;  // of the thread that subscribed
  const std::function<void(const std::string&)> on_fault_;
  GuardedPointer<fastdds::DataReader> reader_;
  mutable std::mutex conflict_mutex_;
  std::optional<Conflict> conflict_;
  std::mutex mutex_;  // guards all below; held while a callback runs
  Callback callback_;
  RawCallback raw_callback_;
  std::optional<SingleSource<SenderId>> source_;
  std::function<void()> on_next_source_;
  ReceivedSample<T> sample_;
  fastrtps::GuidPrefix_t own_participant_;
  bool open_ = false;
  bool faulty_ = false;  // the callback threw an exception
};

}  // namespace detail

template <class T>
Publisher<T> Node::publish(const messages::Topic<T>& topic) {
  return Publisher<T>(
      std::make_unique<detail::DdsWriter<Participant::Impl, T>>(participant_.impl_, vehicle_, topic));
}

template <class T>
Subscription Node::subscribe(const messages::Topic<T>& topic, std::function<void(const T&)> callback,
                             Delivery delivery, std::optional<OneSource> source) {
  return Subscription(std::make_unique<detail::DdsReader<Participant::Impl, T>>(
      participant_.impl_, vehicle_, topic, std::move(callback), nullptr, delivery, std::move(source),
      on_fault_));
}

template <class T>
Subscription Node::subscribe_raw(const messages::Topic<T>& topic,
                                 std::function<void(const RawSample&)> callback, Delivery delivery) {
  return Subscription(std::make_unique<detail::DdsReader<Participant::Impl, T>>(
      participant_.impl_, vehicle_, messages::Topic<T>{topic.name, topic.qos}, nullptr, std::move(callback),
      delivery, std::nullopt, on_fault_));
}

}  // namespace swiftlet::dds
