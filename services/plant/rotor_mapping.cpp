#include "swiftlet/services/plant/rotor_mapping.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

#include <fmt/core.h>

#include "swiftlet/io/text.hpp"

namespace swiftlet::services {
namespace {

using Controls = std::array<std::size_t, plant::kMaxRotors>;

constexpr std::size_t kControls = std::tuple_size_v<decltype(mavlink::HilActuatorControls::controls)>;

// The index, from 0, of a rotor of a quadrotor in X in PX4's numbers.
std::size_t px4_index(const plant::RotorMount& rotor) {
  const bool front = rotor.position_frd.x() > 0.0;
  const bool right = rotor.position_frd.y() > 0.0;
  return front ? (right ? 0 : 2) : (right ? 3 : 1);
}

bool is_quad_x(const plant::Vehicle& vehicle) {
  std::array<int, 4> seen{};
  for (const plant::RotorMount& rotor : vehicle.rotors) {
    if (rotor.position_frd.x() == 0.0 || rotor.position_frd.y() == 0.0) return false;
    ++seen[px4_index(rotor)];
  }
  return seen == std::array<int, 4>{1, 1, 1, 1};
}

Controls px4_controls(const plant::Vehicle& vehicle) {
  if (!is_quad_x(vehicle))
    throw std::invalid_argument(fmt::format(
        "--autopilot-controls px4: {} is no quadrotor in X; give the number of the control of each rotor, "
        "such as 1,2,3,4",
        vehicle.name));
  Controls controls{};
  for (std::size_t i = 0; i < vehicle.rotors.size(); ++i) controls[i] = px4_index(vehicle.rotors[i]);
  return controls;
}

std::optional<std::size_t> number_of(const std::string& text) {
  if (text.empty() || text.size() > 2 || text.find_first_not_of("0123456789") != std::string::npos)
    return std::nullopt;
  const auto number = static_cast<std::size_t>(std::stoi(text));
  if (number < 1 || number > kControls) return std::nullopt;
  return number;
}

Controls listed_controls(const std::string& text, int rotor_count) {
  const std::vector<std::string> parts = io::split_text(text, ',');
  if (static_cast<int>(parts.size()) != rotor_count)
    throw std::invalid_argument(fmt::format(
        "--autopilot-controls: is {}, must be px4, direct, or one number for each of the {} rotors", text,
        rotor_count));
  Controls controls{};
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const std::optional<std::size_t> number = number_of(parts[i]);
    if (!number)
      throw std::invalid_argument(
          fmt::format("--autopilot-controls: rotor {}: is {}, must be a control from 1 to {}", i + 1,
                      parts[i], kControls));
    controls[i] = *number - 1;
    if (std::count(controls.begin(), controls.begin() + static_cast<std::ptrdiff_t>(i), controls[i]) > 0)
      throw std::invalid_argument(fmt::format(
          "--autopilot-controls: rotor {}: control {} drives another rotor already", i + 1, *number));
  }
  return controls;
}

Controls controls_of(const std::string& text, const plant::Vehicle& vehicle) {
  if (text == "px4") return px4_controls(vehicle);
  if (text != "direct") return listed_controls(text, vehicle.rotor_count());
  Controls controls{};
  for (std::size_t i = 0; i < controls.size(); ++i) controls[i] = i;
  return controls;
}

}  // namespace

RotorMapping::RotorMapping(const std::string& controls, double control_at_zero, double control_at_full,
                           const plant::Vehicle& vehicle)
    : rotor_count_(vehicle.rotor_count()),
      control_of_rotor_(controls_of(controls, vehicle)),
      control_at_zero_(control_at_zero),
      control_range_(control_at_full - control_at_zero) {
  if (!(control_range_ > 0.0))
    throw std::invalid_argument(
        fmt::format("--autopilot-range: is {:g} to {:g}, the second must be the larger one", control_at_zero,
                    control_at_full));
}

plant::ActuatorCommand RotorMapping::command(const mavlink::HilActuatorControls& controls) const {
  plant::ActuatorCommand command;
  command.rotor_count = rotor_count_;
  if ((controls.mode & mavlink::HilActuatorControls::kArmed) == 0) return command;
  command.rotor_state = plant::RotorState::kRunning;
  for (std::size_t i = 0; i < static_cast<std::size_t>(rotor_count_); ++i) {
    const double control = static_cast<double>(controls.controls[control_of_rotor_[i]]);
    command.throttle[i] = std::clamp((control - control_at_zero_) / control_range_, 0.0, 1.0);
  }
  return command;
}

bool spins_as_px4(const plant::Vehicle& vehicle) {
  return std::all_of(vehicle.rotors.begin(), vehicle.rotors.end(), [](const plant::RotorMount& rotor) {
    const bool counter_clockwise = px4_index(rotor) < 2;
    return (rotor.spin == plant::Spin::kCounterClockwise) == counter_clockwise;
  });
}

}  // namespace swiftlet::services
