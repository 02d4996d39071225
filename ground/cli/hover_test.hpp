// The hover test of a connected vehicle, and the memory of those that have passed it.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "swiftlet/ground/client/client.hpp"
#include "swiftlet/services/dds/node.hpp"

namespace swiftlet::ground {

// Arms the vehicle and lets it fly the hover test. Returns what is wrong with it, a sentence; empty if it passes, and then
// remembers that. Lands the vehicle once `interrupted` returns true.
std::string fly_hover_test(const dds::NodeSettings& network, const std::function<bool()>& interrupted);

// Flies the hover test of each vehicle that has not passed it yet, one after the other. Simulated ones need none. Throws
// std::runtime_error with a sentence if one does not pass.
void require_hover_tests(const dds::NodeSettings& network, const std::vector<std::string>& vehicles);

// What a hover test is about: the vehicle as it reports itself, the level, and the files that control flies with.
// One that differs needs another test.
std::string tested_configuration(const View& view);
// $XDG_STATE_HOME/swiftlet/hover_tests/NAME, or in ~/.local/state: the configuration of the last test that NAME has passed.
std::filesystem::path hover_test_memory(const std::string& vehicle);

}  // namespace swiftlet::ground
