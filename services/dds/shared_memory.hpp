// Left-overs of Fast DDS's shared-memory transport.
#pragma once

#include <string>

namespace swiftlet::comms {

// Removes the segments and ports of processes that died without cleaning up: those whose lock file, which the
// kernel frees when its holder dies, nobody holds. Leaves alone what belongs to living processes or to other
// users, and files younger than a second, which may be in the making. Returns how many files were removed.
int remove_stale_shared_memory(const std::string& directory = "/dev/shm");

}  // namespace swiftlet::comms
