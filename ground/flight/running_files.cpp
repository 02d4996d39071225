#include "swiftlet/ground/flight/running_files.hpp"

#include <stdexcept>

#include <fmt/core.h>

#include "swiftlet/io/atomic_write.hpp"

namespace swiftlet::ground {

RunningFiles::RunningFiles(Client& client, std::chrono::milliseconds timeout)
    : folder_(io::TemporaryFolder::of_the_system("swiftlet-running")) {
  client.hear_files();
  client.wait(timeout,
              [](const View& view) { return view.files != nullptr || !view.foreign_control.empty(); });
  const std::shared_ptr<const msg::FlownFiles> files = client.view().files;
  if (files == nullptr && !client.view().control.seen()) throw std::runtime_error(client.no_control());
  if (files == nullptr)
    throw std::runtime_error(
        fmt::format("the control service of {} does not tell which vehicle and control files it flies with",
                    client.vehicle()));
  const auto write = [&](const std::string& path, const msg::SettingsFile& file, const char* what) {
    if (file.text().size() == 0)
      throw std::runtime_error(
          fmt::format("the {} file of {} is too long to be told: give --{}", what, client.vehicle(), what));
    io::write_atomically(path, file.text().c_str());
  };
  write(vehicle(), files->vehicle(), "vehicle");
  write(control(), files->control(), "control");
}

}  // namespace swiftlet::ground
