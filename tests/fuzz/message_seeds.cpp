// Writes seeds for the message fuzzer into a folder: one message of each topic, and requests at and beyond
// their size limits, empty and not finite.
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>
#include <type_traits>

#include "swiftlet/services/dds/payload.hpp"
#include "tests/fuzz/message_types.hpp"
#include "tests/unit/services/messages/messages.hpp"

namespace {

using namespace swiftlet;
using namespace messages::fixtures;
using messages::to_message;
namespace msg = messages::msg;

template <class Message>
void write(const std::filesystem::path& folder, const char* name, const Message& message) {
  const auto bytes = dds::to_payload(message);
  std::ofstream file(folder / name, std::ios::binary);
  file.put(tests::tag_of<Message>(tests::MessageTypes()));
  file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: message_seeds FOLDER\n");
    return 2;
  }
  const std::filesystem::path folder = argv[1];
  std::filesystem::create_directories(folder);
  messages::for_each_topic([&](const auto& topic) {
    write(folder, topic.name, example<typename std::decay_t<decltype(topic)>::Message>());
  });

  write(folder, "mission_empty", msg::Mission());
  msg::Mission long_mission = to_message(mission(control::kMaxMissionItems, 0));
  write(folder, "mission_at_its_bound", long_mission);
  long_mission.items().push_back(long_mission.items().front());
  write(folder, "mission_past_its_bound", long_mission);
  msg::Mission wrong = to_message(mission(2));
  wrong.items().front().speed(std::nan(""));
  write(folder, "mission_nan", wrong);

  write(folder, "trajectory_empty", msg::Trajectory());
  msg::Trajectory long_trajectory = to_message(trajectory(control::kMaxTrajectorySegments));
  write(folder, "trajectory_at_its_bound", long_trajectory);
  long_trajectory.segments().push_back(long_trajectory.segments().front());
  write(folder, "trajectory_past_its_bound", long_trajectory);
  msg::Trajectory endless = to_message(trajectory(1));
  endless.segments().front().duration_s(std::numeric_limits<double>::infinity());
  write(folder, "trajectory_infinite", endless);
  return 0;
}
