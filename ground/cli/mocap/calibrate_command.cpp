// `swiftlet mocap calibrate`: aligns a body of the motion capture with its vehicle, and writes that into the room file.
#include <chrono>
#include <cstdio>
#include <memory>
#include <poll.h>
#include <stdexcept>
#include <string>
#include <unistd.h>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "swiftlet/ground/cli/mocap/calibration.hpp"
#include "swiftlet/ground/cli/mocap/mocap_commands.hpp"
#include "swiftlet/io/atomic_write.hpp"
#include "swiftlet/io/configuration.hpp"
#include "swiftlet/io/text_file.hpp"

namespace swiftlet::ground {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kPoll{20};
constexpr double kLongestWait_s = 10.0;  // for the first pose

struct Options {
  mocap::SourceOptions source;
  std::string vehicle = "kl1";
  double rest_s = 3.0;
  double turn_s = 20.0;
  bool no_prompt = false;
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
void wait_for_enter(const Options& options, const std::string& request, mocap::Source& source,
                    runtime::StopSignal& stop) {
  std::fprintf(stderr, "%s%s\n", request.c_str(), options.no_prompt ? "." : ", then press Enter.");
  if (options.no_prompt) return;
  mocap::SourceFrame unused;
  while (!was_entered()) {
    require_going_on(stop);
    source.receive(unused, kPoll);
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
    if (!source.receive(received, kPoll)) continue;
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

void print(const Options& options, const Misalignment& misalignment, const LeverArm& arm) {
  const auto list = [](const Eigen::Vector3d& v) { return std::vector<double>(v.data(), v.data() + 3); };
  if (options.json) {
    const nlohmann::ordered_json json = {{"vehicle", options.vehicle},
                                         {"misalignment_rad", list(misalignment.vector)},
                                         {"misalignment_deviation_rad", list(misalignment.deviation)},
                                         {"lever_arm_frd_m", list(arm.frd)},
                                         {"lever_arm_deviation_m", list(arm.deviation)},
                                         {"residual_m", arm.residual_m}};
    std::printf("%s\n", json.dump(2).c_str());
    return;
  }
  std::printf("%s, each with two standard deviations:\n", options.vehicle.c_str());
  for (int i = 0; i < 3; ++i)
    std::printf("  misalignment about %-8s %8.2f mrad (within %.2f)\n",
                i == 0   ? "forward"
                : i == 1 ? "right"
                         : "down",
                1e3 * misalignment.vector[i], 2e3 * misalignment.deviation[i]);
  for (int i = 0; i < 3; ++i)
    std::printf("  lever arm %-17s %8.2f mm   (within %.2f)\n",
                i == 0   ? "forward"
                : i == 1 ? "right"
                         : "down",
                1e3 * arm.frd[i], 2e3 * arm.deviation[i]);
  std::printf("  the centre moved by %.2f mm RMS while the vehicle was turned\n", 1e3 * arm.residual_m);
}

int calibrate(const Options& options) {
  if (options.source.room.empty()) throw InputError("--room is required: it says which body the vehicle is");
  const std::string file = runtime::configuration_file(runtime::kinds::kRoom, options.source.room);
  const std::string text = runtime::read_text_file(file);
  with_calibration(text, file, options.vehicle, {},
                   {});  // refuses a file without the keys before anything is asked for
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
  if (options.dry_run) return kDone;
  runtime::write_atomically(file, with_calibration(text, file, options.vehicle, misalignment, arm));
  std::fprintf(stderr, "wrote %s\n", file.c_str());
  return kDone;
}

}  // namespace

Command add_mocap_calibrate_command(runtime::CommandLine mocap) {
  const auto options = std::make_shared<Options>();
  const runtime::CommandLine app =
      mocap.add_subcommand("calibrate", "Align a body with its vehicle, and write that into the room file");
  app.footer(
      "The vehicle first stands level, then is turned by hand about its centre of mass "
      "(docs/swap-mocap.md).\n\n"
      "example: swiftlet mocap calibrate kl1 --room lab.yaml");
  app.add_option("vehicle", options->vehicle, "Vehicle of the room").show_default();
  mocap::add_source_options(app, options->source);
  app.add_option("--rest-time", options->rest_s, "How long it stands, s").range(1.0, 60.0).show_default();
  app.add_option("--turn-time", options->turn_s, "How long it is turned, s").range(2.0, 600.0).show_default();
  app.add_flag("--no-prompt", options->no_prompt, "Do not wait for Enter");
  app.add_flag("--dry-run", options->dry_run, "Do not write the room file");
  app.add_flag("--json", options->json, "Print JSON");
  return {app, [options] { return calibrate(*options); }};
}

}  // namespace swiftlet::ground
