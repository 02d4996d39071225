#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <string>

#include "swiftlet/analysis/identify/bench_files.hpp"
#include "swiftlet/analysis/identify/identify_actions.hpp"
#include "swiftlet/identification/bench/bench_simulation.hpp"
#include "swiftlet/io/atomic_write.hpp"
#include "swiftlet/io/configuration.hpp"
#include "swiftlet/io/csv.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"
#include "swiftlet/io/text_file.hpp"

namespace swiftlet::analysis {
namespace {

namespace fs = std::filesystem;

constexpr const char* kTruth = "truth.yaml";

}  // namespace

int identify_simulate(const IdentifySimulateOptions& options) {
  const fs::path vehicle_file = io::configuration_file(io::kinds::kVehicle, options.vehicle);
  const std::string vehicle_text = io::read_text_file(vehicle_file.string());
  const plant::Vehicle vehicle = io::parse_vehicle(vehicle_text, vehicle_file.string());
  const fs::path folder = options.out;
  if (fs::exists(folder) && !fs::is_directory(folder))
    throw io::InputError("--out: " + options.out + " is not a folder, must be a folder or not exist");
  if (fs::exists(folder) && !fs::is_empty(folder) && !fs::exists(folder / kTruth))
    throw io::InputError("--out: " + options.out +
                         " contains files that this command did not write, must be empty or not exist");
  write_bench(folder, identification::simulate_bench(vehicle, options.noise, options.seed),
              "# Simulated: " + vehicle.name + ", noise " + io::exact(options.noise.share) + ", outliers " +
                  io::exact(options.noise.outliers) + ", seed " + std::to_string(options.seed) +
                  ".\nbase_vehicle: " + kTruth + "\n");
  io::write_atomically(folder / kTruth, vehicle_text);
  std::fprintf(stderr, "swiftlet: wrote a bench of %s to %s\n", vehicle.name.c_str(), options.out.c_str());
  return io::kDone;
}

}  // namespace swiftlet::analysis
