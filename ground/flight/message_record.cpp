#include "swiftlet/ground/flight/message_record.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include <fmt/format.h>

#include "swiftlet/ground/flight/flight_description.hpp"
#include "swiftlet/record/file/flight_reader.hpp"
#include "swiftlet/record/file/process_log.hpp"
#include "swiftlet/record/file/recorded_faults.hpp"
#include "swiftlet/services/runtime/clock.hpp"

namespace swiftlet::ground {
namespace {

bool is_in_simulated_time(const Fleet& fleet) {
  return fleet.plans.front().clock == runtime::Clock::kLockstep;
}

std::int64_t now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

dds::NodeSettings listener(dds::NodeSettings network) {
  network.source_of.clear();
  return network;
}

}  // namespace

MessageRecord::MessageRecord(const dds::NodeSettings& network, const Fleet& fleet)
    : participant_(listener(network)),
      recorder_(participant_, fleet.folder / record::kFlightFile, settings_of(fleet)),
      folder_(fleet.folder),
      simulated_time_(is_in_simulated_time(fleet)),
      faults_(record::fault_rows(fleet.plans.front().simulation)) {
  recorder_.add(flight_metadata(fleet));
  for (const mcap::Attachment& attachment : flight_attachments(fleet)) recorder_.add(attachment);
  for (const std::string& vehicle : fleet.vehicles) recorder_.add_vehicle(vehicle);
}

record::RecorderSettings MessageRecord::settings_of(const Fleet& fleet) {
  record::RecorderSettings settings;
  settings.file = writer_settings(fleet.program);
  if (is_in_simulated_time(fleet)) settings.clock = record::RecordClock::kVehicle;
  settings.on_motion = [this](const std::string& vehicle, std::int64_t stamp_ns) {
    const std::lock_guard<std::mutex> lock(mutex_);
    newest_ns_ = std::max(newest_ns_, stamp_ns);
    const auto use = on_motion_.find(vehicle);
    if (use != on_motion_.end() && use->second) use->second(stamp_ns);
  };
  return settings;
}

void MessageRecord::on_motion(const std::string& vehicle, std::function<void(std::int64_t)> use) {
  const std::lock_guard<std::mutex> lock(mutex_);
  on_motion_[vehicle] = std::move(use);
}

std::string MessageRecord::finish() {
  if (!simulated_time_) {
    for (const record::ProcessLogLine& line : record::process_log_lines(folder_, now_ns()))
      recorder_.add(record::log_message(line), line.time_ns);
  } else {
    const std::lock_guard<std::mutex> lock(mutex_);
    for (const record::FaultRow& fault : faults_) {
      if (fault.from_ns <= newest_ns_)
        recorder_.add(record::log_message(record::log_line(fault)), fault.from_ns);
    }
  }
  recorder_.stop();
  if (const auto fault = recorder_.fault()) return *fault;
  const std::uint64_t dropped = recorder_.totals().dropped;
  if (dropped == 0) return {};
  return fmt::format("{}: {} messages dropped because the disk is too slow", record::kFlightFile, dropped);
}

}  // namespace swiftlet::ground
