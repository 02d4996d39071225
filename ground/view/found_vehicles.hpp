// What a server has to add for each vehicle that it finds, such as its topics: what fails is tried again, apart from the rest.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace swiftlet::ground {

// Not thread-safe.
class FoundVehicles {
 public:
  using Add = std::function<void(const std::string& vehicle)>;  // may throw

  // parts: in the order in which they are added. say: receives a sentence about each failure, once.
  FoundVehicles(std::vector<Add> parts, std::function<void(const std::string&)> say)
      : parts_(std::move(parts)), say_(std::move(say)) {}

  // Call it each time the vehicle is seen. Returns false if it had all its parts before.
  bool add(const std::string& vehicle);

 private:
  const std::vector<Add> parts_;
  const std::function<void(const std::string&)> say_;
  std::map<std::string, std::set<std::size_t>> added_;  // parts, by vehicle
  std::set<std::string> said_;
};

}  // namespace swiftlet::ground
