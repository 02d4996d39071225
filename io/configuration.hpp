// Where configuration files lie: vehicles, control settings, simulations, missions, fleets, dispersions, rooms.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace swiftlet::io {

// The folders that are searched for vehicles/, control/, missions/, in order: $SWIFTLET_CONFIG_DIR if it is
// set, then /etc/swiftlet for programs in /usr/bin (packages), then, relative to the folder of the running executable,
// ../share/swiftlet/config (installed) and ../../config (build tree).
std::vector<std::string> config_directories();

// Returns the first file that exists: path as given, then, if it is relative ("vehicles/kaylion.yaml"), path
// below each of config_directories(). Throws ConfigError that lists all searched places if there is none.
std::string find_config(const std::string& path);

struct ConfigurationKind {
  const char* folder;  // in the configuration: "vehicles"
  const char* noun;    // "vehicle"
  const char* value;   // name of an option's value in --help: "VEHICLE"
};

namespace kinds {
inline constexpr ConfigurationKind kVehicle{"vehicles", "vehicle", "VEHICLE"};
inline constexpr ConfigurationKind kControl{"control", "control settings", "CONTROL"};
inline constexpr ConfigurationKind kSimulation{"simulation", "simulation settings", "SIMULATION"};
inline constexpr ConfigurationKind kMission{"missions", "mission", "MISSION"};
inline constexpr ConfigurationKind kFleet{"fleets", "fleet", "FLEET"};
inline constexpr ConfigurationKind kDispersion{"dispersion", "dispersion", "DISPERSION"};
inline constexpr ConfigurationKind kRoom{"rooms", "room", "ROOM"};
inline constexpr const char* kAnyValue = "NAME";  // the value of an option that may name a file of any kind
}  // namespace kinds

const std::vector<ConfigurationKind>& configuration_kinds();

struct ConfigurationFile {
  std::string name;  // "square"
  std::filesystem::path path;
};

// All files of this kind in the folders of config_directories(), by name. Of two with one name only the
// first, which is the one that configuration_file() finds.
std::vector<ConfigurationFile> configuration_files(const ConfigurationKind& kind);

// Returns the path of a configuration file. `name` is a path, or the bare name of a file of this kind. Throws
// ConfigError if there is no such file, or with the nearest name and all there are if there is no such name.
std::filesystem::path configuration_file(const ConfigurationKind& kind, const std::string& name);

// The description in the file, else its first comment; "" if it has neither or cannot be read.
std::string description_of(const std::filesystem::path& file);

}  // namespace swiftlet::io
