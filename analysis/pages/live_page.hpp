// The page of running vehicles, in one file. It connects to the server that it comes from, by the Foxglove WebSocket
// protocol, and shows all vehicles that the server knows.
#pragma once

#include <string>

namespace swiftlet::pages {

std::string live_page();

}  // namespace swiftlet::pages
