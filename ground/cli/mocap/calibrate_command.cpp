// `swiftlet mocap calibrate`: aligns a body of the motion capture with its vehicle, and writes that into the room file.
#include <array>
#include <chrono>
#include <cstdio>
#include <memory>
#include <optional>
#include <poll.h>
#include <stdexcept>
#include <string>
#include <unistd.h>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "swiftlet/ground/cli/mocap/calibration.hpp"
#include "swiftlet/ground/cli/mocap/flight_calibration.hpp"
#include "swiftlet/ground/cli/mocap/mocap_commands.hpp"
#include "swiftlet/ground/cli/mocap/recorded_motion.hpp"
#include "swiftlet/ground/client/network_options.hpp"
#include "swiftlet/io/atomic_write.hpp"
#include "swiftlet/io/configuration.hpp"
#include "swiftlet/io/json_text.hpp"
#include "swiftlet/io/text_file.hpp"

namespace swiftlet::ground {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kCalibrationReceiveTime{20};
constexpr double kLongestWait_s = 10.0;  // for the first pose

struct CalibrateOptions {
  mocap::SourceOptions source;
  std::string vehicle = "kl1";
  double rest_s = 3.0;
  double turn_s = 20.0;
  bool no_prompt = false;
  bool hover = false;
  double time_s = 20.0;
  std::string log;
  std::optional<double> from_s;
  std::optional<double> until_s;
  identification::AlignmentPriors priors;
  dds::NodeSettings network;
  bool dry_run = false;
  bool json = false;
};

struct Recording {
  BodyPoses poses;
  double seconds = 0.0;
};

void require_going_on(runtime::StopSignal& stop) {
  if (is_interrupted(stop)) throw std::runtime_error("mocap calibrate: interrupted");
}

// Enter, or the end of the input.
bool was_entered() {
  pollfd input{STDIN_FILENO, POLLIN, 0};
  char character = 0;
  while (::poll(&input, 1, 0) > 0) {
    if (::read(STDIN_FILENO, &character, 1) != 1 || character == '\n') return true;
  }
  return false;
}

// Waits for Enter. Receives meanwhile, so that the connection lives and what came before is not recorded.
void wait_for_enter(const CalibrateOptions& options, const std::string& request, mocap::Source& source,
                    runtime::StopSignal& stop) {
  std::fprintf(stderr, "%s%s\n", request.c_str(), options.no_prompt ? "." : ", then press Enter.");
  if (options.no_prompt) return;
  mocap::SourceFrame unused;
  while (!was_entered()) {
    require_going_on(stop);
    source.receive(unused, kCalibrationReceiveTime);
  }
}

// The tracked poses of the vehicle's body for this time, from the first on.
Recording record(mocap::Source& source, const mocap::RoomFrame& frame, const mocap::VehicleBody& vehicle,
                 double time_s, runtime::StopSignal& stop) {
  Recording recording;
  mocap::SourceFrame received;
  auto begin = Clock::now();
  const auto age_s = [&] { return std::chrono::duration<double>(Clock::now() - begin).count(); };
  while (age_s() < (recording.poses.empty() ? kLongestWait_s : time_s) && !source.has_ended()) {
    require_going_on(stop);
    if (!source.receive(received, kCalibrationReceiveTime)) continue;
    const auto body = mocap::find_body(source.bodies(), vehicle);
    for (const mocap::BodyPose& pose : received.poses) {
      if (!body || pose.body != *body || !pose.tracked) continue;
      if (recording.poses.empty()) begin = Clock::now();
      recording.poses.push_back(frame.body_pose(pose.position, pose.q_room_from_body));
    }
  }
  recording.seconds = age_s();
  if (recording.poses.empty())
    throw std::runtime_error("no pose of " + vehicle.body_text() + " arrived; the motion capture (" +
                             source.description() + ") has " + mocap::to_string(source.bodies()));
  return recording;
}

std::vector<double> list(const Eigen::Vector3d& v) { return {v.data(), v.data() + 3}; }

// Three lines, with values and deviations in thousandths of their units.
void print_components(const char* what, const char* unit, const Eigen::Vector3d& value,
                      const Eigen::Vector3d& deviation, const std::array<bool, 3>& told) {
  constexpr const char* kAxes[] = {"forward", "right", "down"};
  for (int i = 0; i < 3; ++i)
    std::printf("  %-28s %8.2f %-4s %s\n", fmt::format("{} {}", what, kAxes[i]).c_str(), 1e3 * value[i], unit,
                told[static_cast<std::size_t>(i)] ? fmt::format("(within {:.2f})", 2e3 * deviation[i]).c_str()
                                                  : "(as before)");
}

void print(const CalibrateOptions& options, const Misalignment& misalignment, const LeverArm& arm) {
  if (options.json) {
    const nlohmann::ordered_json json = {{"vehicle", options.vehicle},
                                         {"misalignment_rad", list(misalignment.vector)},
                                         {"misalignment_deviation_rad", list(misalignment.deviation)},
                                         {"lever_arm_frd_m", list(arm.frd)},
                                         {"lever_arm_deviation_m", list(arm.deviation)},
                                         {"residual_m", arm.residual_m}};
    std::printf("%s\n", io::json_text(json, 2).c_str());
    return;
  }
  constexpr std::array<bool, 3> kAll = {true, true, true};
  std::printf("%s, each with two standard deviations:\n", options.vehicle.c_str());
  print_components("misalignment about", "mrad", misalignment.vector, misalignment.deviation, kAll);
  print_components("lever arm", "mm", arm.frd, arm.deviation, kAll);
  std::printf("  the centre moved by %.2f mm RMS while the vehicle was turned\n", 1e3 * arm.residual_m);
}

// null: not told
nlohmann::ordered_json told_only(const Eigen::Vector3d& deviation, const std::array<bool, 3>& told) {
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (int i = 0; i < 3; ++i)
    out.push_back(told[static_cast<std::size_t>(i)] ? nlohmann::ordered_json(deviation[i]) : nullptr);
  return out;
}

void print(const CalibrateOptions& options, const FlightCalibration& calibration,
           const identification::BodyAlignment& found) {
  const Misalignment& misalignment = calibration.misalignment;
  const LeverArm& arm = calibration.lever_arm;
  if (options.json) {
    const nlohmann::ordered_json json = {
        {"vehicle", options.vehicle},
        {"misalignment_rad", list(misalignment.vector)},
        {"misalignment_deviation_rad", told_only(misalignment.deviation, calibration.misalignment_told)},
        {"lever_arm_frd_m", list(arm.frd)},
        {"lever_arm_deviation_m", told_only(arm.deviation, calibration.lever_arm_told)},
        {"vertical_rad", {found.vertical.x(), found.vertical.y()}},
        {"vertical_deviation_rad", {found.vertical_deviation.x(), found.vertical_deviation.y()}},
        {"pose_delay_s", found.pose_delay_s},
        {"pose_delay_deviation_s", found.pose_delay_deviation_s},
        {"duration_s", found.duration_s},
        {"poses", found.poses},
        {"refused_poses", found.refused},
        {"advice", calibration.advice}};
    std::printf("%s\n", io::json_text(json, 2).c_str());
    return;
  }
  std::printf("%s, from %.1f s with %zu poses, each with two standard deviations:\n", options.vehicle.c_str(),
              found.duration_s, found.poses);
  print_components("misalignment about", "mrad", misalignment.vector, misalignment.deviation,
                   calibration.misalignment_told);
  print_components("lever arm", "mm", arm.frd, arm.deviation, calibration.lever_arm_told);
  std::printf(
      "  the vertical of the motion capture is off by %.2f mrad to north and %.2f mrad to east (within "
      "%.2f)\n",
      1e3 * found.vertical.x(), 1e3 * found.vertical.y(), 2e3 * found.vertical_deviation.maxCoeff());
  std::printf("  the stamps of the poses are %.2f ms late (within %.2f)\n", 1e3 * found.pose_delay_s,
              2e3 * found.pose_delay_deviation_s);
  for (const std::string& sentence : calibration.advice) std::printf("  %s\n", sentence.c_str());
}

// The poses of a flight come from swiftlet-mocap, which uses the room file.
int calibrate_by_flight(const CalibrateOptions& options, const std::string& file, const std::string& text) {
  const mocap::SourceOptions& source = options.source;
  for (const auto& [name, given] :
       {std::pair{"--source", source.source}, std::pair{"--server", source.server},
        std::pair{"--mocap-interface", source.interface}, std::pair{"--frame", source.frame},
        std::pair{"--file", source.file}}) {
    if (!given.empty())
      throw io::InputError(
          fmt::format("{}: not with --hover or --log, whose poses come from swiftlet-mocap", name));
  }
  const mocap::Room room = mocap::parse_room(text, file);
  const mocap::VehicleBody* const body = mocap::find(room, options.vehicle);
  if (body == nullptr)
    throw io::InputError(file + ": vehicles: does not have the vehicle " + options.vehicle);
  identification::FlightLog log;
  if (options.hover) {
    runtime::StopSignal stop;
    dds::NodeSettings network = options.network;
    network.vehicle = options.vehicle;
    std::fprintf(stderr, "Recording %s for %g s.\n", options.vehicle.c_str(), options.time_s);
    log = receive_motion(network, options.time_s, stop);
  } else {
    log = read_motion(options.log, options.vehicle, options.from_s, options.until_s);
  }
  const identification::BodyAlignment found = identification::align_body(log, options.priors);
  const FlightCalibration calibration = calibrated(*body, found);
  print(options, calibration, found);
  if (options.dry_run) return io::kDone;
  io::write_atomically(
      file, with_calibration(text, file, options.vehicle, calibration.misalignment, calibration.lever_arm));
  std::fprintf(stderr, "wrote %s\n", file.c_str());
  return io::kDone;
}

int calibrate(const CalibrateOptions& options) {
  if (options.source.room.empty())
    throw io::InputError("--room is required: it says which body the vehicle is");
  const std::string file = io::configuration_file(io::kinds::kRoom, options.source.room);
  const std::string text = io::read_text_file(file);
  with_calibration(text, file, options.vehicle, {},
                   {});  // refuses a file without the keys before anything is asked for
  if (options.hover || !options.log.empty()) return calibrate_by_flight(options, file, text);
  runtime::StopSignal stop;
  const std::unique_ptr<mocap::Source> source = open_mocap_source(options.source, {options.vehicle});
  const mocap::Room room = mocap::room_of(options.source, {options.vehicle});
  const mocap::RoomFrame frame(room);
  const mocap::VehicleBody& vehicle = *mocap::find(room, options.vehicle);

  wait_for_enter(options,
                 "Put " + options.vehicle + " on level ground with its nose to the north of the room",
                 *source, stop);
  const Recording rest = record(*source, frame, vehicle, options.rest_s, stop);
  const Misalignment misalignment = misalignment_of(rest.poses, rest.seconds);
  wait_for_enter(
      options,
      fmt::format("Hold its centre of mass in place and turn it about all axes for {:g} s", options.turn_s),
      *source, stop);
  const Recording turn = record(*source, frame, vehicle, options.turn_s, stop);
  const LeverArm arm = lever_arm_of(turn.poses, misalignment, turn.seconds);

  print(options, misalignment, arm);
  if (options.dry_run) return io::kDone;
  io::write_atomically(file, with_calibration(text, file, options.vehicle, misalignment, arm));
  std::fprintf(stderr, "wrote %s\n", file.c_str());
  return io::kDone;
}

}  // namespace

