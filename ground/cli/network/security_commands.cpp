// `swiftlet keys create`, `renew` and `revoke`: the keys, certificates and permissions of DDS Security.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "swiftlet/ground/cli/network/keys_commands.hpp"
#include "swiftlet/io/security/security_folder.hpp"
#include "swiftlet/services/messages/security_policy.hpp"
#include "swiftlet/services/messages/topic_roles.hpp"
#include "swiftlet/services/messages/vehicle_names.hpp"

namespace swiftlet::ground {
namespace {

constexpr int kMostDays = 3650;

struct SecurityOptions {
  std::string folder;
  std::string vehicles;
  std::string role;
  int days = 365;
};

std::vector<std::string> all_roles() { return {std::begin(messages::kRoles), std::end(messages::kRoles)}; }

// Runs what throws std::runtime_error for bad input.
template <class Function>
void on_input(const Function& function) {
  try {
    function();
  } catch (const std::runtime_error& error) {
    throw io::InputError(error.what());
  }
}

int create(const SecurityOptions& options) {
  const io::SecurityFolder folder{options.folder};
  const std::vector<std::string> roles = all_roles();
  const std::vector<std::string> vehicles = messages::vehicles_of_list(options.vehicles);
  const auto permissions = [&](const std::string& role) {
    return messages::permissions_document(role, io::subject_of(role), vehicles);
  };
  on_input([&] {
    io::make_security_folder(folder, roles, {messages::governance_document(), permissions}, options.days);
  });
  std::printf(
      "made %s; copy ca.pem, revoked.pem, governance.p7s and the folder of its role to each host, never "
      "ca.key:\n"
      "  vehicle    swiftlet-plant, or the real vehicle\n"
      "  mocap      swiftlet-mocap\n"
      "  control    swiftlet-control\n"
      "  ground     tools that command\n"
      "  observer   tools that only read\n"
      "then start every process with --security %s\n",
      options.folder.c_str(), options.folder.c_str());
  return io::kDone;
}

int renew(const SecurityOptions& options) {
  const io::SecurityFolder folder{options.folder};
  std::string end;
  on_input([&] { end = io::renew_identity(folder, options.role, options.days); });
  std::printf("renewed %s, valid until %s; copy it to its host, and restart the processes there\n",
              (folder.path / options.role).c_str(), end.c_str());
  return io::kDone;
}

int revoke(const SecurityOptions& options) {
  const io::SecurityFolder folder{options.folder};
  on_input([&] { io::revoke_role(folder, options.role); });
  std::printf(
      "revoked every certificate of %s; copy %s to each host, and restart the processes there; "
      "`swiftlet keys renew` makes the next one\n",
      (folder.path / options.role).c_str(), folder.revoked().c_str());
  return io::kDone;
}

void add_folder(runtime::CommandLine app, SecurityOptions& options) {
  app.add_option("folder", options.folder, "the folder of the keys").required().type_name("DIR");
}

void add_role(runtime::CommandLine app, SecurityOptions& options) {
  app.add_option("role", options.role, "whose certificate").required().one_of(all_roles());
}

void add_days(runtime::CommandLine app, SecurityOptions& options) {
  app.add_option(
         "--days", options.days,
         "time after which the certificate expires, days; at the latest with its authority, ten years "
         "after `swiftlet keys create`")
      .range(1, kMostDays)
      .show_default();
}

}  // namespace

io::Command add_keys_create_command(runtime::CommandLine keys) {
  const auto options = std::make_shared<SecurityOptions>();
  const runtime::CommandLine app = keys.add_subcommand(
      "create", "Make an authority, and for each role a key, a certificate and signed permissions");
  add_folder(app, *options);
  app.add_option("--vehicle", options->vehicles, "the vehicles of the network, such as kl1 or kl1..kl16")
      .required()
      .check(messages::fault_of_vehicle_list, "NAME[,NAME...]");
  add_days(app, *options);
  app.footer("example: swiftlet keys create lab --vehicle kl1 && swiftlet fly --security lab");
  return {app, [options] { return create(*options); }};
}

io::Command add_keys_renew_command(runtime::CommandLine keys) {
  const auto options = std::make_shared<SecurityOptions>();
  const runtime::CommandLine app =
      keys.add_subcommand("renew", "Make a new key and certificate of a role; the old one stays valid");
  add_folder(app, *options);
  add_role(app, *options);
  add_days(app, *options);
  app.footer("example: swiftlet keys renew lab ground");
  return {app, [options] { return renew(*options); }};
}

io::Command add_keys_revoke_command(runtime::CommandLine keys) {
  const auto options = std::make_shared<SecurityOptions>();
  const runtime::CommandLine app =
      keys.add_subcommand("revoke", "Declare all certificates of a role invalid");
  add_folder(app, *options);
  add_role(app, *options);
  app.footer("example: swiftlet keys revoke lab ground && swiftlet keys renew lab ground");
  return {app, [options] { return revoke(*options); }};
}

}  // namespace swiftlet::ground
