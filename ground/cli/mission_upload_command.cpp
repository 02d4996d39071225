#include <cstdio>

#include <nlohmann/json.hpp>

#include "swiftlet/ground/cli/commands.hpp"
#include "swiftlet/ground/cli/request_command.hpp"
#include "swiftlet/ground/cli/sent_mission.hpp"
#include "swiftlet/io/format.hpp"
#include "swiftlet/io/json_text.hpp"

namespace swiftlet::ground {
namespace {

struct MissionUploadOptions : CommandOptions {
  SentFileOptions sent;
};

int upload(const MissionUploadOptions& options) {
  const SentFile sent(options.sent, options.network, options.timeout());
  const io::MissionFile file = sent.mission();
  Vehicle vehicle(options.network);
  sent.require_flyable(vehicle, file, options.timeout());
  const Result answer = vehicle.upload(file.mission, options.timeout()).answer();
  if (options.json) {
    nlohmann::ordered_json json = {{"mission", file.name}, {"accepted", answer.accepted()}};
    if (answer.accepted()) json["mission_id"] = vehicle.uploaded_id();
    if (!answer.accepted()) json["reason"] = answer.reason;
    std::printf("%s\n", io::json_text(json).c_str());
  } else if (answer.accepted()) {
    std::printf("%s: uploaded to %s as mission %llu, %s\n", file.name.c_str(),
                options.network.vehicle.c_str(), static_cast<unsigned long long>(vehicle.uploaded_id()),
                io::counted(file.mission.items.size(), "item").c_str());
  }
  if (!answer.accepted())
    std::fprintf(stderr, "swiftlet: mission %s: %s\n", file.name.c_str(), answer.reason.c_str());
  return answer.accepted() ? io::kDone : io::kFailed;
}

}  // namespace

io::Command add_mission_upload_command(runtime::CommandLine mission) {
  const auto options = std::make_shared<MissionUploadOptions>();
  const runtime::CommandLine app = add_vehicle_subcommand(
      mission, "upload", "Upload a mission to the vehicle, to be started with `mission start`",
      "swiftlet mission upload square && swiftlet mission start", options);
  add_sent_file_options(
      app, options->sent,
      "mission file, or the name of one in config/missions; also CSV or QGroundControl .plan");
  return {app, [options] { return upload(*options); }};
}

}  // namespace swiftlet::ground
