// Kills the active controller repeatedly in flight and prints the metrics of each takeover. Several flights at once share the
// computer, each with its own vehicle and domain.
#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <exception>
#include <functional>
#include <mutex>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "swiftlet/services/runtime/process.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/redundant_flight.hpp"
#include "tests/support/security_keys.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::tests {
namespace {

constexpr double kLongestGap_ms = 60.0;
constexpr double kExtraDeviation_m = 0.05;
constexpr std::int64_t kWindowNs = 2'000'000'000;  // after a kill

struct Options {
  int kills = 50;
  int flights = 1;
  std::uint64_t seed = 1;
  std::string plant_simulation;  // empty: the default world
  bool security = false;
};

// Each part has half of the kills.
struct Part {
  const char* name;
  double speed;          // m/s, of the mission
  double kill_at_speed;  // m/s, minimum
};
constexpr Part kParts[] = {{"square at 0.5 m/s", 0.5, 0.1}, {"square at 1.5 m/s", 1.5, 1.45}};

struct Takeover {
  double gap_ms = 0.0;
  double deviation_m = 0.0;
  double extra_m = 0.0;
  double step_m = 0.0;  // of the reference
  double speed = 0.0;
  std::string log;  // the standby's sentence

  bool in_bounds() const { return gap_ms <= kLongestGap_ms && extra_m <= kExtraDeviation_m; }
};

void print_header() {
  std::printf("%6s %4s  %-18s %6s %7s %13s %9s %18s\n", "flight", "kill", "", "m/s", "gap ms", "deviation cm",
              "extra cm", "reference step mm");
}

void print(int flight, int number, const char* part, const Takeover& t) {
  static std::mutex mutex;
  const std::lock_guard<std::mutex> lock(mutex);
  std::printf("%6d %4d  %-18s %6.2f %7.1f %13.2f %9.2f %18.2f%s%s\n", flight, number, part, t.speed, t.gap_ms,
              t.deviation_m * 1e2, t.extra_m * 1e2, t.step_m * 1e3,
              t.in_bounds() ? "" : "  BEYOND: ", t.in_bounds() ? "" : t.log.c_str());
  std::fflush(stdout);
}

// How the controller that flies now took over; empty if it did not.
std::string last_takeover(RedundantFlight& flight) {
  const std::string log = flight.active().process->errors();
  const std::size_t begin = log.rfind("takes over");
  return begin == std::string::npos ? "" : log.substr(begin, log.find('\n', begin) - begin);
}

Takeover kill_active(RedundantFlight& flight, const Part& part) {
  flight.wait("the vehicle flies at speed", [&] { return flight.speed() > part.kill_at_speed; });
  Takeover takeover;
  takeover.speed = flight.speed();
  const std::int64_t at_ns = flight.stamp_ns();
  flight.kill(flight.active());
  const FlightMetrics metrics = flight.metrics(at_ns, at_ns + kWindowNs, side_ns(part.speed));
  takeover.gap_ms = metrics.longest_gap_ms;
  takeover.deviation_m = metrics.largest_deviation_m;
  takeover.extra_m = metrics.extra_deviation_m;
  takeover.step_m = metrics.largest_step_m;
  takeover.log = last_takeover(flight);
  return takeover;
}

// number: of the flight. all_fly: is called once when the vehicle has taken off, and waits until all flights have.
std::vector<Takeover> fly(int number, const Part& part, int kills, int first, std::mt19937_64& random,
                          const Options& options, const std::function<void()>& all_fly) {
  const TemporaryFolder folder;
  std::vector<std::string> plant;
  if (!options.plant_simulation.empty()) plant = {"--simulation", options.plant_simulation};
  dds::NodeSettings network;
  if (options.security) network.security = make_security_keys(folder.path() / "keys", network.vehicle);
  RedundantFlight flight(folder.path(), plant, network);
  std::uniform_int_distribution<int> failover_priority(0, 1000);
  std::uniform_real_distribution<double> pause_s(0.0, 3.0);
  flight.start_controller(failover_priority(random));
  flight.start_controller(failover_priority(random));
  flight.wait_for_roles(1, 1);
  flight.fly(square_laps(part.speed, 400));
  flight.wait("the vehicle has taken off", [&] { return flight.z_ned() < -0.98; });
  all_fly();
  const std::int64_t first_side_ns = flight.stamp_ns() + side_ns(part.speed) + 2'000'000'000;
  flight.wait("the vehicle has flown a side", [&] { return flight.stamp_ns() > first_side_ns; });

  std::vector<Takeover> takeovers;
  for (int kill = 0; kill < kills; ++kill) {
    const std::int64_t until_ns = flight.stamp_ns() + static_cast<std::int64_t>(pause_s(random) * 1e9);
    flight.wait("the vehicle's time passes", [&] { return flight.stamp_ns() > until_ns; });
    takeovers.push_back(kill_active(flight, part));
    print(number, first + kill, part.name, takeovers.back());
    flight.start_controller(failover_priority(random));
    flight.wait_for_roles(1, 1);
  }
  return takeovers;
}

// The flights of a part at once. Throws what the first of them that failed threw.
std::vector<Takeover> fly_at_once(const Part& part, int kills, int first,
                                  std::vector<std::mt19937_64>& randoms, const Options& options) {
  std::atomic<int> under_way{options.flights};  // that have not taken off or failed yet
  std::vector<std::vector<Takeover>> takeovers(randoms.size());
  std::vector<std::exception_ptr> failures(randoms.size());
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < randoms.size(); ++i) {
    threads.emplace_back([&, i] {
      bool flies = false;
      const auto all_fly = [&] {
        flies = true;
        --under_way;
        eventually([&] { return under_way == 0; });
      };
      try {
        takeovers[i] = fly(static_cast<int>(i) + 1, part, kills, first, randoms[i], options, all_fly);
      } catch (const std::exception&) {
        failures[i] = std::current_exception();
        if (!flies) --under_way;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  std::vector<Takeover> all;
  for (std::size_t i = 0; i < randoms.size(); ++i) {
    if (failures[i]) std::rethrow_exception(failures[i]);
    all.insert(all.end(), takeovers[i].begin(), takeovers[i].end());
  }
  return all;
}

int run(const Options& options) {
  std::vector<std::mt19937_64> randoms;
  for (int flight = 0; flight < options.flights; ++flight)
    randoms.emplace_back(options.seed + static_cast<std::uint64_t>(flight));
  std::vector<Takeover> all;
  int first = 1;
  print_header();
  for (const Part& part : kParts) {
    const int kills = &part == &kParts[0] ? options.kills / 2 : options.kills - options.kills / 2;
    const std::vector<Takeover> some = fly_at_once(part, kills, first, randoms, options);
    all.insert(all.end(), some.begin(), some.end());
    first += kills;
  }
  Takeover worst;
  for (const Takeover& t : all) {
    worst.gap_ms = std::max(worst.gap_ms, t.gap_ms);
    worst.step_m = std::max(worst.step_m, t.step_m);
    worst.extra_m = std::max(worst.extra_m, t.extra_m);
  }
  const auto good = std::count_if(all.begin(), all.end(), [](const Takeover& t) { return t.in_bounds(); });
  std::printf(
      "%td of %zu kills within %.0f ms without a fresh command and %.0f cm of extra deviation; worst %.1f "
      "ms, %.2f cm, "
      "a step of the reference by %.2f mm\n",
      good, all.size(), kLongestGap_ms, kExtraDeviation_m * 1e2, worst.gap_ms, worst.extra_m * 1e2,
      worst.step_m * 1e3);
  return static_cast<std::size_t>(good) == all.size() ? 0 : 1;
}

}  // namespace
}  // namespace swiftlet::tests

int main(int argc, char** argv) {
  using namespace swiftlet;
  tests::Options options;
  int exit_code = 0;
  const int status = runtime::run_process(
      {"standby_soak", "Kills the active controller repeatedly in flight.", "--kills 10 --seed 3"}, argc,
      argv,
      [&](runtime::CommandLine app) {
        app.add_option("--kills", options.kills, "number of kills").range(1, 10000).show_default();
        app.add_option("--flights", options.flights, "number of flights at once, each with so many kills")
            .range(1, 20)
            .show_default();
        app.add_option("--seed", options.seed, "seed of priorities and pauses").show_default();
        app.add_option("--simulation", options.plant_simulation, "the plant's simulation file");
        app.add_flag("--security", options.security, "with DDS Security");
      },
      [&] { exit_code = tests::run(options); });
  return status != 0 ? status : exit_code;
}
