#include "tests/bench/built_programs.hpp"

#include <array>
#include <cstdio>
#include <memory>
#include <stdexcept>

namespace swiftlet {

namespace fs = std::filesystem;
using nlohmann::json;

fs::path program(const std::string& name) {
  const fs::path here = fs::read_symlink("/proc/self/exe").parent_path();
  for (const fs::path& path : {here / name, here.parent_path() / "bin" / name}) {
    if (fs::exists(path)) return path;
  }
  throw std::runtime_error(name + " is not built");
}

std::string output_of(const std::string& command) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> pipe(::popen((command + " 2>/dev/null").c_str(), "r"),
                                                             ::pclose);
  if (!pipe) throw std::runtime_error("cannot run " + command);
  std::string text;
  std::array<char, 4096> buffer;
  while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), pipe.get()))
    text.append(buffer.data(), count);
  return text;
}

json benchmarks(const std::string& name, const std::string& filter) {
  const json report =
      json::parse(output_of(program(name).string() + " --benchmark_format=json --benchmark_repetitions=5" +
                            " --benchmark_report_aggregates_only=true --benchmark_filter='" + filter + "'"));
  json medians;
  for (const json& entry : report.at("benchmarks")) {
    if (entry.value("error_occurred", false))
      throw std::runtime_error(entry.at("name").get<std::string>() + ": " +
                               entry.at("error_message").get<std::string>());
    if (entry.at("aggregate_name") == "median") medians[entry.at("run_name").get<std::string>()] = entry;
  }
  return medians;
}

double cpu_ns(const json& entry) {
  const std::string unit = entry.at("time_unit");
  return entry.at("cpu_time").get<double>() * (unit == "us" ? 1e3 : unit == "ms" ? 1e6 : 1.0);
}

}  // namespace swiftlet
