// Writes seeds for the datagram fuzzer into a folder: RTPS datagrams of each kind.
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/support/rtps_message.hpp"

namespace {

using namespace swiftlet::tests;

void write(const std::filesystem::path& folder, const std::string& name, const RtpsMessage& message) {
  std::ofstream file(folder / name, std::ios::binary);
  file.put('\0');  // security off
  file.write(reinterpret_cast<const char*>(message.bytes().data()),
             static_cast<std::streamsize>(message.bytes().size()));
}

ByteWriter endpoints() { return ByteWriter().bytes(kUserReader).bytes(kUserWriter); }

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: datagram_seeds FOLDER\n");
    return 2;
  }
  const std::filesystem::path folder = argv[1];
  std::filesystem::create_directories(folder);
  write(folder, "sample",
        RtpsMessage()
            .add(0x0e, 0, ByteWriter().bytes(kBob))
            .add(0x09, 0, ByteWriter().zeros(8))
            .add(0x15, 4, data_fields(kUserReader, kUserWriter, 7).u32(0x0100).zeros(60))
            .add(0x80, 0, ByteWriter().zeros(56)));
  write(folder, "inline_qos",
        RtpsMessage().add(0x15, 6,
                          data_fields(kUserReader, kUserWriter, 7)
                              .parameter(0x0070, ByteWriter().zeros(16))
                              .sentinel()
                              .u32(0x0100)
                              .zeros(8)));
  write(folder, "heartbeat", RtpsMessage().add(0x07, 0, endpoints().number(0, 1).number(0, 9).u32(3)));
  write(folder, "acknack", RtpsMessage().add(0x06, 0, endpoints().number(0, 4).u32(40).zeros(8).u32(3)));
  write(folder, "gap", RtpsMessage().add(0x08, 0, endpoints().number(0, 4).number(0, 9).u32(32).u32(5)));
  write(folder, "nack_frag",
        RtpsMessage().add(0x12, 0, endpoints().number(0, 4).u32(1).u32(32).u32(7).u32(2)));
  write(folder, "heartbeat_frag", RtpsMessage().add(0x13, 0, endpoints().number(0, 4).u32(3).u32(2)));
  write(folder, "fragment", RtpsMessage().add(0x16, 0, fragment_fields(3, 1, 1024, 2060).zeros(12)));
  write(
      folder, "liveliness",
      RtpsMessage().add(
          0x15, 4,
          data_fields({0, 2, 0, 0xc7}, {0, 2, 0, 0xc2}, 1).u32(0x0100).bytes(kAlice).u32(0x01000000).u32(0)));
  ByteWriter parameters = participant_parameters(kAlice);
  parameters.parameter(0x0032, ByteWriter().u32(1).u32(7410).zeros(16))
      .parameter(0x0059, ByteWriter().u32(1).string("host").string("lab"))
      .parameter(0x002c, ByteWriter().u32(4).u32(0x3d65))
      .parameter(0x0062, ByteWriter().string("control"));
  write(folder, "participant", announcement(kAlice, parameters));
  write(folder, "endpoint",
        RtpsMessage().add(0x15, 4,
                          data_fields(kSedpReader, kSedpWriter, 1)
                              .u16(0x0300)
                              .u16(0)
                              .parameter(0x005a, guid(kAlice, kUserWriter))
                              .parameter(0x0005, ByteWriter().string("rt/kl1/imu"))
                              .parameter(0x0029, ByteWriter().u32(1).string("lab"))
                              .parameter(0x0073, ByteWriter().u32(1).u32(0))
                              .parameter(0x0072, ByteWriter().zeros(16))
                              .sentinel()));
}
