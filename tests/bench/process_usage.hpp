// CPU time, memory, threads and context switches of a process.
#pragma once

#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <sys/types.h>
#include <unistd.h>
#include <vector>

namespace swiftlet {

struct Usage {
  double cpu_s = 0.0;       // user and system time of all threads
  double memory_mib = 0.0;  // resident
  int threads = 0;
  double switches = 0.0;  // of all threads that exist now
};

// Throws std::runtime_error if the process has ended.
inline Usage usage_of(pid_t pid) {
  std::ifstream stat("/proc/" + std::to_string(pid) + "/stat");
  std::string text;
  std::getline(stat, text);
  const std::size_t name_end = text.rfind(')');
  std::vector<std::string> field;
  if (name_end != std::string::npos) {
    std::istringstream fields(text.substr(name_end + 1));
    for (std::string word; fields >> word;) field.push_back(word);
  }
  if (field.size() < 22) throw std::runtime_error("process " + std::to_string(pid) + " has ended");
  int threads = 0;
  double switches = 0.0;
  for (const auto& task : std::filesystem::directory_iterator("/proc/" + std::to_string(pid) + "/task")) {
    ++threads;
    std::ifstream status(task.path() / "status");
    for (std::string line; std::getline(status, line);) {
      if (line.find("ctxt_switches:") != std::string::npos)
        switches += std::stod(line.substr(line.find(':') + 1));
    }
  }
  const auto ticks = static_cast<double>(::sysconf(_SC_CLK_TCK));
  return {(std::stod(field[11]) + std::stod(field[12])) / ticks,
          std::stod(field[21]) * static_cast<double>(::sysconf(_SC_PAGESIZE)) / (1 << 20), threads, switches};
}

}  // namespace swiftlet
