// JSON as text, in which bytes that are no UTF-8 become U+FFFD: names of files and sentences of a vehicle may have them, and
// nlohmann's own dump() then throws.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

namespace swiftlet::io {

// indent < 0: on one line.
template <class Json = nlohmann::ordered_json>
std::string json_text(const Json& json, int indent = -1) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace swiftlet::io
