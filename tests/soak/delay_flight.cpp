#include "tests/soak/delay_flight.hpp"

#include <chrono>
#include <functional>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "tests/support/eventually.hpp"
#include "tests/support/network/network_relay.hpp"

namespace swiftlet::soak {
namespace {

using namespace std::chrono_literals;

constexpr auto kToolTimeout = 30s;
constexpr auto kStatusTimeout = 20s;

ShownDelay shown_delay(const NetworkFlight& flight) {
  const auto status = nlohmann::json::parse(
      flight.ground({"status", "--json", "--watch", "0.1"}, kToolTimeout).output, nullptr, false);
  ShownDelay shown;
  if (status.is_discarded() || !status.contains("loop_delay_s")) return shown;
  const auto& delay = status["loop_delay_s"];
  const auto number = [&](const char* key) {
    return delay[key].is_number() ? delay[key].get<double>() : -1.0;
  };
  shown.p50_s = number("p50");
  shown.p95_s = number("p95");
  shown.margin_s = number("margin");
  shown.near_margin = delay["near_margin"].get<bool>();
  return shown;
}

// Waits until it shows that.
ShownDelay wait_for(const NetworkFlight& flight, const std::function<bool(const ShownDelay&)>& condition) {
  ShownDelay shown;
  tests::eventually([&] { return condition(shown = shown_delay(flight)); }, kStatusTimeout, 100ms);
  return shown;
}

}  // namespace

DelayResult fly_with_delay(const DelaySettings& settings, const std::filesystem::path& folder) {
  DelayResult result;
  NetworkFlight flight(folder);
  const tests::NetworkRelay relay(
      flight.network(), NetworkFlight::kControl,
      {1e-3 * settings.delay_ms, 1e-3 * settings.jitter_ms, 1e-2 * settings.duplicated, settings.seed});
  flight.start(settings.seed);
  const std::string gains = (folder / "slow.yaml").string();
  const tests::ProgramResult tuned = flight.ground(
      {"tune", "delay", fmt::format("{:.4f}", settings.round_trip_s()), "--out", gains}, kToolTimeout);
  if (tuned.exit_code != 0) result.flight.fault += tuned.errors;
  result.before = wait_for(flight, [](const ShownDelay& shown) { return shown.p95_s >= 0.0; });
  const tests::ProgramResult set = flight.ground({"set", "control", gains, "--timeout", "10"}, kToolTimeout);
  if (set.exit_code != 0) result.flight.fault += set.errors;
  wait_for(flight, [&](const ShownDelay& shown) { return shown.margin_s >= 2.0 * settings.round_trip_s(); });
  const std::string earlier_fault = result.flight.fault;
  result.flight = flight.fly(settings.mission);
  result.flight.fault = earlier_fault + result.flight.fault;
  result.after = shown_delay(flight);
  result.overtaken = relay.overtaken();
  result.duplicated = relay.duplicated();
  return result;
}

}  // namespace swiftlet::soak
