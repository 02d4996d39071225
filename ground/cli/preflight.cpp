#include "swiftlet/ground/cli/preflight.hpp"

#include <chrono>
#include <cstdio>
#include <stdexcept>

#include "swiftlet/ground/cli/check/check_report.hpp"
#include "swiftlet/ground/cli/check/examine_standing.hpp"
#include "swiftlet/ground/cli/check/sample_recorder.hpp"

namespace swiftlet::ground {
namespace {

constexpr std::chrono::milliseconds kTime{1000};

}  // namespace

void require_sound_vehicles(const dds::NodeSettings& network, const std::vector<std::string>& vehicles) {
  for (const std::string& vehicle : vehicles) {
    dds::NodeSettings settings = network;
    settings.vehicle = vehicle;
    SampleRecorder recorder(settings);
    StandingRequest request;
    request.time = kTime;
    const StandingExamination examination = examine_standing(recorder, request);
    if (!any_failed(examination.results) || runs_in_lockstep(examination.recording)) continue;
    print_table(stderr, vehicle, examination.results);
    throw std::runtime_error("fly: " + vehicle +
                             " does not pass the check of vehicles and is not armed; "
                             "`swiftlet check vehicle` repeats it, --skip-check leaves it out");
  }
}

}  // namespace swiftlet::ground
