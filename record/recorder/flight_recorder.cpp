#include "swiftlet/record/recorder/flight_recorder.hpp"

#include <algorithm>
#include <cstring>
#include <exception>
#include <limits>
#include <map>
#include <utility>

#include "swiftlet/services/dds/payload.hpp"

namespace swiftlet::record {
namespace {

using namespace std::chrono_literals;

constexpr auto kBatchPeriod = 100ms;
constexpr auto kFlushPeriod = 500ms;
constexpr const char* kClocks = "swiftlet/clocks";

bool is_motion(const std::string& topic) {
  return topic == messages::topics::kImu.name || topic == messages::topics::kVehicleOdometry.name;
}
bool is_command(const std::string& topic) {
  return topic == messages::topics::kActuatorCommand.name || topic == messages::topics::kRatesSetpoint.name ||
         topic == messages::topics::kAttitudeSetpoint.name ||
         topic == messages::topics::kTrajectorySetpoint.name;
}
bool is_info(const std::string& topic) { return topic == messages::topics::kVehicleInfo.name; }
bool is_files(const std::string& topic) { return topic == messages::topics::kFlownFiles.name; }
bool is_pose(const std::string& topic) { return topic == messages::topics::kMocapPose.name; }
// Samples come for each sample of the IMU, in lockstep hundreds at once.
bool is_fast(const std::string& topic) {
  return is_motion(topic) || is_command(topic) || topic == messages::topics::kRotorSpeeds.name;
}

std::optional<std::int64_t> stamp_of(const dds::RawSample& sample, int offset) {
  std::int64_t stamp_ns = 0;
  const auto at = static_cast<std::size_t>(offset);
  if (offset < 0 || at + sizeof(stamp_ns) > sample.size) return std::nullopt;
  std::memcpy(&stamp_ns, sample.payload + at, sizeof(stamp_ns));
  return stamp_ns;
}

}  // namespace

struct FlightRecorder::Vehicle {
  explicit Vehicle(std::string vehicle_name) : name(std::move(vehicle_name)) {}

  std::string name;
  std::unique_ptr<dds::Node> node;
  std::atomic<std::int64_t> newest_stamp_ns{0};
  std::atomic<std::int64_t> motion_ns{-1};  // stamp of the newest sample of IMU or odometry
  std::atomic<std::int64_t> info_ns{-1};    // and of vehicle_info
  // The least age of an IMU sample: its arrival by the wall clock minus its stamp.
  std::atomic<std::int64_t> least_age_ns{std::numeric_limits<std::int64_t>::max()};
  std::vector<dds::Subscription> subscriptions;  // last: their callbacks use all members above
};

struct FlightRecorder::Channel {
  Vehicle& vehicle;
  const char* name;   // "imu"
  std::string topic;  // "/kl1/imu"
  std::uint16_t id;
  int stamp_offset;
  GapCounter gaps;  // of the thread that receives the topic
  std::atomic<std::uint64_t> received{0};
  std::atomic<std::uint64_t> dropped{0};
  std::atomic<std::uint64_t> lost{0};
};

FlightRecorder::FlightRecorder(const dds::Participant& participant, std::filesystem::path file,
                               RecorderSettings settings)
    : settings_(std::move(settings)),
      participant_(participant),
      queue_(settings_.queue_bytes),
      file_(std::move(file), settings_.file, settings_.standard_messages),
      writer_([this] { write_until_stopped(); }) {
  add(recorder_metadata(settings_.clock));
}

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
  use_file([&](MessageFile& file) { file.write(metadata); });
}

void FlightRecorder::add(const mcap::Attachment& attachment) {
  use_file([&](MessageFile& file) {
    file.write(attachment);
    attached_[attachment.name] = attachment.data;
  });
}

void FlightRecorder::note_files(const std::string& vehicle, const dds::RawSample& sample) {
  messages::msg::FlownFiles files;
  if (!dds::from_payload(sample.payload, sample.size, files)) return;
  const std::lock_guard<std::mutex> lock(told_mutex_);
  told_files_[vehicle] = std::move(files);
}

void FlightRecorder::attach_files() {
  std::map<std::string, messages::msg::FlownFiles> told;
  {
    const std::lock_guard<std::mutex> lock(told_mutex_);
    told.swap(told_files_);
  }
  for (const auto& [vehicle, files] : told) {
    attach(vehicle, "vehicle.yaml", files.vehicle());
    attach(vehicle, "control.yaml", files.control());
  }
}

void FlightRecorder::attach(const std::string& vehicle, const std::string& name,
                            const messages::msg::SettingsFile& told) {
  const std::string content = told.text().c_str();
  const std::string own_name = vehicle + "/" + name;
  use_file([&](MessageFile& file) {
    const std::string& known = attached_.count(own_name) > 0 ? attached_[own_name] : attached_[name];
    if (content.empty() || content == known) return;
    const std::int64_t now_ns = runtime::system_ns();
    file.write(mcap::Attachment{now_ns, now_ns, own_name, "application/yaml", content});
    attached_[own_name] = content;
  });
}

void FlightRecorder::add(const StandardMessage& message, std::int64_t time_ns) {
  use_file([&](MessageFile& file) { file.write(message, time_ns); });
}

