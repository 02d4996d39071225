// Settings of the Fast DDS library that hold for the whole process.
#pragma once

namespace swiftlet::comms {

// The messages of Fast DDS go to stderr, because stdout belongs to the program; to no other place.
void log_fast_dds_to_stderr();

// Call it before the first participant of the process; later calls have no effect.
void set_up_fast_dds();

}  // namespace swiftlet::comms
