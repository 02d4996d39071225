// What the protection against hostile datagrams costs for each IMU sample: the check, and the seal with a network key.
#include <vector>

#include <benchmark/benchmark.h>

#include "swiftlet/services/rtps/datagram_guard.hpp"
#include "tests/support/rtps_message.hpp"

namespace swiftlet::dds {
namespace {

using namespace swiftlet::tests;

const io::NetworkKeys kKeys{io::NetworkKey{1}};
constexpr std::size_t kImuBytes = 208;  // of a sample on the wire

Bytes imu_datagram() {
  return RtpsMessage()
      .add(0x0e, 0, ByteWriter().bytes(kBob))
      .add(0x09, 0, ByteWriter().zeros(8))
      .add(0x15, 4, data_fields(kUserReader, kUserWriter, 7).u32(0x0100).zeros(kImuBytes))
      .add(0x80, 0, ByteWriter().zeros(56))
      .bytes();
}

void datagram_check(benchmark::State& state) {
  rtps::DatagramGuard guard;
  const Bytes datagram = imu_datagram();
  for (auto _ : state)
    benchmark::DoNotOptimize(guard.admit(datagram.data(), datagram.size(), {}, 7411, {1, 1}).fault);
}
BENCHMARK(datagram_check);

// With the copy that a sender makes.
void datagram_seal(benchmark::State& state) {
  rtps::DatagramGuard guard(kKeys);
  const Bytes datagram = imu_datagram();
  Bytes sealed = datagram;
  for (auto _ : state) {
    sealed = datagram;
    guard.seal(sealed, {1, 1});
    benchmark::DoNotOptimize(sealed.data());
  }
}
BENCHMARK(datagram_seal);

// Seal and check of a hop together; without the copy, the rest is what the receiver does.
void datagram_hop_with_key(benchmark::State& state) {
  rtps::DatagramGuard sender(kKeys);
  rtps::DatagramGuard receiver(kKeys);
  const Bytes datagram = imu_datagram();
  Bytes sealed = datagram;
  for (auto _ : state) {
    sealed = datagram;
    sender.seal(sealed, {1, 1});
    const rtps::CheckedDatagram checked = receiver.admit(sealed.data(), sealed.size(), {}, 7411, {1, 1});
    if (checked.fault != nullptr) state.SkipWithError(checked.fault);
  }
}
BENCHMARK(datagram_hop_with_key);

}  // namespace
}  // namespace swiftlet::dds

BENCHMARK_MAIN();
