// Fuzzes the files of motion capture: room files, and captured traffic.
#include "swiftlet/io/mocap/capture_file.hpp"
#include "swiftlet/io/mocap/room.hpp"
#include "tests/fuzz/refusal.hpp"

using namespace swiftlet;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text = tests::text_of(data, size);
  tests::is_read([&] {
    const mocap::Room room = mocap::parse_room(text, tests::kFuzzedFile);
    tests::demand(!room.vehicles.empty(), "a room that was read has a vehicle");
    const mocap::NedPose pose = mocap::RoomFrame(room).vehicle_pose(
        Eigen::Vector3d::Ones(), Eigen::Quaterniond::Identity(), room.vehicles.front());
    tests::demand(pose.position_ned.allFinite(), "its vehicles have finite poses");
  });
  tests::is_read([&] { mocap::parse_capture(text, tests::kFuzzedFile); });
  return 0;
}
