#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>

#include <CLI/CLI.hpp>

#include "ground/bench_files.hpp"
#include "ground/commands.hpp"
#include "ground/installation.hpp"
#include "ground/numbers.hpp"
#include "identification/bench_simulation.hpp"
#include "services/runtime/csv.hpp"
#include "services/runtime/text_file.hpp"
#include "services/runtime/vehicle_file.hpp"

namespace swiftlet::ground {
namespace {

namespace fs = std::filesystem;

constexpr const char* kTruth = "truth.yaml";

struct SimulateOptions {
  std::string vehicle = "kaylion";
  std::string out;
  identification::BenchNoise noise;
  std::uint64_t seed = 1;
};

int run_simulate(const SimulateOptions& options) {
  const fs::path vehicle_file = configuration_file("vehicles", options.vehicle);
  const std::string vehicle_text = runtime::read_text_file(vehicle_file.string());
  const plant::Vehicle vehicle = runtime::parse_vehicle(vehicle_text, vehicle_file.string());
  const fs::path folder = options.out;
  if (fs::exists(folder) && !fs::is_directory(folder))
    throw InputError("--out: " + options.out + " is no folder, must be one or not be there");
  if (fs::exists(folder) && !fs::is_empty(folder) && !fs::exists(folder / kTruth))
    throw InputError("--out: " + options.out +
                     " holds files that this command has not made, must be empty or not be there");
  write_bench(folder, identification::simulate_bench(vehicle, options.noise, options.seed),
              "# Simulated: " + vehicle.name + ", noise " + runtime::exact(options.noise.share) +
                  ", outliers " + runtime::exact(options.noise.outliers) + ", seed " +
                  std::to_string(options.seed) + ".\nbase_vehicle: " + kTruth + "\n");
  std::ofstream truth(folder / kTruth);
  truth << vehicle_text;
  if (!truth.flush()) throw std::runtime_error((folder / kTruth).string() + " cannot be written");
  std::fprintf(stderr, "swiftlet: wrote a bench of %s to %s\n", vehicle.name.c_str(), options.out.c_str());
  return kDone;
}

}  // namespace

Command add_identify_simulate_command(CLI::App& identify) {
  const auto options = std::make_shared<SimulateOptions>();
  CLI::App* const app = identify.add_subcommand(
      "simulate", "Make bench data of a vehicle that is known, to try the identification on");
  app->add_option("--vehicle", options->vehicle, "vehicle file, or the name of one in the configuration")
      ->capture_default_str();
  app->add_option("--noise", options->noise.share,
                  "standard deviation of every reading, as a share of the largest of its column")
      ->check(finite_number())
      ->check(CLI::Range(0.0, 0.5))
      ->capture_default_str();
  app->add_option("--outliers", options->noise.outliers,
                  "share of the rows in which a reading is badly wrong")
      ->check(finite_number())
      ->check(CLI::Range(0.0, 0.4))
      ->capture_default_str();
  app->add_option("--seed", options->seed, "of the noise")->capture_default_str();
  app->add_option("--out", options->out, "folder for the bench data")->required()->type_name("DIR");
  app->footer(
      "example: swiftlet identify simulate --vehicle kaylion --noise 0.01 --outliers 0.02 --out bench");
  return {app, [options] { return run_simulate(*options); }};
}

}  // namespace swiftlet::ground
