// Removes stale files of Fast DDS's shared-memory transport.
#pragma once

#include <string>

namespace swiftlet::comms {

// Removes the segments and ports of processes that died without cleaning up. A file is stale if no process
// holds its lock file; the kernel releases the lock when the holder dies. Keeps files of running processes
// and of other users, and files younger than a second, which may still be in creation. Returns the number of
// removed files.
int remove_stale_shared_memory(const std::string& directory = "/dev/shm");

}  // namespace swiftlet::comms
