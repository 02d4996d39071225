#include "swiftlet/services/dds/discovery/lease_check.hpp"

#include <arpa/inet.h>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <dlfcn.h>
#include <netinet/in.h>
#include <pthread.h>
#include <string>
#include <sys/socket.h>
#include <unistd.h>
#include <vector>

#include <gtest/gtest.h>

#include "swiftlet/services/dds/discovery/discovery_ports.hpp"
#include "swiftlet/services/dds/discovery/domain_lock.hpp"
#include "swiftlet/services/dds/fast_dds.hpp"
#include "swiftlet/services/dds/node.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/private_domain.hpp"
#include "tests/support/rtps_message.hpp"

namespace swiftlet::comms {
namespace {

using namespace std::chrono_literals;
using tests::ByteWriter;
using tests::eventually;

constexpr auto kLease = 1s;    // the shortest that the check of datagrams lets pass
constexpr auto kHold = 100ms;  // at most

std::atomic<int> held_checks{0};
std::atomic<const Participant*> checking{nullptr};

// Whether this is the place where Fast DDS checks a lease and takes the lock of what was discovered.
bool is_in_lease_check(const void* address) {
  static const auto start = reinterpret_cast<std::uintptr_t>(dlsym(RTLD_NEXT, SWIFTLET_PDP_CHECK_LEASE));
  constexpr std::uintptr_t kBeginning_bytes = 128;
  return reinterpret_cast<std::uintptr_t>(address) - start < kBeginning_bytes;
}

// Until the participant whose lease is checked is gone. With the replacement it cannot leave meanwhile.
void hold_check() {
  const Participant* const participant = checking;
  if (participant == nullptr) return;
  ++held_checks;
  eventually([&] { return participant->processes_seen().empty(); }, kHold);
}

// A participant of another process, which announces itself to one process and says goodbye.
class Stranger {
 public:
  Stranger(std::uint8_t number, std::uint16_t port)
      : prefix_{0x01, 0x0f, 1, 2, 3, 4, 5, 6, 7, 8, 9, number}, port_(port) {}
  ~Stranger() { ::close(socket_); }
  Stranger(const Stranger&) = delete;
  Stranger& operator=(const Stranger&) = delete;

  void announce() const {
    constexpr std::uint32_t kDiscardPort = 9;
    const ByteWriter nowhere = ByteWriter().u32(1).u32(kDiscardPort).zeros(12).u8(127).zeros(2).u8(1);
    ByteWriter parameters = tests::participant_parameters(prefix_, kLease.count());
    parameters.parameter(0x0058, ByteWriter().u32(0x3f))
        .parameter(0x0031, nowhere)
        .parameter(0x0032, nowhere);
    send(tests::announcement(prefix_, parameters));
  }
  void say_goodbye() const {
    ByteWriter body = tests::data_fields(tests::kSpdpReader, tests::kSpdpWriter, 2);
    body.parameter(0x0070, tests::guid(prefix_, kParticipantEntity))
        .parameter(0x0071, ByteWriter().u32(0x03000000))
        .sentinel();
    body.u16(0x0300).u16(0).parameter(0x0050, tests::guid(prefix_, kParticipantEntity)).sentinel();
    constexpr unsigned kData = 0x15, kWithQos = 2, kWithKey = 8;
    send(tests::RtpsMessage(prefix_).add(kData, kWithQos | kWithKey, body));
  }

 private:
  void send(const tests::RtpsMessage& message) const {
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    to.sin_port = htons(port_);
    ::sendto(socket_, message.bytes().data(), message.bytes().size(), 0,
             reinterpret_cast<const sockaddr*>(&to), sizeof to);
  }

  const int socket_ = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const GuidPrefix prefix_;
  const std::uint16_t port_;
};

// The goodbye is said while the check is held. Without the replacement that ends this process.
TEST(LeaseCheck, EndsNoProcessIfAParticipantLeavesMeanwhile) {
  constexpr std::uint8_t kStrangers = 5;
  const DomainLock lock;
  const Participant participant(tests::settings_of("tool", lock));
  const DiscoveryPorts ports = discovery_ports(lock.domain());
  const std::uint32_t port = ports.first + *own_discovery_ports(lock.domain()).begin() * ports.gap;
  checking = &participant;
  for (std::uint8_t i = 0; i < kStrangers; ++i) {
    const Stranger stranger(i, static_cast<std::uint16_t>(port));
    const int held_before = held_checks;
    stranger.announce();
    EXPECT_TRUE(eventually([&] { return participant.processes_seen().size() == 1; }));
    EXPECT_TRUE(eventually([&] { return held_checks > held_before; }));
    stranger.say_goodbye();
    EXPECT_TRUE(eventually([&] { return participant.processes_seen().empty(); }));
  }
  checking = nullptr;
}

}  // namespace
}  // namespace swiftlet::comms

// In place of glibc's.
extern "C" int pthread_mutex_lock(pthread_mutex_t* mutex) noexcept {
  static auto* const lock =
      reinterpret_cast<decltype(&pthread_mutex_lock)>(dlsym(RTLD_NEXT, "pthread_mutex_lock"));
  if (swiftlet::comms::is_in_lease_check(__builtin_return_address(0))) swiftlet::comms::hold_check();
  return lock(mutex);
}
