// The programs that a benchmark runs, and what they print.
#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

namespace swiftlet {

// Path of a program that was built beside this one, or in bin. Throws std::runtime_error if there is none.
std::filesystem::path program(const std::string& name);

// Standard output of a command, whatever its exit code. Throws std::runtime_error if it cannot be run.
std::string output_of(const std::string& command);

// Medians of a Google Benchmark program by name: CPU time and counters. Throws std::runtime_error for a benchmark that failed.
nlohmann::json benchmarks(const std::string& name, const std::string& filter);
double cpu_ns(const nlohmann::json& entry);

}  // namespace swiftlet
