#include "ground/request_command.hpp"

#include <cstdio>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "ground/network_options.hpp"

namespace swiftlet::ground {

std::chrono::milliseconds milliseconds(double seconds) {
  return std::chrono::milliseconds(static_cast<std::int64_t>(seconds * 1e3));
}

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

int run_request(const RequestOptions& options, const std::string& what,
                const std::function<Answer(Client&)>& ask) {
  Client client(options.network);
  const Answer answer = ask(client);
  if (options.json) {
    nlohmann::ordered_json json = {{"accepted", answer.accepted()}};
    if (!answer.accepted()) json["reason"] = answer.reason;
    std::printf("%s\n", json.dump().c_str());
  } else if (answer.accepted()) {
    std::printf("%s: accepted by %s\n", what.c_str(), options.network.vehicle.c_str());
  }
  if (!answer.accepted()) std::fprintf(stderr, "swiftlet: %s: %s\n", what.c_str(), answer.reason.c_str());
  return answer.accepted() ? kDone : kFailed;
}

Command add_plain_request_command(CLI::App& root, const std::string& name, const std::string& description,
                                  std::uint8_t kind) {
  const auto options = std::make_shared<RequestOptions>();
  CLI::App* const app =
      add_request_subcommand(root, name, description, "swiftlet " + name + " --domain 7", options);
  return {app, [options, name, kind] {
            return run_request(*options, name, [&](Client& client) {
              msg::Command command;
              command.kind(kind);
              return client.command(command, milliseconds(options->timeout_s));
            });
          }};
}

}  // namespace swiftlet::ground
