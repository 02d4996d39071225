// Publishes vehicle_info and logs what becomes of the link. For the main thread: it allocates.
#pragma once

#include <cstdint>
#include <string>

#include "swiftlet/plant/model/vehicle.hpp"
#include "swiftlet/services/dds/node.hpp"
#include "swiftlet/services/vehicle_template/link_measurements.hpp"

namespace swiftlet::services {

class LinkReporter {
 public:
  // link: as the user named it.
  LinkReporter(dds::Node& node, const plant::Vehicle& vehicle, std::string link, std::uint32_t boot);

  // Logs what has changed.
  void update(const LinkMeasurements& measurements);
  // Publishes vehicle_info every second, and at once when the rotors start or stop or the link comes or goes. Not before the
  // first update(): nothing is known of the link.
  void publish_due();
  // Why this microcontroller cannot be flown: a sentence; empty if it can, or is not known yet.
  std::string fault_of_microcontroller() const;
  void log_end() const;

 private:
  bool is_connected() const { return last_.link.state == LinkState::kConnected; }
  std::string fault_of_vehicle() const;
  void log_link(const LinkMeasurements& before) const;
  void log_rotors(const LinkMeasurements& before) const;
  void log_frames();

  const std::string link_;
  const int rotor_count_;
  dds::Publisher<messages::msg::VehicleInfo> publisher_;
  messages::msg::VehicleInfo info_;
  LinkMeasurements last_;
  LinkMeasurements logged_;
  bool clock_logged_ = false;
  bool changed_ = true;
  bool updated_ = false;
  std::int64_t due_ns_ = 0;
  std::int64_t frames_due_ns_ = 0;
};

}  // namespace swiftlet::services
