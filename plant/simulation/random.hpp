// Random numbers that are the same on every machine and with every standard library: xoshiro256++ (Blackman,
// Vigna 2019) seeded by splitmix64, normal deviates by Marsaglia's polar method, logarithm and exponential
// made of additions, multiplications and divisions only.
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
  double uniform();                            // [0, 1)
  double uniform(double min, double max);      // [min, max]
  double log_uniform(double min, double max);  // of uniform logarithm; 0 < min <= max
  double normal();                             // mean 0, standard deviation 1
  // A normal deviate that lies within min .. max: those outside are drawn again, so the mean must lie within
  // and the limits be at least a sigma apart.
  double truncated_normal(double mean, double sigma, double min, double max);
  Eigen::Vector3d normal3();         // three of them
  Eigen::Vector3d in_unit_ball();    // uniform in volume
  Eigen::Vector3d on_unit_sphere();  // uniform in area

 private:
  std::array<std::uint64_t, 4> state_;
  double spare_ = 0.0;
  bool has_spare_ = false;
};

}  // namespace swiftlet::plant
