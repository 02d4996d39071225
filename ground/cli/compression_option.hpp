// The option of commands that write MCAP files.
#pragma once

#include "swiftlet/record/mcap/compression.hpp"
#include "swiftlet/services/runtime/command_line.hpp"

namespace swiftlet::ground {

inline void add_compression_option(runtime::CommandLine app, mcap::Compression& compression) {
  app.add_choice("--compression", compression,
                 {{"zstd", mcap::Compression::kZstd},
                  {"lz4", mcap::Compression::kLz4},
                  {"none", mcap::Compression::kNone}},
                 "compression of the file")
      .show_default("zstd");
}

}  // namespace swiftlet::ground
