#include "swiftlet/ground/cli/hover_test.hpp"

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <stdexcept>

#include <fmt/format.h>

#include "swiftlet/control/types/mode.hpp"
#include "swiftlet/ground/client/vehicle.hpp"
#include "swiftlet/ground/flight/interrupts.hpp"
#include "swiftlet/io/atomic_write.hpp"
#include "swiftlet/io/text_file.hpp"

namespace swiftlet::ground {
namespace {

using namespace std::chrono_literals;
using control::Mode;

constexpr auto kDiscoveryTimeout = 5s;  // vehicle_info comes once a second, if at all
constexpr auto kReportTimeout = 2s;
constexpr auto kStep = 100ms;
constexpr auto kTimeout = 60s;  // of a vehicle that starts its rotors late

// Waits until vehicle and control have said what tested_configuration() needs.
void await_reports(Client& client, std::chrono::milliseconds timeout) {
  client.hear_files();
  client.wait(timeout, [](const View& view) {
    return view.vehicle.seen() && view.control.seen() && view.files != nullptr;
  });
}

bool has_passed(const std::string& vehicle, const std::string& configuration) {
  const std::filesystem::path memory = hover_test_memory(vehicle);
  return std::filesystem::exists(memory) && io::read_text_file(memory) == configuration;
}

void remember(const std::string& vehicle, const std::string& configuration) {
  const std::filesystem::path memory = hover_test_memory(vehicle);
  std::filesystem::create_directories(memory.parent_path());
  io::write_atomically(memory, configuration);
}

// Why the test ended, if it did not pass. Control says it with the mode that follows.
std::string end_of_test(const Vehicle& vehicle, const ActionResult& result) {
  vehicle.wait_until([](const VehicleState& state) { return control::rotors_off(state.mode); },
                     kReportTimeout);
  const VehicleState state = vehicle.state();
  return state.mode == Mode::kStopped ? state.mode_reason : result.reason;
}

// An interrupt ends all waits for answers, but not for those to what ends the test.
ActionResult await(Vehicle& vehicle, const ActionHandle& test, const std::function<bool()>& interrupted) {
  const auto deadline = std::chrono::steady_clock::now() + kTimeout;
  ActionResult result = test.wait(kStep);
  while (result.kind == ActionResult::Kind::kTimedOut) {
    if (interrupted()) {
      vehicle.cancel_when({});
      vehicle.land();
      return {ActionResult::Kind::kCanceled, "interrupted"};
    }
    if (std::chrono::steady_clock::now() > deadline) {
      vehicle.land();
      return {ActionResult::Kind::kTimedOut, "the hover test did not end within 60 s"};
    }
    result = test.wait(kStep);
  }
  return result;
}

std::string fly_hover_test(const std::shared_ptr<Client>& client, const std::function<bool()>& interrupted) {
  Vehicle vehicle(client);
  vehicle.cancel_when(interrupted);
  const Result found = vehicle.connect();
  if (!found.accepted()) return found.reason;
  const std::string configuration = tested_configuration(client->view());
  const ActionResult armed = vehicle.arm().wait(kTimeout);
  if (!armed.done()) {  // interrupted: the request may have armed it all the same
    vehicle.cancel_when({});
    if (interrupted()) vehicle.disarm();
    return armed.reason;
  }
  control::Request request;
  request.kind = control::RequestKind::kHoverTest;
  const ActionHandle test = vehicle.request(request);
  if (!test.accepted()) {
    vehicle.cancel_when({});
    vehicle.disarm();
    return test.answer().reason;
  }
  const ActionResult result = await(vehicle, test, interrupted);
  if (!result.done()) return end_of_test(vehicle, result);
  remember(vehicle.name(), configuration);
  return "";
}

}  // namespace

std::string tested_configuration(const View& view) {
  const msg::VehicleInfo& vehicle = view.vehicle.message;
  const auto hash = [&](const msg::SettingsFile& (msg::FlownFiles::*file)() const) {
    return view.files == nullptr ? "" : ((*view.files).*file)().sha256().c_str();
  };
  return fmt::format(
      "model {}\nmass_kg {}\nrotors {}\nautopilot {}\nlevel {}\nvehicle_file {}\ncontrol_settings {}\n",
      vehicle.name().c_str(), vehicle.mass_kg(), vehicle.rotor_count(), vehicle.autopilot().c_str(),
      view.control.message.control_level(), hash(&msg::FlownFiles::vehicle), hash(&msg::FlownFiles::control));
}

std::filesystem::path hover_test_memory(const std::string& vehicle) {
  const char* const state = std::getenv("XDG_STATE_HOME");
  if (state != nullptr && *state != '\0')
    return std::filesystem::path(state) / "swiftlet" / "hover_tests" / vehicle;
  const char* const home = std::getenv("HOME");
  if (home == nullptr || *home == '\0')
    throw std::runtime_error("hover test: neither XDG_STATE_HOME nor HOME says where to remember it");
  return std::filesystem::path(home) / ".local" / "state" / "swiftlet" / "hover_tests" / vehicle;
}

std::string fly_hover_test(const dds::NodeSettings& network, const std::function<bool()>& interrupted) {
  const auto client = std::make_shared<Client>(network);
  await_reports(*client, kReportTimeout);
  return fly_hover_test(client, interrupted);
}

void require_hover_tests(const dds::NodeSettings& network, const std::vector<std::string>& vehicles) {
  const Interrupts interrupts;
  for (const std::string& vehicle : vehicles) {
    dds::NodeSettings settings = network;
    settings.vehicle = vehicle;
    const auto client = std::make_shared<Client>(settings);
    await_reports(*client, kDiscoveryTimeout);
    const View view = client->view();
    if (view.vehicle.message.simulated() || has_passed(vehicle, tested_configuration(view))) continue;
    std::fprintf(stderr, "%s: first flight: hover test of 2 s at 0.15 m\n", vehicle.c_str());
    const std::string defect = fly_hover_test(client, [&] { return interrupts.count() > 0; });
    if (defect.empty()) continue;
    throw std::runtime_error(
        fmt::format("fly: {} does not pass the hover test: {}; `swiftlet check vehicle --hover` "
                    "repeats it, --skip-hover-test leaves it out",
                    vehicle, defect));
  }
}

}  // namespace swiftlet::ground
