// Opens serial devices.
#pragma once

#include <string>

namespace swiftlet::runtime {

// Why the system has no such rate: a sentence; empty if it has.
std::string fault_of_baud(int baud);

// Opens a device for raw bytes in both directions: 8 data bits, no parity, 1 stop bit, no flow control. What was received
// before is discarded. Reading and writing do not wait; a read of 0 bytes means that the device has vanished. Returns the
// descriptor, or the negative errno of the fault: -EBUSY if another process has opened it by this function. Does not allocate.
// Precondition: fault_of_baud(baud) is empty.
int open_serial_device(const char* device, int baud) noexcept;

}  // namespace swiftlet::runtime