void FlightRecorder::add_vehicle(const std::string& name) {
  vehicles_.push_back(std::make_unique<Vehicle>(name));
  Vehicle& vehicle = *vehicles_.back();
  vehicle.node = std::make_unique<dds::Node>(participant_, name);
  messages::for_each_topic([&](const auto& topic) { subscribe(vehicle, topic); });
}

template <class T>
void FlightRecorder::subscribe(Vehicle& vehicle, const messages::Topic<T>& topic) {
  const messages::MessageSchema& schema = messages::schema_of<T>();
  const std::string name = "/" + vehicle.name + "/" + topic.name;
  std::uint16_t id = 0;
  use_file([&](MessageFile& file) { id = file.add_channel(vehicle.name, topic.name, schema); });
  Channel* channel = nullptr;
  {
    const std::lock_guard<std::mutex> lock(channels_mutex_);
    channels_.push_back(std::unique_ptr<Channel>(
        new Channel{vehicle, topic.name, name, id, schema.stamp_offset, GapCounter()}));
    channel = channels_.back().get();
  }
  vehicle.subscriptions.push_back(vehicle.node->subscribe_raw<T>(
      topic, [this, channel](const dds::RawSample& sample) { receive(*channel, sample); },
      is_fast(topic.name) ? dds::Delivery::kOwn : dds::Delivery::kShared));
}

void FlightRecorder::receive(Channel& channel, const dds::RawSample& sample) {
  channel.received.fetch_add(1, std::memory_order_relaxed);
  channel.lost.fetch_add(channel.gaps.missing_before(sample.writer, sample.sequence_number),
                         std::memory_order_relaxed);
  mcap::Message message{channel.id,
                        static_cast<std::uint32_t>(sample.sequence_number),
                        runtime::monotonic_ns() + system_minus_monotonic_ns_,
                        sample.source_stamp_ns,
                        {sample.payload, sample.size}};
  Vehicle& vehicle = channel.vehicle;
  const auto stamp_ns = stamp_of(sample, channel.stamp_offset);
  if (stamp_ns && is_motion(channel.name)) {
    vehicle.least_age_ns = std::min(vehicle.least_age_ns.load(), message.log_time_ns - *stamp_ns);
    const bool again = vehicle.motion_ns.exchange(*stamp_ns) == *stamp_ns;
    const std::int64_t known_ns = again ? std::max(*stamp_ns, vehicle.info_ns.load()) : *stamp_ns;
    if (settings_.on_motion) settings_.on_motion(vehicle.name, known_ns);
  }
  if (stamp_ns && is_info(channel.name)) vehicle.info_ns = *stamp_ns;
  if (is_files(channel.name)) note_files(vehicle.name, sample);
  if (settings_.clock == RecordClock::kVehicle) {
    if (stamp_ns && *stamp_ns > vehicle.newest_stamp_ns) vehicle.newest_stamp_ns = *stamp_ns;
    message.log_time_ns = stamp_ns.value_or(vehicle.newest_stamp_ns);
    message.publish_time_ns = message.log_time_ns;
  }
  if (failed_ || !queue_.put(message)) channel.dropped.fetch_add(1, std::memory_order_relaxed);
}

void FlightRecorder::write_until_stopped() {
  auto flushed = std::chrono::steady_clock::now();
  for (bool last = false; !last;) {
    last = stopping_;  // what was put before is taken once more
    queue_.take_all(last ? 0ms : kBatchPeriod, [this](const mcap::Message& message) {
      use_file([&](MessageFile& file) { file.write(message); });
    });
    const auto now = std::chrono::steady_clock::now();
    if (now - flushed < kFlushPeriod) continue;
    flushed = now;
    attach_files();
    use_file([](MessageFile& file) { file.flush(); });
  }
}

void FlightRecorder::stop() {
  if (!writer_.joinable()) return;
  for (const auto& vehicle : vehicles_) vehicle->subscriptions.clear();  // no sample comes any more
  stopping_ = true;
  writer_.join();
  attach_files();
  write_counts();
  use_file([](MessageFile& file) { file.close(); });
}

void FlightRecorder::write_counts() {
  const RecorderTotals sums = totals();
  std::map<std::string, std::uint64_t> counts = {
      {"received", sums.received}, {"dropped", sums.dropped}, {"lost", sums.lost}};
  {
    const std::lock_guard<std::mutex> lock(channels_mutex_);
    for (const auto& channel : channels_) {
      if (channel->dropped > 0) counts["dropped " + channel->topic] = channel->dropped;
      if (channel->lost > 0) counts["lost " + channel->topic] = channel->lost;
    }
  }
  add(counts_metadata(counts));
  std::map<std::string, std::string> clocks;
  for (const auto& vehicle : vehicles_) {
    if (vehicle->least_age_ns != std::numeric_limits<std::int64_t>::max())
      clocks["wall_minus_stamp_ns " + vehicle->name] = std::to_string(vehicle->least_age_ns);
  }
  add(mcap::Metadata{kClocks, clocks});
}

bool FlightRecorder::hears(const std::string& vehicle) const {
  bool sensors = false, motion_capture = false, control = false;
  const std::lock_guard<std::mutex> lock(channels_mutex_);
  for (const auto& channel : channels_) {
    if (channel->vehicle.name != vehicle || channel->received == 0) continue;
    sensors = sensors || is_motion(channel->name);
    motion_capture = motion_capture || is_pose(channel->name);
    control = control || is_command(channel->name);
  }
  return sensors && motion_capture && control;
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

}  // namespace swiftlet::record
