// Binary logs of the Crazyflie's uSD logger (tools/usdlog/cfusdlog.py of crazyflie-firmware), versions 1 and 2:
//
//   0xBC, version (uint16), number of event types (uint16)
//   an event type: id (uint16), name, number of variables (uint16), then each as "stateEstimate.x(f)"; names end with a NUL
//   an event: id (uint16), stamp (version 1: uint32, ms; version 2: uint64, us), its variables one after the other
//   CRC-32 of all before (uint32)
//
// Numbers are little-endian. Types of variables are those of Python's struct: b B h H i I q Q e f d.
#pragma once

#include <string>
#include <string_view>

#include "swiftlet/io/missions/mission_table.hpp"

namespace swiftlet::io {

bool is_crazyflie_log(std::string_view bytes);

// Returns the columns t, x, y, z and, if it is logged, yaw: s since the first row, m and rad, of stateEstimate, a row for
// each event.
// Throws io::ConfigError for a log that is cut or damaged, of another version, or without the estimated position.
MissionTable read_crazyflie_log(std::string_view bytes, const std::string& file_name);

}  // namespace swiftlet::io
