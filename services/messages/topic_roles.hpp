// The parts of the system, for the permissions of DDS Security. Each writes its topics of topic_table.hpp and may read every topic.
#pragma once

namespace swiftlet::messages {

namespace roles {
inline constexpr const char* kVehicle = "vehicle";
inline constexpr const char* kMocap = "mocap";
inline constexpr const char* kControl = "control";
inline constexpr const char* kGround = "ground";      // tools that command
inline constexpr const char* kObserver = "observer";  // tools that only read, and discovery servers
}  // namespace roles
inline constexpr const char* kRoles[] = {roles::kVehicle, roles::kMocap, roles::kControl, roles::kGround,
                                         roles::kObserver};

}  // namespace swiftlet::messages
