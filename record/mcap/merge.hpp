// Writes what is selected of MCAP files into one.
#pragma once

#include <vector>

#include "swiftlet/record/mcap/reader.hpp"
#include "swiftlet/record/mcap/writer.hpp"

namespace swiftlet::mcap {

// The messages come in the order of their log times. Equal channels become one; metadata and attachments are all
// kept. Throws as Messages and Writer do. The file is not closed.
void merge(const std::vector<const Reader*>& files, const Selection& selection, Writer& out);

}  // namespace swiftlet::mcap
