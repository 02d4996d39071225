#include "swiftlet/ground/recording/flight_recorder.hpp"

#include <algorithm>
#include <cstring>
#include <exception>
#include <map>
#include <utility>

#include "swiftlet/services/messages/all_topics.hpp"

namespace swiftlet::ground {
namespace {

using namespace std::chrono_literals;

constexpr auto kBatchPeriod = 100ms;
constexpr auto kFlushPeriod = 500ms;
constexpr const char* kCounts = "swiftlet/counts";

std::int64_t wall_now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

// Samples come for each sample of the IMU: each such topic has a socket of its own.
bool is_fast(comms::Qos qos, const std::string& topic) {
  return qos == comms::Qos::kOwnedStream || topic == comms::topics::kImu.name ||
         topic == comms::topics::kRotorSpeeds.name;
}

}  // namespace

struct FlightRecorder::Vehicle {
  std::string name;
  std::unique_ptr<comms::Node> node;
  std::atomic<std::int64_t> newest_stamp_ns{0};
  std::vector<comms::Subscription> subscriptions;  // last: their callbacks use all members above
};

struct FlightRecorder::Channel {
  Vehicle& vehicle;
  std::string topic;
  std::uint16_t id;
  int stamp_offset;
  GapCounter gaps;  // of the thread that receives the topic
  std::atomic<std::uint64_t> received{0};
  std::atomic<std::uint64_t> dropped{0};
  std::atomic<std::uint64_t> lost{0};
};

FlightRecorder::FlightRecorder(const comms::Participant& participant, std::filesystem::path file,
                               RecorderSettings settings)
    : settings_(std::move(settings)),
      participant_(participant),
      queue_(settings_.queue_bytes),
      file_(std::move(file), settings_.file),
      writer_([this] { write_until_stopped(); }) {}

FlightRecorder::~FlightRecorder() { stop(); }

// A fault ends the file; the process goes on.
template <class Work>
void FlightRecorder::use_file(const Work& work) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (failed_) return;
  try {
    work(file_);
    file_bytes_ = file_.file_bytes();
  } catch (const std::exception& error) {
    fault_ = error.what();
    failed_ = true;
  }
}

void FlightRecorder::add(const mcap::Metadata& metadata) {
  use_file([&](mcap::Writer& file) { file.write(metadata); });
}

void FlightRecorder::add(const mcap::Attachment& attachment) {
  use_file([&](mcap::Writer& file) { file.write(attachment); });
}

void FlightRecorder::add_vehicle(const std::string& name) {
  vehicles_.push_back(std::make_unique<Vehicle>());
  Vehicle& vehicle = *vehicles_.back();
  vehicle.name = name;
  vehicle.node = std::make_unique<comms::Node>(participant_, name);
  comms::for_each_topic([&](const auto& topic) { subscribe(vehicle, topic); });
}

template <class T>
void FlightRecorder::subscribe(Vehicle& vehicle, const comms::Topic<T>& topic) {
  const comms::MessageSchema& schema = comms::schema_of<T>();
  const std::string name = "/" + vehicle.name + "/" + topic.name;
  std::uint16_t id = 0;
  use_file([&](mcap::Writer& file) {
    auto known = std::find_if(schemas_.begin(), schemas_.end(),
                              [&](const auto& written) { return written.first == &schema; });
    if (known == schemas_.end())
      known = schemas_.insert(known, {&schema, file.add_schema(schema.name, "ros2msg", schema.definition)});
    id = file.add_channel(name, known->second, "cdr", {});
  });
  const Writers writers = topic.qos == comms::Qos::kOwnedStream ? Writers::kStrongest : Writers::kAll;
  Channel* channel = nullptr;
  {
    const std::lock_guard<std::mutex> lock(channels_mutex_);
    channels_.push_back(
        std::unique_ptr<Channel>(new Channel{vehicle, name, id, schema.stamp_offset, GapCounter(writers)}));
    channel = channels_.back().get();
  }
  vehicle.subscriptions.push_back(vehicle.node->subscribe_raw<T>(
      topic, [this, channel](const comms::RawSample& sample) { receive(*channel, sample); },
      is_fast(topic.qos, topic.name) ? comms::Delivery::kOwnThread : comms::Delivery::kShared));
}

void FlightRecorder::receive(Channel& channel, const comms::RawSample& sample) {
  channel.received.fetch_add(1, std::memory_order_relaxed);
  channel.lost.fetch_add(channel.gaps.missing_before(sample.writer, sample.sequence_number),
                         std::memory_order_relaxed);
  mcap::Message message{channel.id,
                        static_cast<std::uint32_t>(sample.sequence_number),
                        wall_now_ns(),
                        sample.source_stamp_ns,
                        {sample.payload, sample.size}};
  if (settings_.clock == RecordClock::kVehicle) {
    std::int64_t stamp_ns = 0;
    const auto at = static_cast<std::size_t>(channel.stamp_offset);
    if (channel.stamp_offset >= 0 && at + sizeof(stamp_ns) <= sample.size) {
      std::memcpy(&stamp_ns, sample.payload + at, sizeof(stamp_ns));
      if (stamp_ns > channel.vehicle.newest_stamp_ns) channel.vehicle.newest_stamp_ns = stamp_ns;
      message.log_time_ns = stamp_ns;
    } else {
      message.log_time_ns = channel.vehicle.newest_stamp_ns;
    }
    message.publish_time_ns = message.log_time_ns;
  }
  if (failed_ || !queue_.put(message)) channel.dropped.fetch_add(1, std::memory_order_relaxed);
}

void FlightRecorder::write_until_stopped() {
  auto flushed = std::chrono::steady_clock::now();
  for (bool last = false; !last;) {
    last = stopping_;  // what was put before is taken once more
    queue_.take_all(last ? 0ms : kBatchPeriod, [this](const mcap::Message& message) {
      use_file([&](mcap::Writer& file) { file.write(message); });
    });
    const auto now = std::chrono::steady_clock::now();
    if (now - flushed < kFlushPeriod) continue;
    flushed = now;
    use_file([](mcap::Writer& file) { file.flush(); });
  }
}

void FlightRecorder::stop() {
  if (!writer_.joinable()) return;
  vehicles_.clear();  // no sample comes any more
  stopping_ = true;
  writer_.join();
  write_counts();
  use_file([](mcap::Writer& file) { file.close(); });
}

void FlightRecorder::write_counts() {
  const RecorderTotals sums = totals();
  std::map<std::string, std::string> counts = {{"received", std::to_string(sums.received)},
                                               {"dropped", std::to_string(sums.dropped)},
                                               {"lost", std::to_string(sums.lost)}};
  {
    const std::lock_guard<std::mutex> lock(channels_mutex_);
    for (const auto& channel : channels_) {
      if (channel->dropped > 0) counts["dropped " + channel->topic] = std::to_string(channel->dropped);
      if (channel->lost > 0) counts["lost " + channel->topic] = std::to_string(channel->lost);
    }
  }
  add(mcap::Metadata{kCounts, counts});
}

RecorderTotals FlightRecorder::totals() const {
  RecorderTotals sums;
  const std::lock_guard<std::mutex> lock(channels_mutex_);
  for (const auto& channel : channels_) {
    sums.received += channel->received;
    sums.dropped += channel->dropped;
    sums.lost += channel->lost;
    sums.topics += channel->received > 0 ? 1 : 0;
  }
  sums.file_bytes = file_bytes_;
  return sums;
}

std::optional<std::string> FlightRecorder::fault() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return fault_;
}

}  // namespace swiftlet::ground
