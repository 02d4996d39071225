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

// What became of a request to one vehicle.
struct Asked {
  std::string vehicle;
  Result answer;
  std::optional<ActionResult> ending;  // if it was waited for

  bool failed() const { return ending ? !ending->done() : !answer.accepted(); }
  const std::string& reason() const { return ending ? ending->reason : answer.reason; }
};

nlohmann::ordered_json to_json(const Asked& asked) {
  nlohmann::ordered_json json = {{"accepted", asked.answer.accepted()}};
  if (asked.ending) json["done"] = asked.ending->done();
  if (asked.failed()) json["reason"] = asked.reason();
  return json;
}

runtime::CommandLine add_subcommand(runtime::CommandLine root, const std::string& name,
                                    const std::string& description, const std::string& example,
                                    const std::shared_ptr<RequestOptions>& options, Vehicles vehicles) {
  const runtime::CommandLine app = root.add_subcommand(name, description);
  add_network_options(app, options->network, vehicles);
  app.add_option("--timeout", options->timeout_s, "longest wait for an answer, s")
      .range(0.1, 3600.0)
      .show_default();
  app.add_flag("--json", options->json, "print the answer as JSON");
  app.footer("example: " + example);
  return app;
}

}  // namespace

runtime::CommandLine add_request_subcommand(runtime::CommandLine root, const std::string& name,
                                            const std::string& description, const std::string& example,
                                            const std::shared_ptr<RequestOptions>& options) {
  return add_subcommand(root, name, description, example, options, Vehicles::kOne);
}

runtime::CommandLine add_ask_subcommand(runtime::CommandLine root, const std::string& name,
                                        const std::string& description, const std::string& example,
                                        const std::shared_ptr<AskOptions>& options, Vehicles vehicles) {
  const runtime::CommandLine app = add_subcommand(root, name, description, example, options, vehicles);
  app.add_option("--wait", options->wait_s,
                 "return when it is done, after so many s at the latest; exit code 1 if it is not")
      .range(0.1, 3600.0);
  return app;
}

int run_request(const AskOptions& options, const std::string& what,
                const std::function<ActionHandle(Vehicle&)>& ask) {
  const std::vector<std::string> names = split_list(options.network.vehicle);
  const Context context(options.network);
  std::mutex printing;
  const auto ask_one = [&](const std::string& name) {
    Vehicle vehicle(context, name);
    const ActionHandle manoeuvre = ask(vehicle);
    Asked asked{name, manoeuvre.answer(), std::nullopt};
    if (asked.answer.accepted() && !options.json) {
      const std::lock_guard<std::mutex> lock(printing);
      std::printf("%s: accepted by %s\n", what.c_str(), name.c_str());
      std::fflush(stdout);
    }
    if (asked.answer.accepted() && options.wait_s)
      asked.ending =
          manoeuvre.wait(std::chrono::milliseconds(static_cast<std::int64_t>(*options.wait_s * 1e3)));
    return asked;
  };
  std::vector<std::future<Asked>> asking;
  asking.reserve(names.size());
  for (const std::string& name : names) asking.push_back(std::async(std::launch::async, ask_one, name));
  std::vector<Asked> all;
  all.reserve(names.size());
  for (std::future<Asked>& one : asking) all.push_back(one.get());

  const bool alone = all.size() == 1;
  if (options.json) {
    nlohmann::ordered_json json;
    for (const Asked& asked : all) json[asked.vehicle] = to_json(asked);
    std::printf("%s\n", (alone ? json.front() : json).dump().c_str());
  }
  bool failed = false;
  for (const Asked& asked : all) {
    const std::string who = alone ? what : what + ": " + asked.vehicle;
    if (asked.failed()) std::fprintf(stderr, "swiftlet: %s: %s\n", who.c_str(), asked.reason().c_str());
    if (asked.ending && asked.ending->done() && !options.json) std::printf("%s: done\n", who.c_str());
    failed = failed || asked.failed();
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
  const auto options = std::make_shared<AskOptions>();
  const runtime::CommandLine app =
      add_ask_subcommand(root, name, description, "swiftlet " + name + " --vehicle-name kl1,kl2", options);
  return {app, [options, name, ask] {
            return run_request(*options, name,
                               [&](Vehicle& vehicle) { return (vehicle.*ask)(options->timeout()); });
          }};
}

}  // namespace swiftlet::ground
