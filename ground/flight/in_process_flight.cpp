#include "swiftlet/ground/flight/in_process_flight.hpp"

#include <chrono>

#include "swiftlet/ground/flight/flight_outcome.hpp"
#include "swiftlet/ground/flight/simulated_recorder.hpp"
#include "swiftlet/simulation/simulated_flight.hpp"

namespace swiftlet::ground {

simulation::ClosedLoop closed_loop(const LaunchConfiguration& plan, const simulation::World& world,
                                   std::uint64_t seed) {
  return {world.vehicle, plan.vehicle, world.simulation, plan.control, seed};
}

analysis::FlightReport fly_in_process(simulation::ClosedLoop& loop, const LaunchConfiguration& plan,
                                      std::uint64_t seed, record::Flight& flight, record::FlightTrace* trace,
                                      const std::function<bool()>& cancelled, SimulatedRecorder* messages) {
  control::Mission mission = plan.mission.mission;
  mission.id = 1;
  analysis::FlightReport report = report_of(plan);
  report.seed = seed;

  const auto start = std::chrono::steady_clock::now();
  simulation::FlightObserver observer{&flight, trace, cancelled, {}, {}};
  if (messages != nullptr) {
    observer.stepped = [messages] { messages->step(); };
    observer.requested = [messages](const control::Request& request, const control::Outcome& outcome) {
      messages->request(request, outcome);
    };
  }
  const simulation::SimulatedFlight flown = simulation::fly(loop, mission, plan.planned_duration_s, observer);
  report.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();

  report.simulated_s = flown.simulated_s;
  report.reason = flown.reason;
  judge(report, record::evaluate(flight));
  return report;
}

}  // namespace swiftlet::ground
