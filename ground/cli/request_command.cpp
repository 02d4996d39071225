#include "swiftlet/ground/cli/request_command.hpp"

#include <cstdio>
#include <future>
#include <mutex>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "swiftlet/ground/command_line/network_options.hpp"

namespace swiftlet::ground {
namespace {

// The result of a request to one vehicle.
struct RequestOutcome {
  std::string vehicle;
  Result answer;
  std::optional<ActionResult> action_result;  // unset without --wait

  bool failed() const { return action_result ? !action_result->done() : !answer.accepted(); }
  const std::string& reason() const { return action_result ? action_result->reason : answer.reason; }
};

nlohmann::ordered_json to_json(const RequestOutcome& outcome) {
  nlohmann::ordered_json json = {{"accepted", outcome.answer.accepted()}};
  if (outcome.action_result) json["done"] = outcome.action_result->done();
  if (!outcome.reason().empty()) json["reason"] = outcome.reason();
  return json;
}

runtime::CommandLine add_subcommand(runtime::CommandLine root, const std::string& name,
                                    const std::string& description, const std::string& example,
                                    const std::shared_ptr<CommandOptions>& options, Vehicles vehicles) {
  const runtime::CommandLine app = root.add_subcommand(name, description);
  add_network_options(app, options->network, vehicles);
  app.add_option("--timeout", options->timeout_s, "longest wait for the acknowledgement, s")
      .range(0.1, 3600.0)
      .show_default();
  app.add_flag("--json", options->json, "print JSON");
  app.footer("example: " + example);
  return app;
}

}  // namespace

runtime::CommandLine add_vehicle_subcommand(runtime::CommandLine root, const std::string& name,
                                            const std::string& description, const std::string& example,
                                            const std::shared_ptr<CommandOptions>& options) {
  return add_subcommand(root, name, description, example, options, Vehicles::kOne);
}

runtime::CommandLine add_request_subcommand(runtime::CommandLine root, const std::string& name,
                                            const std::string& description, const std::string& example,
                                            const std::shared_ptr<RequestOptions>& options,
                                            Vehicles vehicles) {
  const runtime::CommandLine app = add_subcommand(root, name, description, example, options, vehicles);
  app.add_option("--wait", options->wait_s,
                 "wait at most so many s until the action completes; exit code 1 if it does not")
      .range(0.1, 3600.0);
  return app;
}

int run_request(const RequestOptions& options, const std::string& what,
                const std::function<ActionHandle(Vehicle&)>& ask) {
  const std::vector<std::string> names = split_list(options.network.vehicle);
  const Context context(options.network);
  std::mutex printing;
  const auto ask_one = [&](const std::string& name) {
    Vehicle vehicle(context, name);
    const ActionHandle action = ask(vehicle);
    RequestOutcome outcome{name, action.answer(), std::nullopt};
    if (outcome.answer.accepted() && !options.json) {
      const std::lock_guard<std::mutex> lock(printing);
      const std::string& note = outcome.answer.reason;
      std::printf("%s: accepted by %s%s%s\n", what.c_str(), name.c_str(), note.empty() ? "" : ": ",
                  note.c_str());
      std::fflush(stdout);
    }
    if (outcome.answer.accepted() && options.wait_s)
      outcome.action_result =
          action.wait(std::chrono::milliseconds(static_cast<std::int64_t>(*options.wait_s * 1e3)));
    return outcome;
  };
  std::vector<std::future<RequestOutcome>> pending;
  pending.reserve(names.size());
  for (const std::string& name : names) pending.push_back(std::async(std::launch::async, ask_one, name));
  std::vector<RequestOutcome> all;
  all.reserve(names.size());
  for (std::future<RequestOutcome>& one : pending) all.push_back(one.get());

  const bool alone = all.size() == 1;
  if (options.json) {
    nlohmann::ordered_json json;
    for (const RequestOutcome& outcome : all) json[outcome.vehicle] = to_json(outcome);
    std::printf("%s\n", (alone ? json.front() : json).dump().c_str());
  }
  bool failed = false;
  for (const RequestOutcome& outcome : all) {
    const std::string who = alone ? what : what + ": " + outcome.vehicle;
    if (outcome.failed()) std::fprintf(stderr, "swiftlet: %s: %s\n", who.c_str(), outcome.reason().c_str());
    if (outcome.action_result && outcome.action_result->done() && !options.json)
      std::printf("%s: done\n", who.c_str());
    failed = failed || outcome.failed();
  }
  return failed ? kFailed : kDone;
}

void log_connection(Vehicle& vehicle, const std::string& command) {
  vehicle.on_connection([command, first = true](const ConnectionEvent& event) mutable {
    if (!std::exchange(first, false)) std::fprintf(stderr, "%s: %s\n", command.c_str(), event.text.c_str());
  });
}

Command add_plain_request_command(runtime::CommandLine root, const std::string& name,
                                  const std::string& description,
                                  ActionHandle (Vehicle::*ask)(std::chrono::milliseconds)) {
  const auto options = std::make_shared<RequestOptions>();
  const runtime::CommandLine app = add_request_subcommand(
      root, name, description, "swiftlet " + name + " --vehicle-name kl1,kl2", options);
  return {app, [options, name, ask] {
            return run_request(*options, name,
                               [&](Vehicle& vehicle) { return (vehicle.*ask)(options->timeout()); });
          }};
}

}  // namespace swiftlet::ground
