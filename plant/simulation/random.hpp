// Random numbers that are the same on every machine and with every standard library: xoshiro256++ (Blackman,
// Vigna 2019) seeded by splitmix64, normal deviates by Marsaglia's polar method with a logarithm made of
// additions, multiplications and divisions only.
#pragma once

#include <array>
#include <cstdint>

#include <Eigen/Core>

namespace swiftlet::plant {

// Streams of one seed and different ids are independent of each other: what one draws does not move another.
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, std::uint64_t stream_id);

  std::uint64_t next();
  double uniform();                  // [0, 1)
  double normal();                   // mean 0, standard deviation 1
  Eigen::Vector3d normal3();         // three of them
  Eigen::Vector3d in_unit_ball();    // uniform in volume
  Eigen::Vector3d on_unit_sphere();  // uniform in area

 private:
  std::array<std::uint64_t, 4> state_;
  double spare_ = 0.0;
  bool has_spare_ = false;
};

}  // namespace swiftlet::plant
