#include "swiftlet/services/messages/vehicle_names.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <stdexcept>

#include "swiftlet/io/text.hpp"

namespace swiftlet::messages {
namespace {

constexpr std::size_t kMaxLength = 64;
const std::string kLetters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ";
constexpr std::size_t kMostDigits = 9;  // fit into an integer

// A name that ends with a number.
struct NumberedName {
  std::string letters;
  std::string digits;

  std::int64_t number() const { return std::stoll(digits); }
};

std::optional<NumberedName> numbered(const std::string& name) {
  const std::size_t digits = name.find_last_not_of("0123456789") + 1;
  if (digits == name.size() || name.size() - digits > kMostDigits) return std::nullopt;
  return NumberedName{name.substr(0, digits), name.substr(digits)};
}

std::string padded(std::int64_t number, std::size_t width) {
  const std::string digits = std::to_string(number);
  return std::string(width > digits.size() ? width - digits.size() : 0, '0') + digits;
}

// Appends the names of one part, a name or a range. Returns what is wrong with it; "" if nothing.
std::string append(const std::string& part, std::vector<std::string>& names) {
  const std::size_t dots = part.find("..");
  if (dots == std::string::npos) {
    names.push_back(part);
    return "";
  }
  const auto first = numbered(part.substr(0, dots));
  const auto last = numbered(part.substr(dots + 2));
  if (!first || !last || first->letters != last->letters)
    return "has the range " + part + ", which must be like kl5..kl7";
  if (last->number() < first->number())
    return "has the range " + part + ", whose second number is below its first";
  if (last->number() - first->number() >= static_cast<std::int64_t>(kMostListedVehicles))
    return "names more than " + std::to_string(kMostListedVehicles) + " vehicles";
  for (std::int64_t number = first->number(); number <= last->number(); ++number)
    names.push_back(first->letters + padded(number, first->digits.size()));
  return "";
}

std::string expand(const std::string& list, std::vector<std::string>& names) {
  for (const std::string& part : io::split_text(list, ',')) {
    if (std::string fault = append(part, names); !fault.empty()) return fault;
  }
  if (names.size() > kMostListedVehicles)
    return "names more than " + std::to_string(kMostListedVehicles) + " vehicles";
  for (auto name = names.begin(); name != names.end(); ++name) {
    if (const std::string fault = fault_of_vehicle_name(*name); !fault.empty())
      return (names.size() > 1 ? "each name " : "") + fault;
    if (std::find(names.begin(), name, *name) != name) return "names " + *name + " twice";
  }
  return "";
}

}  // namespace

std::string fault_of_vehicle_name(const std::string& name) {
  const bool plain = name.find_first_not_of(kLetters + "0123456789_") == std::string::npos;
  const bool begins = name.find_first_of(kLetters) == 0;
  if (plain && begins && name.size() <= kMaxLength && name.find("__") == std::string::npos) return "";
  return "must be 1 to 64 letters, digits and _, begin with a letter and have no __";
}

std::string fault_of_vehicle_list(const std::string& list) {
  std::vector<std::string> names;
  return expand(list, names);
}

std::vector<std::string> vehicles_of_list(const std::string& list) {
  std::vector<std::string> names;
  if (const std::string fault = expand(list, names); !fault.empty())
    throw std::invalid_argument("the list of vehicles '" + list + "' " + fault);
  return names;
}

}  // namespace swiftlet::messages
