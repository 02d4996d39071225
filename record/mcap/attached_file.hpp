// Files that are attached to the recording of a flight (ground/flight/flight_description.hpp).
#pragma once

#include <optional>
#include <string>

#include "swiftlet/record/mcap/reader.hpp"

namespace swiftlet::mcap {

// The text of the file `name`, such as "control.yaml": that of this vehicle, attached as "kl2/control.yaml", or else that of
// all. nullopt if there is none. Throws ConfigError if the file is damaged.
std::optional<std::string> attached_file(const Reader& file, const std::string& vehicle,
                                         const std::string& name);

}  // namespace swiftlet::mcap
