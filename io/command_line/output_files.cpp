#include "swiftlet/io/command_line/output_files.hpp"

#include <system_error>

#include "swiftlet/io/command_line/command.hpp"

namespace swiftlet::io {
namespace {

namespace fs = std::filesystem;

fs::path canonical_path(const fs::path& path) {
  std::error_code fault;
  const fs::path out = fs::weakly_canonical(fs::absolute(path), fault);
  return fault ? path : out;
}

}  // namespace

void refuse_overwriting(const std::vector<OutputFile>& outputs, const std::vector<fs::path>& inputs) {
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    if (outputs[i].file.empty()) continue;
    const fs::path written = canonical_path(outputs[i].file);
    for (const fs::path& input : inputs) {
      if (canonical_path(input) == written)
        throw InputError(outputs[i].option + ": " + outputs[i].file +
                         " is also an input file, must be another file");
    }
    for (std::size_t k = 0; k < i; ++k) {
      if (!outputs[k].file.empty() && canonical_path(outputs[k].file) == written)
        throw InputError(outputs[i].option + " and " + outputs[k].option + ": both write " + outputs[i].file +
                         ", must be different files");
    }
  }
}

std::vector<fs::path> files_of(const fs::path& path) {
  if (!fs::is_directory(path)) return {path};
  std::vector<fs::path> out;
  for (const fs::directory_entry& entry : fs::directory_iterator(path)) out.push_back(entry.path());
  return out;
}

}  // namespace swiftlet::io
