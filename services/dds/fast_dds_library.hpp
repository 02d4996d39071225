// Settings of the Fast DDS library that hold for the whole process.
#pragma once

#include <string>

namespace swiftlet::comms {

// The errors of Fast DDS go to stderr, because stdout belongs to the program. Its warnings go to the function of
// hear_fast_dds_warnings(), if there is one. Call it after another consumer of the messages was set.
void log_fast_dds();

// Thread-safe, and runs in the thread of the log. category: "SECURITY_AUTHENTICATION".
using FastDdsWarningListener = void (*)(const std::string& category, const std::string& message);
// A new function replaces the previous one. Without one, Fast DDS makes no warnings.
void hear_fast_dds_warnings(FastDdsWarningListener listener);

// Call it before the first participant of the process; later calls have no effect.
void set_up_fast_dds();

}  // namespace swiftlet::comms
