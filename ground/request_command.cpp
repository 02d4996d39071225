#include "ground/request_command.hpp"

#include <cstdio>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "ground/network_options.hpp"

namespace swiftlet::ground {

CLI::App* add_request_subcommand(CLI::App& root, const std::string& name, const std::string& description,
                                 const std::string& example, const std::shared_ptr<RequestOptions>& options) {
  CLI::App* const app = root.add_subcommand(name, description);
  add_network_options(*app, options->network);
  app->add_option("--timeout", options->timeout_s, "longest wait for an answer, s")
      ->check(CLI::Range(0.1, 3600.0))
      ->capture_default_str();
  app->add_flag("--json", options->json, "print the answer as JSON");
  app->footer("example: " + example);
  return app;
}

CLI::App* add_ask_subcommand(CLI::App& root, const std::string& name, const std::string& description,
                             const std::string& example, const std::shared_ptr<AskOptions>& options) {
  CLI::App* const app = add_request_subcommand(root, name, description, example, options);
  app->add_option("--wait", options->wait_s,
                  "return when it is done, after so many s at the latest; exit code 1 if it is not")
      ->check(CLI::Range(0.1, 3600.0));
  return app;
}

int run_request(const AskOptions& options, const std::string& what,
                const std::function<Manoeuvre(Vehicle&)>& ask) {
  Vehicle vehicle(options.network);
  const Manoeuvre manoeuvre = ask(vehicle);
  const Answer& answer = manoeuvre.answer();
  const bool waits = answer.accepted() && options.wait_s;
  if (answer.accepted() && !options.json)
    std::printf("%s: accepted by %s\n", what.c_str(), options.network.vehicle.c_str());
  std::fflush(stdout);
  Ending ending = {Ending::Kind::kNotAccepted, answer.reason};
  if (waits)
    ending = manoeuvre.wait(std::chrono::milliseconds(static_cast<std::int64_t>(*options.wait_s * 1e3)));
  const bool failed = waits ? !ending.done() : !answer.accepted();

  if (options.json) {
    nlohmann::ordered_json json = {{"accepted", answer.accepted()}};
    if (waits) json["done"] = ending.done();
    if (failed) json["reason"] = ending.reason;
    std::printf("%s\n", json.dump().c_str());
  } else if (waits && ending.done()) {
    std::printf("%s: done\n", what.c_str());
  }
  if (failed) std::fprintf(stderr, "swiftlet: %s: %s\n", what.c_str(), ending.reason.c_str());
  return failed ? kFailed : kDone;
}

Command add_plain_request_command(CLI::App& root, const std::string& name, const std::string& description,
                                  Manoeuvre (Vehicle::*ask)(std::chrono::milliseconds)) {
  const auto options = std::make_shared<AskOptions>();
  CLI::App* const app =
      add_ask_subcommand(root, name, description, "swiftlet " + name + " --domain 7", options);
  return {app, [options, name, ask] {
            return run_request(*options, name,
                               [&](Vehicle& vehicle) { return (vehicle.*ask)(options->timeout()); });
          }};
}

}  // namespace swiftlet::ground
