#include "swiftlet/ground/client/action.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "swiftlet/ground/client/client.hpp"

namespace swiftlet::ground {
namespace {

constexpr std::chrono::milliseconds kActionPollPeriod{100};
constexpr std::chrono::seconds kSilence{3};

bool is_of(const msg::RequestStatus& request, const control::RequestKey& key) {
  return request.state() != msg::RequestStatus_Constants::UNKNOWN && request.client() == key.client &&
         request.id() == key.id;
}

}  // namespace

const msg::RequestStatus* find_request(const msg::ControlStatus& status, const control::RequestKey& key) {
  if (is_of(status.request(), key)) return &status.request();
  const auto& earlier = status.earlier_requests();
  const auto found = std::find_if(earlier.begin(), earlier.end(),
                                  [&](const msg::RequestStatus& request) { return is_of(request, key); });
  return found == earlier.end() ? nullptr : &*found;
}

std::optional<ActionResult> action_result_of(const msg::RequestStatus& request) {
  switch (request.state()) {
    case msg::RequestStatus_Constants::SUCCEEDED:
      return ActionResult{ActionResult::Kind::kCompleted, ""};
    case msg::RequestStatus_Constants::CANCELED:
      return ActionResult{ActionResult::Kind::kCanceled, request.result().c_str()};
    case msg::RequestStatus_Constants::ABORTED:
      return ActionResult{ActionResult::Kind::kAborted, request.result().c_str()};
    default:
      return std::nullopt;
  }
}

std::optional<ActionResult> action_result_by(const msg::ControlStatus& status, const Result& answer) {
  if (const msg::RequestStatus* const request = find_request(status, answer.key))
    return action_result_of(*request);
  if (status.stamp_ns() <= answer.stamp_ns) return std::nullopt;
  return ActionResult{
      ActionResult::Kind::kLost,
      "the controller no longer lists this request: it was restarted, or newer requests replaced it"};
}

std::string interruption_by(const ActionResult& canceled) {
  const std::string request = "canceled by a newer request: ";
  const std::string begin = "mission interrupted: ";
  if (canceled.reason.compare(0, request.size(), request) == 0)
    return begin + "another ground tool sent " + canceled.reason.substr(request.size());
  if (canceled.reason == "canceled by setpoints") return begin + "another ground tool sent setpoints";
  return begin + canceled.reason;
}

ActionHandle::ActionHandle(std::shared_ptr<const Client> client, Result answer)
    : client_(std::move(client)), answer_(std::move(answer)) {}

double ActionHandle::progress() const {
  const std::optional<msg::RequestStatus> status = client_->reported_status(answer_.key);
  return status ? status->progress() : 0.0;
}

ActionResult ActionHandle::wait(std::chrono::milliseconds timeout) const {
  if (!accepted()) return {ActionResult::Kind::kNotAccepted, answer_.reason};
  if (const auto status = client_->reported_status(answer_.key)) {
    if (const auto result = action_result_of(*status)) return *result;
  }
  const auto deadline = Clock::now() + timeout;
  while (true) {
    std::optional<ActionResult> result;
    bool silent = false;
    const auto ended = [&](const View& view) {
      const auto last_heard = std::max(view.control.received, answered_);
      silent = Clock::now() - last_heard > kSilence;
      if (view.control.seen()) result = action_result_by(view.control.message, answer_);
      return result || silent;
    };
    client_->wait(std::min(kActionPollPeriod, timeout), ended);
    if (result) return *result;
    if (silent)
      return {ActionResult::Kind::kLost,
              "no control_status for 3 s from the control service of " + client_->where()};
    if (Clock::now() < deadline) continue;
    const double waited_s = std::chrono::duration<double>(timeout).count();
    char text[64];
    std::snprintf(text, sizeof text, "not done after %.1f s", waited_s);
    return {ActionResult::Kind::kTimedOut, text};
  }
}

std::future<ActionResult> ActionHandle::future(std::chrono::milliseconds timeout) const {
  return std::async(std::launch::async, [action = *this, timeout] { return action.wait(timeout); });
}

}  // namespace swiftlet::ground