io::Command add_mocap_calibrate_command(runtime::CommandLine mocap) {
  const auto options = std::make_shared<CalibrateOptions>();
  const runtime::CommandLine app =
      mocap.add_subcommand("calibrate", "Align a body with its vehicle, and write that into the room file");
  app.footer(
      "The vehicle first stands level, then is turned by hand about its centre of mass; or, with --hover or "
      "--log, "
      "its IMU is compared with the poses of a flight (docs/swap-mocap.md).\n\n"
      "example: swiftlet mocap calibrate kl1 --room lab.yaml\n"
      "example: swiftlet mocap calibrate kl1 --room lab.yaml --hover\n"
      "example: swiftlet mocap calibrate kl1 --room lab.yaml --log flights/calibration");
  app.add_option("vehicle", options->vehicle, "Vehicle of the room").show_default();
  mocap::add_source_options(app, options->source);
  runtime::Option rest =
      app.add_option("--rest-time", options->rest_s, "How long it stands, s").range(1.0, 60.0).show_default();
  runtime::Option turn = app.add_option("--turn-time", options->turn_s, "How long it is turned, s")
                             .range(2.0, 600.0)
                             .show_default();
  app.add_flag("--no-prompt", options->no_prompt, "Do not wait for Enter");
  runtime::Option hover =
      app.add_flag("--hover", options->hover,
                   "From the vehicle in flight: it hovers, or better turns and flies short legs");
  runtime::Option log =
      app.add_option("--log", options->log,
                     "From a recorded flight: its record, or an MCAP file of 'swiftlet record'")
          .type_name("PATH");
  hover.excludes(log).excludes(rest).excludes(turn);
  log.excludes(rest).excludes(turn);
  app.add_option("--time", options->time_s, "How long --hover records, s of the vehicle's clock")
      .range(identification::kShortestAlignment_s, 120.0)
      .show_default()
      .needs(hover);
  app.add_option("--from", options->from_s, "Begin in --log, s of its clock").finite().needs(log);
  app.add_option("--until", options->until_s, "End in --log, s of its clock").finite().needs(log);
  app.add_option("--accelerometer-bias", options->priors.accelerometer_bias_m_s2,
                 "Standard deviation of the accelerometer's bias for --hover and --log, m/s^2")
      .range(1e-4, 10.0)
      .show_default();
  add_network_options(app, options->network);
  app.remove_option("--vehicle-name");
  app.add_flag("--dry-run", options->dry_run, "Do not write the room file");
  app.add_flag("--json", options->json, "Print JSON");
  return {app, [options] { return calibrate(*options); }};
}

}  // namespace swiftlet::ground
