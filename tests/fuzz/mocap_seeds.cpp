// Writes inputs for mocap_fuzzer.cpp:
//   mocap_seeds FOLDER
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "swiftlet/io/mocap/vrpn.hpp"
#include "tests/support/mocap/natnet_packets.hpp"
#include "tests/support/mocap/vicon_packets.hpp"

namespace {

using Bytes = std::vector<std::uint8_t>;
namespace natnet = swiftlet::tests::natnet;
namespace vrpn = swiftlet::mocap::vrpn;

void append(Bytes& out, const Bytes& bytes) { out.insert(out.end(), bytes.begin(), bytes.end()); }

class Folder {
 public:
  explicit Folder(const std::string& path) : path_(path) { std::filesystem::create_directories(path); }
  void write(const std::string& name, std::uint8_t protocol, std::uint8_t layout, const Bytes& bytes) const {
    std::ofstream out(path_ + "/" + name, std::ios::binary);
    out << static_cast<char>(protocol) << static_cast<char>(layout);
    out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  }

 private:
  const std::string path_;
};

natnet::Frame frame() {
  natnet::Frame frame;
  frame.exposed_ticks = 1000;
  frame.sent_ticks = 2000;
  frame.bodies = {{"kl1", 1, {1, 2, 3}}, {"kl2", 2, {1, 2, 3}, {0, 0, 0, 1}, false}};
  return frame;
}

void write_natnet(const Folder& folder) {
  const natnet::Version versions[] = {{3, 0}, {3, 1}, {4, 0}, {4, 1}, {4, 2}};
  for (std::uint8_t layout = 0; layout < 5; ++layout) {
    const natnet::Version version = versions[layout];
    folder.write("frame_" + version.to_string(), 0, layout, natnet::frame(version, frame()));
    folder.write("models_" + version.to_string(), 0, layout, natnet::models(version, frame().bodies));
    natnet::Server server;
    server.version = version;
    Bytes session;
    for (const Bytes& datagram :
         {natnet::server_info(server), natnet::echo_response(1, 2), natnet::models(version, frame().bodies),
          natnet::frame(version, frame()), natnet::frame(version, frame())}) {
      session.push_back(static_cast<std::uint8_t>(datagram.size()));
      session.push_back(static_cast<std::uint8_t>(datagram.size() >> 8U));
      append(session, datagram);
    }
    folder.write("session_" + version.to_string(), 1, layout, session);
  }
}

void write_vrpn(const Folder& folder) {
  Bytes pose(64);
  pose[8 + 6 * 8] = 0x3f;  // w = 1
  pose[9 + 6 * 8] = 0xf0;
  Bytes stream = vrpn::description(vrpn::kSenderDescription, 0, "kl1");
  append(stream, vrpn::description(vrpn::kTypeDescription, 1, vrpn::kPoseType));
  append(stream, vrpn::message(1'000'000'000, 0, 1, pose));
  folder.write("vrpn", 2, 0, stream);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: %s FOLDER\n", argv[0]);
    return 2;
  }
  const Folder folder(argv[1]);
  write_natnet(folder);
  write_vrpn(folder);
  folder.write("vicon", 3, 0,
               swiftlet::tests::vicon_frame(1, {{"kl1", {1, 2, 3, 0, 0, 1}}, {"kl2", {}}}, 256));
  return 0;
}
