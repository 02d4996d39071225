#include "swiftlet/ground/command_line/output_files.hpp"

#include <system_error>

#include "swiftlet/ground/command_line/command.hpp"

namespace swiftlet::ground {
namespace {

namespace fs = std::filesystem;

fs::path whole(const fs::path& path) {
  std::error_code fault;
  const fs::path out = fs::weakly_canonical(fs::absolute(path), fault);
  return fault ? path : out;
}

}  // namespace

void refuse_overwriting(const std::vector<OutputFile>& outputs, const std::vector<fs::path>& inputs) {
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    if (outputs[i].file.empty()) continue;
    const fs::path written = whole(outputs[i].file);
    for (const fs::path& input : inputs) {
      if (whole(input) == written)
        throw InputError(outputs[i].option + ": " + outputs[i].file +
                         " is one of the files that are read, must be another");
    }
    for (std::size_t k = 0; k < i; ++k) {
      if (!outputs[k].file.empty() && whole(outputs[k].file) == written)
        throw InputError(outputs[i].option + " and " + outputs[k].option + ": are both " + outputs[i].file +
                         ", must be two files");
    }
  }
}

std::vector<fs::path> files_of(const fs::path& path) {
  if (!fs::is_directory(path)) return {path};
  std::vector<fs::path> out;
  for (const fs::directory_entry& entry : fs::directory_iterator(path)) out.push_back(entry.path());
  return out;
}

}  // namespace swiftlet::ground
