// Fast DDS checks the lease of a participant in its thread for events, and removes one that says goodbye in a thread that
// receives. If the check waits meanwhile for the lock of what was discovered, it finds nobody afterwards, and an assertion of
// PDP::check_remote_participant_liveliness() ends the process (PDP.cpp:1140 of 2.9.1, :1477 of 3.1.2). That takes some
// thousand goodbyes at the right moment: whoever may announce participants has them within seconds.
//
// Both functions are exported. A program's own definitions come before those of a shared library, so that Fast DDS calls
// these: they exclude each other, and the check leaves out who was removed.
#include "swiftlet/services/dds/discovery/lease_check.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <dlfcn.h>
#include <mutex>

#include "swiftlet/services/dds/fast_dds.hpp"

namespace swiftlet::comms {
namespace {

// How ParticipantProxyData of Fast DDS 2.9 to 3.1 begins, which 3.1 does not declare for others.
struct DiscoveredParticipant {
  const void* virtual_functions;
  rtps::ProtocolVersion_t version;
  rtps::GUID_t guid;  // unknown: it was removed
};

struct Replaced {
  void (*check_lease)(void*, void*);
  bool (*remove_participant)(void*, const rtps::GUID_t&, int);
};

template <class Function>
Function function_of(const char* symbol) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, symbol));
}

const Replaced& replaced() {
  static const Replaced functions{
      function_of<decltype(Replaced::check_lease)>(SWIFTLET_PDP_CHECK_LEASE),
      function_of<decltype(Replaced::remove_participant)>(SWIFTLET_PDP_REMOVE_PARTICIPANT)};
  return functions;
}

// One of some, so that participants of one process seldom wait for each other. A check that ends a lease removes too.
std::recursive_mutex& lock_of(const void* pdp) {
  static std::array<std::recursive_mutex, 61> locks;
  return locks[reinterpret_cast<std::uintptr_t>(pdp) / alignof(std::max_align_t) % locks.size()];
}

}  // namespace

void replace_lease_check() { replaced(); }

extern "C" {

// Member functions, whose first argument is the object.
void swiftlet_check_lease(void* pdp, void* participant) asm(SWIFTLET_PDP_CHECK_LEASE);
bool swiftlet_remove_participant(void* pdp, const rtps::GUID_t& guid,
                                 int reason) asm(SWIFTLET_PDP_REMOVE_PARTICIPANT);

void swiftlet_check_lease(void* pdp, void* participant) {
  const std::lock_guard<std::recursive_mutex> lock(lock_of(pdp));
  if (static_cast<const DiscoveredParticipant*>(participant)->guid != rtps::GUID_t::unknown())
    replaced().check_lease(pdp, participant);
}

bool swiftlet_remove_participant(void* pdp, const rtps::GUID_t& guid, int reason) {
  const std::lock_guard<std::recursive_mutex> lock(lock_of(pdp));
  return replaced().remove_participant(pdp, guid, reason);
}

}  // extern "C"

}  // namespace swiftlet::comms
