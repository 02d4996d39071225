#include "swiftlet/ground/cli/request_command.hpp"

#include <algorithm>
#include <cstdio>
#include <future>
#include <mutex>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "swiftlet/ground/client/network_options.hpp"
#include "swiftlet/io/json_text.hpp"
#include "swiftlet/services/messages/vehicle_names.hpp"

namespace swiftlet::ground {
namespace {

constexpr std::chrono::seconds kConfirmationTimeout{1};  // of a stop that no IMU sample let control evaluate

// A request to one vehicle and its result.
struct RequestOutcome {
  std::unique_ptr<Vehicle> vehicle;
  control::Mode mode_before = control::Mode::kDisarmed;
  Result answer;
  std::optional<ActionHandle> action;         // unset until the request is sent
  std::optional<ActionResult> action_result;  // unset with --no-wait

  bool failed() const { return action_result ? !action_result->done() : !answer.accepted(); }
  const std::string& reason() const {
    return action_result && !action_result->reason.empty() ? action_result->reason : answer.reason;
  }
};
using RequestOutcomes = std::vector<RequestOutcome>;

nlohmann::ordered_json to_json(const RequestOutcome& outcome) {
  nlohmann::ordered_json json = {{"accepted", outcome.answer.accepted()}};
  if (outcome.action_result && outcome.answer.accepted()) json["done"] = outcome.action_result->done();
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

void for_all(RequestOutcomes& outcomes, const std::function<void(RequestOutcome&)>& act) {
  std::vector<std::future<void>> pending;
  pending.reserve(outcomes.size());
  for (RequestOutcome& outcome : outcomes)
    pending.push_back(std::async(std::launch::async, [&act, &outcome] { act(outcome); }));
  for (std::future<void>& one : pending) one.get();
}

std::string failed_names(const RequestOutcomes& outcomes) {
  std::string names;
  for (const RequestOutcome& outcome : outcomes) {
    if (!outcome.answer.accepted()) names += (names.empty() ? "" : ", ") + outcome.vehicle->name();
  }
  return names;
}

void send(RequestOutcome& outcome, const VehicleRequest& request) {
  outcome.action = request.ask(*outcome.vehicle);
  outcome.answer = outcome.action->answer();
}

// The note of a request that is done when it is accepted becomes a part of its result.
void print_acceptance(const RequestOutcome& outcome, const VehicleRequest& request,
                      const RequestOptions& options) {
  if (options.json || !outcome.answer.accepted()) return;
  const bool noted = !outcome.answer.reason.empty() && (options.no_wait || !request.done_when_accepted);
  std::printf("%s: accepted by %s%s%s\n", request.what.c_str(), outcome.vehicle->name().c_str(),
              noted ? ": " : "", noted ? outcome.answer.reason.c_str() : "");
  std::fflush(stdout);
}

// Sends the request to each vehicle, whatever the others answer. Prints each acceptance as soon as it arrives.
void send_to_each(RequestOutcomes& outcomes, const VehicleRequest& request, const RequestOptions& options) {
  std::mutex printing;
  for_all(outcomes, [&](RequestOutcome& outcome) {
    send(outcome, request);
    const std::lock_guard<std::mutex> lock(printing);
    print_acceptance(outcome, request, options);
  });
}

// Returns false if a vehicle is not found. Its answer and those of the others then say so.
bool find_all(RequestOutcomes& outcomes, const RequestOptions& options) {
  for_all(outcomes, [&](RequestOutcome& outcome) {
    outcome.answer = outcome.vehicle->connect(options.timeout());
    outcome.mode_before = outcome.vehicle->state().mode;
  });
  const std::string missing = failed_names(outcomes);
  if (missing.empty()) return true;
  for (RequestOutcome& outcome : outcomes) {
    if (outcome.answer.accepted())
      outcome.answer = {Result::Kind::kCancelled, "nothing was sent, because " + missing + " was not found"};
  }
  return false;
}

// Takes the request back from those that accepted it.
void take_back(RequestOutcomes& outcomes, const VehicleRequest& request, const std::string& why) {
  for_all(outcomes, [&](RequestOutcome& outcome) {
    const bool may_obey = outcome.answer.accepted() || outcome.answer.kind == Result::Kind::kSilence;
    if (!may_obey || outcome.mode_before != request.undo_from) return;
    const Result undone = request.undo(*outcome.vehicle).answer();
    if (!outcome.answer.accepted()) return;
    const std::string now =
        undone.accepted() ? request.undone : request.not_undone + " (" + undone.reason + ")";
    outcome.answer = {Result::Kind::kCancelled, now + ", because " + why};
  });
}

// Sends the request to all, or takes it back from those that accepted it.
void send_to_all_or_none(RequestOutcomes& outcomes, const VehicleRequest& request,
                         const RequestOptions& options) {
  if (!find_all(outcomes, options)) return;
  const auto sent = std::chrono::steady_clock::now();
  for_all(outcomes, [&](RequestOutcome& outcome) { send(outcome, request); });
  const double took_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - sent).count();
  const std::string refusing = failed_names(outcomes);
  if (!refusing.empty()) {
    take_back(outcomes, request, refusing + " " + request.cause);
  } else if (request.skew_s && took_s > *request.skew_s) {
    take_back(outcomes, request,
              fmt::format("the last one may have begun {:.2f} s after the first; the limit is {:g} s", took_s,
                          *request.skew_s));
  }
  for (const RequestOutcome& outcome : outcomes) print_acceptance(outcome, request, options);
}

// An interrupt signal has cancelled requests. A controller may have accepted one before that.
void rest_unanswered(RequestOutcomes& outcomes, OnInterrupt on_interrupt) {
  for_all(outcomes, [on_interrupt](RequestOutcome& outcome) {
    if (outcome.answer.kind != Result::Kind::kCancelled || !outcome.action) return;
    outcome.answer.reason =
        outcome.vehicle->connected() ? rest_after_interrupt(*outcome.vehicle, on_interrupt) : "interrupted";
  });
}

// A note at the acceptance of such a request says what the controller cannot confirm yet.
ActionResult result_when_accepted(const RequestOutcome& outcome) {
  if (outcome.answer.reason.empty()) return {ActionResult::Kind::kCompleted, ""};
  ActionResult result = outcome.action->wait(kConfirmationTimeout);
  if (result.done()) return result;
  return {result.kind, "published and accepted by the controller, not confirmed: " + outcome.answer.reason};
}

void await_all(RequestOutcomes& outcomes, const VehicleRequest& request, const RequestOptions& options,
               const Interrupts& interrupts) {
  std::vector<RequestOutcome*> accepted;
  std::vector<AwaitedAction> actions;
  for (RequestOutcome& outcome : outcomes) {
    if (!outcome.answer.accepted()) continue;
    if (request.done_when_accepted) {
      outcome.action_result = result_when_accepted(outcome);
    } else {
      accepted.push_back(&outcome);
      actions.push_back({outcome.vehicle.get(), *outcome.action});
    }
  }
  const std::vector<ActionResult> results =
      await_actions(actions, request.what, request.on_interrupt, interrupts, options.wait_s);
  for (std::size_t i = 0; i < results.size(); ++i) accepted[i]->action_result = results[i];
}

void print_json(const RequestOutcomes& outcomes) {
  nlohmann::ordered_json json;
  for (const RequestOutcome& outcome : outcomes) json[outcome.vehicle->name()] = to_json(outcome);
  std::printf("%s\n", io::json_text(outcomes.size() == 1 ? json.front() : json).c_str());
}

// Some reasons begin with the name of the request, which the line already has.
std::string without_prefix(const std::string& reason, const std::string& what) {
  const std::string prefix = what + ": ";
  return reason.compare(0, prefix.size(), prefix) == 0 ? reason.substr(prefix.size()) : reason;
}

void print_results(const RequestOutcomes& outcomes, const std::string& what, bool json) {
  for (const RequestOutcome& outcome : outcomes) {
    const std::string who = outcomes.size() == 1 ? what : what + ": " + outcome.vehicle->name();
    if (outcome.failed()) {
      std::fprintf(stderr, "swiftlet: %s: %s\n", who.c_str(), without_prefix(outcome.reason(), what).c_str());
    }
    if (outcome.action_result && outcome.action_result->done() && !json)
      std::printf("%s: done\n", who.c_str());
  }
}

}  // namespace

runtime::CommandLine add_vehicle_subcommand(runtime::CommandLine root, const std::string& name,
                                            const std::string& description, const std::string& example,
                                            const std::shared_ptr<CommandOptions>& options,
                                            Vehicles vehicles) {
  return add_subcommand(root, name, description, example, options, vehicles);
}

runtime::CommandLine add_request_subcommand(runtime::CommandLine root, const std::string& name,
                                            const std::string& description, const std::string& example,
                                            const std::shared_ptr<RequestOptions>& options,
                                            Vehicles vehicles) {
  const runtime::CommandLine app = add_subcommand(root, name, description, example, options, vehicles);
  runtime::Option no_wait = app.add_flag("--no-wait", options->no_wait,
                                         "return as soon as the request is accepted; default: wait until the "
                                         "action completes");
  app.add_option("--wait", options->wait_s,
                 "wait at most so many s until the action completes; exit code 1 if it does not")
      .range(0.1, 3600.0)
      .excludes(no_wait);
  return app;
}

int run_request(const RequestOptions& options, const VehicleRequest& request) {
  const Context context(options.network);
  RequestOutcomes outcomes;
  for (const std::string& name : messages::vehicles_of_list(options.network.vehicle)) {
    RequestOutcome outcome;
    outcome.vehicle = std::make_unique<Vehicle>(context, name);
    outcomes.push_back(std::move(outcome));
  }
  const Interrupts interrupts;
  for (RequestOutcome& outcome : outcomes)
    outcome.vehicle->cancel_when([&] { return interrupts.count() > 0; });
  if (request.undo) {
    send_to_all_or_none(outcomes, request, options);
  } else {
    send_to_each(outcomes, request, options);
  }
  if (interrupts.count() > 0) rest_unanswered(outcomes, request.on_interrupt);
  if (!options.no_wait) await_all(outcomes, request, options, interrupts);
  if (options.json) print_json(outcomes);
  print_results(outcomes, request.what, options.json);
  const bool failed = std::any_of(outcomes.begin(), outcomes.end(),
                                  [](const RequestOutcome& outcome) { return outcome.failed(); });
  return failed ? io::kFailed : io::kDone;
}

void log_connection(Vehicle& vehicle, const std::string& command) {
  vehicle.on_connection([command, first = true](const ConnectionEvent& event) mutable {
    if (!std::exchange(first, false)) std::fprintf(stderr, "%s: %s\n", command.c_str(), event.text.c_str());
  });
}

io::Command add_plain_request_command(runtime::CommandLine root, const PlainRequest& request) {
  const auto options = std::make_shared<RequestOptions>();
  const std::string name = request.name;
  const runtime::CommandLine app = add_request_subcommand(
      root, name, request.description, "swiftlet " + name + " --vehicle-name kl1,kl2", options);
  return {app, [options, request] {
            const auto call = [&](ActionHandle (Vehicle::*method)(std::chrono::milliseconds)) {
              return [&options, method](Vehicle& vehicle) { return (vehicle.*method)(options->timeout()); };
            };
            VehicleRequest sent{request.name, call(request.ask), request.on_interrupt,
                                request.done_when_accepted};
            if (request.undo != nullptr) sent.undo = call(request.undo);
            return run_request(*options, sent);
          }};
}

}  // namespace swiftlet::ground
