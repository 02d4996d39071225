// A vehicle in a domain of its own whose messages are recorded.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "swiftlet/record/mcap/reader.hpp"
#include "swiftlet/services/dds/discovery/domain_lock.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::tests {

class Log : public testing::Test {
 protected:
  std::vector<std::string> on_this_domain(std::vector<std::string> arguments) const {
    arguments.insert(arguments.end(), {"--domain", std::to_string(lock_.domain()), "--localhost-only"});
    return arguments;
  }
  std::unique_ptr<Program> start(const std::string& program, std::vector<std::string> arguments = {}) const {
    return std::make_unique<Program>(program, on_this_domain(std::move(arguments)), folder_.path());
  }
  std::string path(const std::string& name) const { return folder_.path() / name; }
  // The vehicle alone, four times as fast as real time: 2000 IMU samples a second.
  void start_vehicle() { vehicle_ = start("swiftlet-plant", {"--speed", "4"}); }
  bool grows_to(const std::string& file, std::uintmax_t bytes) const {
    return eventually(
        [&] { return std::filesystem::exists(file) && std::filesystem::file_size(file) >= bytes; });
  }

  dds::DomainLock lock_;
  TemporaryFolder folder_;
  std::unique_ptr<Program> vehicle_;
};

// The messages of each topic, without their payloads.
inline std::map<std::string, std::vector<mcap::Message>> heads_of(const mcap::Reader& file) {
  std::map<std::string, std::vector<mcap::Message>> heads;
  mcap::Messages messages(file, {});
  while (messages.next()) {
    heads[messages.channel().topic].push_back(messages.message());
    heads[messages.channel().topic].back().payload = {};
  }
  return heads;
}

}  // namespace swiftlet::tests
