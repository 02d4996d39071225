#include "swiftlet/ground/view/found_vehicles.hpp"

#include <exception>

namespace swiftlet::ground {

bool FoundVehicles::add(const std::string& vehicle) {
  std::set<std::size_t>& added = added_[vehicle];
  if (added.size() == parts_.size()) return false;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    if (added.count(i) > 0) continue;
    try {
      parts_[i](vehicle);
      added.insert(i);
    } catch (const std::exception& error) {
      const std::string sentence = "vehicle " + vehicle + ": " + error.what();
      if (said_.insert(sentence).second) say_(sentence);
    }
  }
  return true;
}

}  // namespace swiftlet::ground
