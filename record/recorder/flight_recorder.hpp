// Records every message of vehicles as an MCAP file: the payloads as they came, with ROS 2 message definitions.
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "swiftlet/record/file/message_file.hpp"
#include "swiftlet/record/mcap/writer.hpp"
#include "swiftlet/record/recorder/gap_counter.hpp"
#include "swiftlet/record/recorder/sample_queue.hpp"
#include "swiftlet/services/dds/node.hpp"
#include "swiftlet/services/messages/topics.hpp"
#include "swiftlet/services/runtime/periodic_timer.hpp"

namespace swiftlet::record {

struct RecorderSettings {
  mcap::WriterSettings file{};
  RecordClock clock = RecordClock::kWall;
  bool standard_messages = true;  // also those of standard_messages.hpp
  std::size_t queue_bytes = std::size_t{64} << 20;
  // Called, in the thread that receives it, with the stamp of each sample of IMU or odometry; may be empty. One that is sent again, by a
  // vehicle whose time stands still, tells that none is under way: with the stamp of vehicle_info if that is later.
  std::function<void(const std::string& vehicle, std::int64_t stamp_ns)> on_motion{};
};

// What a recorder has done so far.
struct RecorderTotals {
  std::uint64_t received = 0;
  std::uint64_t dropped = 0;  // received, but the queue was full: the disk is too slow
  std::uint64_t lost = 0;     // sent, but never received: gaps in the numbers of the samples
  std::size_t topics = 0;     // with at least one message
  std::uint64_t file_bytes = 0;
};

// The files that a controller flies with are attached as VEHICLE/vehicle.yaml and VEHICLE/control.yaml when it tells them, unless an
// attachment has the same content already. The threads that receive only copy into a bounded queue; one thread writes. Everything older than a second is in the
// file, however the process ends.
class FlightRecorder {
 public:
  // Throws std::runtime_error if the file cannot be created.
  FlightRecorder(const dds::Participant& participant, std::filesystem::path file, RecorderSettings settings);
  ~FlightRecorder();  // ends the file as stop() does
  FlightRecorder(const FlightRecorder&) = delete;
  FlightRecorder& operator=(const FlightRecorder&) = delete;

  // From one thread. add_vehicle throws std::runtime_error.
  void add_vehicle(const std::string& name);
  void add(const mcap::Metadata& metadata);
  void add(const mcap::Attachment& attachment);
  void add(const StandardMessage& message, std::int64_t time_ns);

  // Whether it has received the first samples of this vehicle: of its sensors, its motion capture and its controller.
  bool hears(const std::string& vehicle) const;

  RecorderTotals totals() const;
  // Why it records no more, as a sentence: the disk is full.
  std::optional<std::string> fault() const;

  // Writes what was received and a table of each topic's counts as metadata, and ends the file.
  void stop();

 private:
  struct Vehicle;
  struct Channel;

  template <class T>
  void subscribe(Vehicle& vehicle, const messages::Topic<T>& topic);
  void receive(Channel& channel, const dds::RawSample& sample);
  void note_files(const std::string& vehicle, const dds::RawSample& sample);
  void attach_files();
  void attach(const std::string& vehicle, const std::string& name, const messages::msg::SettingsFile& told);
  void write_until_stopped();
  void write_counts();
  template <class Work>
  void use_file(const Work& work);

  const RecorderSettings settings_;
  const dds::Participant participant_;
  std::map<std::string, std::string> attached_;  // content by name; guarded by mutex_
  std::mutex told_mutex_;
  std::map<std::string, messages::msg::FlownFiles>
      told_files_;  // by vehicle, not attached yet; guarded by told_mutex_
  // The wall clock of the file goes on evenly when the system clock is set: what was sent later stands later.
  const std::int64_t system_minus_monotonic_ns_ = runtime::system_ns() - runtime::monotonic_ns();
  SampleQueue queue_;
  mutable std::mutex mutex_;  // guards file_ and fault_; held while a batch is written
  MessageFile file_;
  std::optional<std::string> fault_;
  std::atomic<bool> failed_{false};
  std::atomic<bool> stopping_{false};
  std::atomic<std::uint64_t> file_bytes_{0};
  mutable std::mutex channels_mutex_;  // guards channels_
  std::vector<std::unique_ptr<Channel>> channels_;
  std::thread writer_;
  std::vector<std::unique_ptr<Vehicle>> vehicles_;  // last: their callbacks use all members above
};

}  // namespace swiftlet::record
