// Keeps Fast DDS from ending the process when a participant leaves just as its lease is checked.
#pragma once

namespace swiftlet::comms {

// Call it before the first participant of the process. Programs that link this library have the replacement then; a module
// that is loaded later, as that of Python, has not.
void replace_lease_check();

}  // namespace swiftlet::comms
