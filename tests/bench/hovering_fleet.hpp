// Vehicles that hover in real processes, and the figures of both.
#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <poll.h>
#include <stdexcept>
#include <string>
#include <unistd.h>
#include <vector>

#include "swiftlet/ground/client/client.hpp"
#include "swiftlet/io/command_line/child_process.hpp"
#include "swiftlet/io/text_file.hpp"
#include "swiftlet/services/dds/discovery/domain_lock.hpp"
#include "tests/bench/built_programs.hpp"
#include "tests/bench/process_usage.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/refusals.hpp"

namespace swiftlet::bench {

using namespace std::chrono_literals;
namespace fs = std::filesystem;
namespace msg = messages::msg;

constexpr std::array<const char*, 3> kProcesses = {"plant", "mocap", "control"};

struct VehicleFigures {
  msg::VehicleInfo vehicle;
  msg::ControlStatus control;
  std::uint64_t answered = 0;  // during the measurement
  std::uint64_t overdue = 0;   // of these, after more than a period or not at all
  std::uint64_t cycles = 0;
  std::uint64_t late_steps = 0;
};

struct FleetFigures {
  std::vector<VehicleFigures> vehicles;
  std::array<double, 3> cpu_percent{};  // of one core, by kProcesses
  std::array<double, 3> memory_mib{};
  int threads = 0;              // of all processes
  double switches_per_s = 0.0;  // context switches, of all processes
  double stalls_percent = 0.0;  // of the cycles: a core of this computer stood still
  std::uint64_t refused = 0;    // datagrams, all of which are of these processes
};

// Vehicles in one domain, served by one process of each role.
class Fleet {
 public:
  Fleet(int vehicles, int rate_hz, bool realtime, const fs::path& folder, int rotor_speed_rate_hz = 500) {
    std::string list;
    for (int i = 1; i <= vehicles; ++i) {
      names_.push_back("kl" + std::to_string(i));
      list += (list.empty() ? "" : ",") + names_.back();
    }
    network_.domain = lock_.domain();
    network_.localhost_only = true;
    for (const char* name : kProcesses) {
      std::vector<std::string> words{"--domain", std::to_string(network_.domain), "--vehicle-name", list,
                                     "--localhost-only"};
      if (!realtime) words.emplace_back("--no-realtime");
      if (name == kProcesses[0])  // side by side, inside the fence
        words.insert(words.end(), {"--imu-rate", std::to_string(rate_hz), "--rotor-speed-rate",
                                   std::to_string(rotor_speed_rate_hz), "--start", "-1", "-1", "--spacing",
                                   "0.35", "--per-row", "6"});
      const std::string full = std::string("swiftlet-") + name;
      logs_.push_back(folder / full);
      processes_.emplace_back(io::ProcessSettings{full, program(full), words, logs_.back()});
    }
  }

  // A few at a time: the clients are a load too.
  void take_off() {
    for (std::size_t i = 0; i < names_.size(); i += kTogether)
      take_off({names_.begin() + static_cast<std::ptrdiff_t>(i),
                names_.begin() + static_cast<std::ptrdiff_t>(std::min(i + kTogether, names_.size()))});
  }

  // Uploads a mission of this many waypoints to the first vehicle, which hovers. Returns the times until the upload is
  // answered and until the mission is reported as running, s.
  struct MissionStart {
    double uploaded_s = 0.0;
    double started_s = 0.0;
  };
  MissionStart start_mission(std::size_t waypoints) {
    const Clients clients(network_, {names_.front()});
    ground::Client& client = *clients.all.front();
    if (!client.wait(10s, [](const ground::View& view) { return view.mission.seen(); }))
      throw std::runtime_error("a vehicle is silent");
    control::Mission mission;
    mission.items.resize(waypoints);
    for (std::size_t i = 0; i < waypoints; ++i)
      mission.items[i].position_ned = {0.5 * static_cast<double>(i % 3), 0.5 * static_cast<double>(i % 2),
                                       -1.0};
    MissionStart took;
    const auto begin = ground::Clock::now();
    const auto passed_s = [begin] {
      return std::chrono::duration<double>(ground::Clock::now() - begin).count();
    };
    ground::Result answer = client.upload(mission, 10s);
    took.uploaded_s = passed_s();
    control::Request start;
    start.kind = control::RequestKind::kMissionStart;
    start.mission_id = client.mission_id();
    if (answer.accepted()) answer = client.request(start, 10s);
    if (!answer.accepted()) throw std::runtime_error(answer.reason);
    const bool runs = client.wait(10s, [&](const ground::View& view) {
      return view.mission.message.mission_id() == client.mission_id() &&
             view.mission.message.state() == msg::MissionStatus_Constants::RUNNING;
    });
    took.started_s = passed_s();
    if (!runs) throw std::runtime_error("a mission was not started");
    return took;
  }

