// Flights of the square in rough air by several control laws, for `./dev bench tracking --rough`.
#pragma once

namespace swiftlet::bench {

struct RoughOptions {
  int flights = 200;  // in gusts, by each law; a tenth of that in each other condition
  bool json = false;
};

// Flies and prints a row for each condition and law.
void fly_rough_air(const RoughOptions& options);

}  // namespace swiftlet::bench
