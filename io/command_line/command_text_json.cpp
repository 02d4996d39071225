#include <stdexcept>

#include <nlohmann/json.hpp>

#include "swiftlet/io/command_line/command_text.hpp"
#include "swiftlet/io/json_text.hpp"

namespace swiftlet::io {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(OptionText, names, positional, required, value, choices, description,
                                   facts)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(CommandText, words, description, footer, options, commands)

std::string json_of(const CommandText& command) { return io::json_text(nlohmann::json(command)); }

CommandText command_text_of_json(const std::string& text) {
  try {
    return nlohmann::json::parse(text).get<CommandText>();
  } catch (const nlohmann::json::exception& error) {
    throw std::runtime_error(std::string("commands of a program: ") + error.what());
  }
}

}  // namespace swiftlet::io
