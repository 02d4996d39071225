#include "swiftlet/ground/flight/message_record.hpp"

#include <chrono>

#include <fmt/format.h>

#include "swiftlet/ground/flight/flight_description.hpp"
#include "swiftlet/ground/recording/process_log.hpp"
#include "swiftlet/io/logs/flight_log_files.hpp"
#include "swiftlet/services/runtime/clock.hpp"

namespace swiftlet::ground {
namespace {

RecorderSettings settings_of(const Fleet& fleet) {
  RecorderSettings settings;
  settings.file = writer_settings(fleet.program);
  if (fleet.plans.front().clock == runtime::Clock::kLockstep) settings.clock = RecordClock::kVehicle;
  return settings;
}

std::int64_t now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

comms::NodeSettings listener(comms::NodeSettings network) {
  network.source_of.clear();
  return network;
}

}  // namespace

MessageRecord::MessageRecord(const comms::NodeSettings& network, const Fleet& fleet)
    : participant_(listener(network)),
      recorder_(participant_, fleet.folder / kMessagesFile, settings_of(fleet)),
      folder_(fleet.folder),
      simulated_time_(settings_of(fleet).clock == RecordClock::kVehicle) {
  recorder_.add(flight_metadata(fleet));
  for (const mcap::Attachment& attachment : flight_attachments(fleet)) recorder_.add(attachment);
  for (const std::string& vehicle : fleet.vehicles) recorder_.add_vehicle(vehicle);
}

std::string MessageRecord::finish() {
  if (!simulated_time_) {
    for (const ProcessLogLine& line : process_log_lines(folder_, now_ns()))
      recorder_.add(log_message(line), line.time_ns);
  }
  recorder_.stop();
  if (const auto fault = recorder_.fault()) return *fault;
  const RecorderTotals totals = recorder_.totals();
  if (totals.dropped + totals.lost == 0) return {};
  return fmt::format("{}: {} messages dropped because the disk is too slow, {} lost on their way",
                     kMessagesFile, totals.dropped, totals.lost);
}

}  // namespace swiftlet::ground
