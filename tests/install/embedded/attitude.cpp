// A project that embeds this one: a quarter turn to the right.
#include <cmath>
#include <cstdio>

#include <swiftlet/math/euler.hpp>

int main() {
  using namespace swiftlet::math;
  const EulerAngles angles = euler_angles(quaternion_from_euler({0.0, 0.0, 0.5 * M_PI}));
  std::printf("yaw is %.4f rad\n", angles.heading.yaw_rad);
  return std::abs(angles.heading.yaw_rad - 0.5 * M_PI) < 1e-12 ? 0 : 1;
}
