// Settings of the Fast DDS library that hold for the whole process.
#pragma once

namespace swiftlet::dds {

// Call it before the first participant of the process. The errors of Fast DDS go to stderr, because stdout belongs to the program.
// tells_refusals: from now on also the warnings that say why a participant was refused, some of them if there are many.
void set_up_fast_dds(bool tells_refusals = false);

}  // namespace swiftlet::dds
