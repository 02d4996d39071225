#include "tests/soak/hostile_flight.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <functional>

#include "swiftlet/io/network_key.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/network/network_namespace.hpp"
#include "tests/support/redundant_flight.hpp"

namespace swiftlet::soak {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;
using tests::eventually;
namespace msg = messages::msg;

constexpr double kSpeed = 1.0;  // m/s, of the mission

double seconds(Clock::duration time) { return std::chrono::duration<double>(time).count(); }

double resident_mib(pid_t process) {
  std::ifstream file("/proc/" + std::to_string(process) + "/statm");
  double total_pages = 0.0;
  double resident_pages = 0.0;
  file >> total_pages >> resident_pages;
  return resident_pages * 4096.0 / (1 << 20);
}

struct Answers {
  std::uint64_t answered = 0;
  std::uint64_t late = 0;

  explicit Answers(const msg::VehicleInfo& info) : answered(info.answered()), late(info.late()) {}
  double late_since(const Answers& before) const {
    return answered == before.answered
               ? 0.0
               : static_cast<double>(late - before.late) / static_cast<double>(answered - before.answered);
  }
};

class HostileFlight {
 public:
  HostileFlight(const HostileSettings& settings, const std::filesystem::path& folder)
      : settings_(settings), flight_(folder, {}, network(settings, folder)) {}

  HostileResult fly();

 private:
  static dds::NodeSettings network(const HostileSettings& settings, const std::filesystem::path& folder);
  // Name and process id of each process.
  std::vector<std::pair<std::string, pid_t>> processes() const;
  void attack(HostileResult& result);
  bool mission_is(std::uint8_t state);

  const HostileSettings settings_;
  tests::DatagramCapture capture_;
  tests::RedundantFlight flight_;
};

dds::NodeSettings HostileFlight::network(const HostileSettings& settings,
                                         const std::filesystem::path& folder) {
  dds::NodeSettings network;
  if (settings.network_key) {
    network.network_key_file = folder / "network.key";
    io::write_network_keys(network.network_key_file, {io::random_network_key()});
  }
  return network;
}

std::vector<std::pair<std::string, pid_t>> HostileFlight::processes() const {
  std::vector<std::pair<std::string, pid_t>> all{{"plant", flight_.plant().pid()},
                                                 {"mocap", flight_.mocap().pid()}};
  for (const auto& controller : flight_.controllers())
    all.emplace_back("control " + std::to_string(controller->failover_priority), controller->process->pid());
  return all;
}

bool HostileFlight::mission_is(std::uint8_t state) {
  return flight_.client().view().mission.message.state() == state;
}

HostileResult HostileFlight::fly() {
  HostileResult result;
  flight_.start_controller(5);
  flight_.start_controller(1);
  flight_.wait_for_roles(1, 1);
  const double attack_s = static_cast<double>(settings_.datagrams) / settings_.per_second;
  const double lap_s = 4e-9 * static_cast<double>(tests::side_ns(kSpeed));
  flight_.fly(tests::square_laps(kSpeed, static_cast<int>(std::ceil((attack_s + 1.0) / lap_s))));
  flight_.wait("the vehicle has taken off", [&] { return flight_.z_ned() < -0.98 && flight_.speed() > 0.1; });
  const Answers start(flight_.client().view().vehicle.message);
  const std::int64_t attack_ns = flight_.stamp_ns() + std::llround(1e9 * settings_.baseline_s);
  flight_.wait("the vehicle's time passes", [&] { return flight_.stamp_ns() > attack_ns; });
  result.late_before = Answers(flight_.client().view().vehicle.message).late_since(start);
  attack(result);
  const ground::View attacked = flight_.client().view();
  flight_.wait("the ground hears vehicle and control after the attack", [&] {
    const ground::View now = flight_.client().view();
    return now.vehicle.count > attacked.vehicle.count && now.control.count > attacked.control.count;
  });
  if (settings_.network_key)
    result.mission_completed = eventually([&] { return mission_is(msg::MissionStatus_Constants::COMPLETED); },
                                          std::chrono::seconds(60), 50ms);
  for (const auto& [name, pid] : processes()) {
    if (!tests::is_running(pid)) result.dead.push_back(name);
  }
  return result;
}

void HostileFlight::attack(HostileResult& result) {
  std::vector<double> memory_mib;
  const Answers before(flight_.client().view().vehicle.message);
  const std::int64_t begin_ns = flight_.stamp_ns();
  const auto began = Clock::now();
  {
    const tests::DatagramAttack attack(
        tests::DatagramMutator(capture_.datagrams(), settings_.seed, settings_.forges), settings_.per_second);
    eventually([&] { return attack.sent() >= settings_.datagrams / 2; }, 1h, 20ms);
    for (const auto& [name, pid] : processes()) memory_mib.push_back(resident_mib(pid));
    eventually([&] { return attack.sent() >= settings_.datagrams; }, 1h, 20ms);
    result.sent = attack.sent();
  }
  result.attacked_s = seconds(Clock::now() - began);
  const auto all = processes();
  for (std::size_t i = 0; i < all.size(); ++i)
    result.memory_growth_mib =
        std::max(result.memory_growth_mib, resident_mib(all[i].second) - memory_mib[i]);
  result.late_during = Answers(flight_.client().view().vehicle.message).late_since(before);
  if (settings_.network_key)
    result.largest_deviation_m = flight_.metrics(begin_ns, flight_.stamp_ns()).largest_deviation_m;
}

}  // namespace

HostileResult fly_under_attack(const HostileSettings& settings, const std::filesystem::path& folder) {
  const tests::HostNetwork network(tests::HostNetwork::Layout::kSwitch, 1);
  const tests::HostNetwork::Inside inside(network, 0);
  return HostileFlight(settings, folder).fly();
}

}  // namespace swiftlet::soak
