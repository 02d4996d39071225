// `swiftlet keys network`: makes the key that all processes of a network share, and exchanges it in steps.
#include <cstdio>
#include <filesystem>
#include <string>
#include <system_error>
#include <utility>

#include "swiftlet/ground/cli/network/keys_commands.hpp"
#include "swiftlet/io/network_key.hpp"

namespace swiftlet::ground {
namespace {

enum class ExchangeStep { kNone, kAdd, kSwitch, kDrop };

struct NetworkKeyOptions {
  std::string file;
  ExchangeStep step = ExchangeStep::kNone;
};

int make(const std::string& file) {
  std::error_code fault;
  if (std::filesystem::exists(file, fault))
    throw io::InputError(file + " exists; --exchange add begins to exchange its key");
  if (fault) throw io::InputError(file + ": cannot be read: " + fault.message());
  io::write_network_keys(file, {io::random_network_key()});
  std::printf("made %s; copy it to each host, and start every process with --network-key %s\n", file.c_str(),
              file.c_str());
  return io::kDone;
}

int exchange_key(const std::string& file, ExchangeStep step) {
  io::NetworkKeys keys = io::read_network_keys(file);
  const bool in_exchange = keys.size() == io::kMostNetworkKeys;
  if (step == ExchangeStep::kAdd && in_exchange)
    throw io::InputError(
        file +
        " has two keys already; --exchange switch sends with the other one, --exchange drop removes it");
  if (step != ExchangeStep::kAdd && !in_exchange)
    throw io::InputError(file + " has one key; --exchange add adds the next one");
  const char* next = "";
  if (step == ExchangeStep::kAdd) {
    keys.push_back(io::random_network_key());
    next = "accepts a second key too";
  } else if (step == ExchangeStep::kSwitch) {
    std::swap(keys.front(), keys.back());
    next = "sends with the other key";
  } else {
    keys.pop_back();
    next = "accepts one key only";
  }
  io::write_network_keys(file, keys);
  std::printf(
      "%s: a process that starts with it %s; copy it to each host, and restart the processes, one after the "
      "other\n",
      file.c_str(), next);
  return io::kDone;
}

}  // namespace

io::Command add_keys_network_command(runtime::CommandLine keys) {
  const auto options = std::make_shared<NetworkKeyOptions>();
  const runtime::CommandLine app =
      keys.add_subcommand("network", "Make the key that all processes of a network share, or exchange it");
  app.add_option("file", options->file, "the key file").required().type_name("FILE");
  app.add_choice(
      "--exchange", options->step,
      {{"add", ExchangeStep::kAdd}, {"switch", ExchangeStep::kSwitch}, {"drop", ExchangeStep::kDrop}},
      "a step of exchanging the key while vehicles fly: add the next key, which is accepted from then on; "
      "switch to sending with it; drop the old one. Each step reaches all hosts before the next");
  app.footer("example: swiftlet keys network lab.key && swiftlet fly --network-key lab.key");
  return {app, [options] {
            return options->step == ExchangeStep::kNone ? make(options->file)
                                                        : exchange_key(options->file, options->step);
          }};
}

}  // namespace swiftlet::ground
