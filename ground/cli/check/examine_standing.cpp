#include "swiftlet/ground/cli/check/examine_standing.hpp"

#include "swiftlet/ground/vehicle_check/standing_vehicle.hpp"

namespace swiftlet::ground {
namespace {

using namespace std::chrono_literals;

constexpr auto kWaitStep = 50ms;
constexpr int kAttempts = 3;

bool wait_for_vehicle(SampleRecorder& recorder, const StandingRequest& request) {
  for (auto waited = 0ms; waited < request.timeout && !recorder.hears_vehicle(); waited += kWaitStep)
    if (!recorder.record(kWaitStep, request.cancelled)) break;
  return recorder.hears_vehicle();
}

}  // namespace

StandingExamination examine_standing(SampleRecorder& recorder, const StandingRequest& request) {
  StandingExamination examination;
  const int attempts = wait_for_vehicle(recorder, request) ? kAttempts : 1;
  for (int attempt = 0; attempt < attempts; ++attempt) {
    recorder.restart();
    recorder.record(request.time, request.cancelled);
    examination.recording = recorder.recording();
    examination.results =
        check_standing_vehicle(examination.recording, request.vehicle, request.mocap_required);
    if (!any_failed(examination.results) || request.cancelled()) break;
  }
  return examination;
}

}  // namespace swiftlet::ground
