// Keys that the processes of a network share, and their file.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace swiftlet::io {

using NetworkKey = std::array<std::uint8_t, 32>;

// Senders use the first key; receivers accept all of them. One, or two while a key is being exchanged.
using NetworkKeys = std::vector<NetworkKey>;
constexpr std::size_t kMostNetworkKeys = 2;

// A key from the random numbers of the system. Throws std::runtime_error.
NetworkKey random_network_key();

// Throws std::runtime_error with a sentence if the file cannot be read, holds anything but one or two keys, or gives others
// than its owner any right.
NetworkKeys read_network_keys(const std::filesystem::path& file);

// Writes the file as a whole, for its owner only. Throws std::runtime_error.
void write_network_keys(const std::filesystem::path& file, const NetworkKeys& keys);

}  // namespace swiftlet::io
