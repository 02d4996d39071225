// The files that the controller of a running vehicle flies with.
#pragma once

#include <chrono>
#include <string>

#include "swiftlet/ground/client/client.hpp"
#include "swiftlet/io/temporary_folder.hpp"

namespace swiftlet::ground {

// As files of this host, for as long as this object lives.
class RunningFiles {
 public:
  // Throws std::runtime_error if control does not tell them within the timeout, or not whole.
  RunningFiles(Client& client, std::chrono::milliseconds timeout);

  std::string vehicle() const { return (folder_.path() / "vehicle.yaml").string(); }
  std::string control() const { return (folder_.path() / "control.yaml").string(); }

 private:
  io::TemporaryFolder folder_;
};

}  // namespace swiftlet::ground
