#include "swiftlet/services/dds/vehicle_name.hpp"

namespace swiftlet::comms {
namespace {

constexpr std::size_t kMaxLength = 64;
const std::string kLetters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ";

}  // namespace

std::string fault_of_vehicle_name(const std::string& name) {
  const bool plain = name.find_first_not_of(kLetters + "0123456789_") == std::string::npos;
  const bool begins = name.find_first_of(kLetters) == 0;
  if (plain && begins && name.size() <= kMaxLength && name.find("__") == std::string::npos) return "";
  return "must be 1 to 64 letters, digits and _, begin with a letter and have no __";
}

}  // namespace swiftlet::comms