  // The discovery of the one who counts is over when all have been heard a few times.
  void begin() {
    counting_.emplace(network_, names_);
    for (const std::string& name : names_) counters_.push_back(std::make_unique<Counters>(*counting_, name));
    for (const auto& heard : counters_) {
      if (!heard->vehicle.wait_for_count(3)) throw std::runtime_error("a vehicle is silent");
    }
    begin_ = read();
  }
  std::vector<VehicleFigures> end() {
    std::vector<VehicleFigures> figures = read();
    for (std::size_t i = 0; i < figures.size(); ++i) {
      figures[i].answered -= begin_[i].answered;
      figures[i].overdue -= begin_[i].overdue;
      figures[i].cycles -= begin_[i].cycles;
      figures[i].late_steps -= begin_[i].late_steps;
    }
    return figures;
  }

  // Whether one of the processes has ended.
  bool has_ended() {
    return std::any_of(processes_.begin(), processes_.end(),
                       [](io::ChildProcess& process) { return process.poll().has_value(); });
  }

  std::uint64_t refused() const {
    std::uint64_t refused = 0;
    for (const fs::path& log : logs_) refused += tests::refused_datagrams(io::read_text_file(log));
    return refused;
  }

  std::array<Usage, 3> usage() const {
    std::array<Usage, 3> now;
    for (std::size_t i = 0; i < now.size(); ++i) now[i] = usage_of(processes_[i].pid());
    return now;
  }

 private:
  static constexpr std::size_t kTogether = 4;

  void take_off(const std::vector<std::string>& names) {
    const Clients clients(network_, names);
    for (const auto& client : clients.all) {
      if (!client->wait(30s, [](const ground::View& view) { return view.control.message.has_pose(); }))
        throw std::runtime_error("no vehicle started: " + client->where());
    }
    control::Request arm;
    arm.kind = control::RequestKind::kArm;
    for (const auto& client : clients.all) ask(*client, arm);
    control::Request takeoff;
    takeoff.kind = control::RequestKind::kTakeoff;
    takeoff.position_ned.z() = -1.0;
    for (const auto& client : clients.all) ask(*client, takeoff);
    for (const auto& client : clients.all) {
      if (!client->wait(20s, [](const ground::View& view) {
            return view.control.message.mode() == msg::ControlStatus_Constants::MODE_HOLDING;
          }))
        throw std::runtime_error("a vehicle did not take off");
    }
  }

  // A client of each vehicle, in one participant.
  struct Clients {
    Clients(const dds::NodeSettings& network, const std::vector<std::string>& names)
        : participant(network, names) {
      for (const std::string& name : names) {
        dds::NodeSettings own = network;
        own.vehicle = name;
        all.push_back(std::make_unique<ground::Client>(participant, own));
      }
    }
    dds::Participant participant;
    std::vector<std::unique_ptr<ground::Client>> all;
  };

  static void ask(ground::Client& client, const control::Request& request) {
    ground::Result answer;
    if (!tests::eventually([&] { return (answer = client.request(request, 3s)).accepted(); }))
      throw std::runtime_error(answer.reason);
  }

  // Hears the counters of a vehicle, and nothing else, which would be a load.
  struct Counters {
    Counters(const dds::Participant& participant, const std::string& name)
        : node(participant, name),
          vehicle_info(node.subscribe<msg::VehicleInfo>(
              messages::topics::kVehicleInfo, [this](const msg::VehicleInfo& info) { vehicle.put(info); })),
          control_status(node.subscribe<msg::ControlStatus>(
              messages::topics::kControlStatus,
              [this](const msg::ControlStatus& status) { control.put(status); })) {}
    dds::Node node;
    tests::Inbox<msg::VehicleInfo> vehicle;
    tests::Inbox<msg::ControlStatus> control;
    dds::Subscription vehicle_info, control_status;
  };

  // The next counters of each vehicle.
  std::vector<VehicleFigures> read() const {
    std::vector<VehicleFigures> all;
    for (const auto& heard : counters_) {
      if (!heard->vehicle.wait_for_count(heard->vehicle.size() + 1) ||
          !heard->control.wait_for_count(heard->control.size() + 1))
        throw std::runtime_error("a vehicle is silent");
      VehicleFigures figures;
      figures.vehicle = heard->vehicle.items().back();
      figures.control = heard->control.items().back();
      figures.answered = figures.vehicle.answered();
      figures.overdue = figures.vehicle.late() + figures.vehicle.unanswered();
      figures.cycles = figures.control.cycles();
      figures.late_steps = figures.control.deadline_misses();
      all.push_back(figures);
    }
    return all;
  }

  dds::DomainLock lock_;
  dds::NodeSettings network_ = [] {
    dds::NodeSettings settings;
    settings.name = "ground";
    return settings;
  }();
  std::vector<std::string> names_;
  std::vector<fs::path> logs_;
  std::vector<io::ChildProcess> processes_;
  std::optional<dds::Participant> counting_;
  std::vector<std::unique_ptr<Counters>> counters_;
  std::vector<VehicleFigures> begin_;
};

}  // namespace swiftlet::bench
