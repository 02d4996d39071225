// Uses the parts with DDS: joins the network and reads the installed mission.
#include <cstdio>
#include <string>

#include <swiftlet/control/types/settings.hpp>
#include <swiftlet/io/missions/mission_file.hpp>
#include <swiftlet/services/dds/node.hpp>

int main(int argc, char** argv) {
  using namespace swiftlet;
  if (argc != 2) return 2;
  dds::NodeSettings settings;
  settings.name = "consumer";
  settings.domain = 229;
  dds::Node node(settings);
  const auto imu = node.publish(messages::topics::kImu);

  const auto mission =
      io::load_mission_file(std::string(argv[1]) + "/missions/square.yaml", control::Limits{});
  std::printf("%s has %zu items; %d hear the imu\n", mission.name.c_str(), mission.mission.items.size(),
              imu.matched());
  return mission.takes_off() && mission.lands() && imu.matched() == 0 ? 0 : 1;
}
