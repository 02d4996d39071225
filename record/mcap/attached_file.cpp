#include "swiftlet/record/mcap/attached_file.hpp"

namespace swiftlet::mcap {

std::optional<std::string> attached_file(const Reader& file, const std::string& vehicle,
                                         const std::string& name) {
  for (const std::string& full_name : {vehicle + "/" + name, name}) {
    for (const AttachmentIndex& index : file.attachments()) {
      if (index.name == full_name) return file.attachment(index).data;
    }
  }
  return std::nullopt;
}

}  // namespace swiftlet::mcap
