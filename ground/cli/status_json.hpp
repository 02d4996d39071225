// The state of a vehicle as JSON, and the names of its parts.
#pragma once

#include <cstdint>
#include <string>

#include <nlohmann/json.hpp>

#include "swiftlet/ground/cli/commands.hpp"
#include "swiftlet/ground/client/client.hpp"
#include "swiftlet/ground/client/controllers.hpp"

namespace swiftlet::ground {

struct TopicRates {
  double estimate_hz = 0.0;
  double reference_hz = 0.0;
  double battery_hz = 0.0;
  double ground_truth_hz = 0.0;
};

// A value that is not known is null.
// mismatches: of types, QoS and topic names, a sentence each.
nlohmann::ordered_json status_json(const View& view, const TopicRates& rates, const CommandOptions& options,
                                   const std::vector<std::string>& mismatches);

std::string levels_text(std::uint8_t bits);  // the names of the LEVEL_* of VehicleInfo
const char* role_name(const LiveController& controller);
const char* kind_name(const msg::RequestStatus& request);
const char* state_name(const msg::RequestStatus& request);

}  // namespace swiftlet::ground
