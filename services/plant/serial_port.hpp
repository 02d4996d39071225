// Opens serial devices.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "swiftlet/services/plant/byte_stream.hpp"

namespace swiftlet::services {

const std::vector<std::string>& serial_bauds();  // "57600", ...: those that open_serial_port() takes

// Opens a device for raw bytes, 8 data bits, no parity, one stop bit, no flow control. Throws std::runtime_error if it
// cannot be opened or is no serial device.
std::unique_ptr<ByteStream> open_serial_port(const std::string& device, int baud);

}  // namespace swiftlet::services
