// The command-line options that say where poses come from.
#pragma once

#include <string>
#include <vector>

#include "swiftlet/io/mocap/room.hpp"
#include "swiftlet/services/runtime/command_line.hpp"

namespace swiftlet::mocap {

struct SourceOptions {
  std::string source;  // "natnet"; empty: that of the room
  std::string room;    // name or file
  std::string server;
  std::string interface;
  std::string frame;  // "zup", "yup"
  std::string file;
};

// --source (with `first` before those that this folder has), --room, --server, --interface, --frame, --file.
void add_source_options(runtime::CommandLine app, SourceOptions& options,
                        std::vector<std::string> first = {});

// The room of the options, which replace what its file says. Without a file each vehicle is the body of its name. Throws
// ConfigError, or std::invalid_argument if something is missing.
Room room_of(const SourceOptions& options, const std::vector<std::string>& vehicles);

}  // namespace swiftlet::mocap
