// The OptiTrack model of config/simulation/optitrack.yaml against a recorded session
// (tests/data/README.md).
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "swiftlet/io/settings/simulation_file.hpp"
#include "swiftlet/io/text_file.hpp"
#include "swiftlet/plant/simulation/mocap.hpp"
#include "tests/support/paths.hpp"

namespace swiftlet::tests::mocap_fit_test {

using Eigen::Vector3d;

struct Frame {
  double time_s = 0.0;
  Vector3d position = Vector3d::Zero();
};

// The recorded session; t, x, y, z, qx, qy, qz, qw below a header.
std::vector<Frame> recorded() {
  const std::string text = io::read_text_file(in_source("tests/data/optitrack_poses.csv"));
  std::vector<Frame> frames;
  for (std::size_t at = text.find('\n') + 1; at < text.size(); at = text.find('\n', at) + 1) {
    Frame frame;
    std::size_t field = at;
    const auto next = [&] {
      const double value = std::stod(text.substr(field, text.find_first_of(",\n", field) - field));
      field = text.find_first_of(",\n", field) + 1;
      return value;
    };
    frame.time_s = next();
    for (int i = 0; i < 3; ++i) frame.position[i] = next();
    frames.push_back(frame);
  }
  return frames;
}

// Frames of the model for a vehicle at rest, by arrival time as in the session.
std::vector<Frame> modelled(double time_s) {
  plant::MocapSettings settings =
      io::load_simulation_settings(in_source("config/simulation/optitrack.yaml")).mocap;
  settings.misalignment_rad = 0.0;
  plant::Mocap mocap(settings, 3);
  std::vector<Frame> frames;
  plant::TruthSample truth;
  for (; static_cast<double>(truth.stamp_ns) * 1e-9 < time_s; truth.stamp_ns += 100'000) {
    if (const auto pose = mocap.update(truth))
      frames.push_back({static_cast<double>(truth.stamp_ns) * 1e-9, pose->position_ned});
  }
  return frames;
}

class Intervals {
 public:
  explicit Intervals(const std::vector<Frame>& frames) {
    for (std::size_t i = 1; i < frames.size(); ++i)
      sorted_.push_back(frames[i].time_s - frames[i - 1].time_s);
    std::sort(sorted_.begin(), sorted_.end());
  }
  double quantile_ms(double probability) const {
    return 1e3 * sorted_[static_cast<std::size_t>(probability * static_cast<double>(sorted_.size() - 1))];
  }
  double mean_ms() const {
    double sum = 0.0;
    for (const double interval : sorted_) sum += interval;
    return 1e3 * sum / static_cast<double>(sorted_.size());
  }

 private:
  std::vector<double> sorted_;
};

// Standard deviation of an axis in mm, over blocks that are too short for drift.
double deviation_mm(const std::vector<Frame>& frames, std::size_t count) {
  constexpr std::size_t kBlock = 50;
  double sum = 0.0;
  std::size_t blocks = 0;
  for (std::size_t at = 0; at + kBlock <= count; at += kBlock, ++blocks) {
    Vector3d mean = Vector3d::Zero();
    for (std::size_t i = at; i < at + kBlock; ++i) mean += frames[i].position / kBlock;
    for (std::size_t i = at; i < at + kBlock; ++i)
      sum += (frames[i].position - mean).squaredNorm() / (3.0 * (kBlock - 1));
  }
  return 1e3 * std::sqrt(sum / static_cast<double>(blocks));
}

TEST(MocapFit, IntervalsMatchTheRecordedSession) {
  const Intervals session(recorded());
  const Intervals model(modelled(300.0));
  for (const double probability : {0.05, 0.10, 0.25, 0.50, 0.75, 0.90, 0.95}) {
    EXPECT_NEAR(model.quantile_ms(probability), session.quantile_ms(probability), 0.6) << probability;
  }
  EXPECT_NEAR(model.mean_ms(), session.mean_ms(), 1.0);
}

TEST(MocapFit, GapsMatchAllSessions) {
  const Intervals model(modelled(1800.0));
  EXPECT_NEAR(model.quantile_ms(0.50), 19.7, 0.5);
  EXPECT_NEAR(model.quantile_ms(0.90), 30.0, 0.5);
  EXPECT_NEAR(model.quantile_ms(0.99), 40.0, 3.0);
  EXPECT_NEAR(model.quantile_ms(0.999), 130.0, 15.0);
  EXPECT_LE(model.quantile_ms(1.0), 140.2);
}

TEST(MocapFit, NoiseAtRestMatchesTheSessions) {
  constexpr std::size_t kAtRest = 200;  // rows of the session
  const double session = deviation_mm(recorded(), kAtRest);
  const double model = deviation_mm(modelled(60.0), 2000);
  EXPECT_NEAR(model, session, 0.4 * session);  // this session has little noise
  EXPECT_GT(model, 0.9 * 0.024);               // all sessions: 0.024 to 0.029 mm
  EXPECT_LT(model, 1.1 * 0.029);
}

}  // namespace swiftlet::tests::mocap_fit_test
