#include "swiftlet/io/missions/motive_take.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <fmt/core.h>

#include "swiftlet/io/config_error.hpp"
#include "swiftlet/io/csv.hpp"
#include "swiftlet/io/text.hpp"

namespace swiftlet::io {
namespace {

using Fields = std::vector<std::string_view>;

// Motive leaves out the cells at the end of some lines.
std::string_view cell(const Fields& fields, std::size_t at) {
  return at < fields.size() ? fields[at] : std::string_view();
}

std::string_view behind(const Fields& fields, std::string_view key) {
  const auto found = std::find(fields.begin(), fields.end(), key);
  return found == fields.end() ? "" : cell(fields, static_cast<std::size_t>(found - fields.begin()) + 1);
}

std::string negated(const std::string& number) {
  if (number.front() == '-') return number.substr(1);
  return "-" + number.substr(number.front() == '+' ? 1 : 0);
}

// Columns of a rigid body; 0: it has none.
struct Body {
  std::string name;
  std::array<std::size_t, 3> place{};       // x, y, z
  std::array<std::size_t, 4> quaternion{};  // x, y, z, w

  bool has_place() const { return std::count(place.begin(), place.end(), 0U) == 0; }
  bool has_quaternion() const { return std::count(quaternion.begin(), quaternion.end(), 0U) == 0; }
};

class Take {
 public:
  Take(std::string_view text, const std::string& file) : file_(file), lines_(csv_lines(text, file)) {
    const auto names = std::find_if(lines_.begin(), lines_.end(), [](const CsvLine& line) {
      return cell(csv_fields(line.text), 0) == "Frame";
    });
    if (names == lines_.end()) fail("is a take of Motive without a line Frame,Time (Seconds),...");
    first_row_ = static_cast<std::size_t>(names - lines_.begin()) + 1;
    const Fields about = csv_fields(lines_.front().text);
    const std::string_view space = behind(about, "Coordinate Space");
    if (!space.empty() && space != "Global") fail("has local coordinates: export it with those of Global");
    const std::string_view unit = behind(about, "Length Units");
    unit_ = unit == "Millimeters" ? "mm" : unit == "Centimeters" ? "cm" : "m";
    find_body(behind(about, "Rotation Type") == "Quaternion");
  }

  MissionTable read(std::optional<MissionFrame> frame) const {
    const std::string axes = frame ? "" : "_ned";
    std::vector<std::string> columns{"t [s]"};
    for (const char* const axis : {"x", "y", "z"}) columns.push_back(axis + axes + " [" + unit_ + "]");
    if (body_.has_quaternion()) columns.push_back("yaw" + axes + " [rad]");
    MissionTable out{{file_, columns}, {}};
    for (std::size_t i = first_row_; i < lines_.size(); ++i) {
      const Fields fields = csv_fields(lines_[i].text);
      if (cell(fields, body_.place[0]).empty()) continue;
      const std::vector<std::string> row = row_of(fields, lines_[i].number, frame.has_value());
      out.table.add_row(lines_[i].number, Fields(row.begin(), row.end()));
    }
    out.assumptions.push_back(fmt::format(
        "a take of Motive: the rigid body {}, in {} of {} frames{}", body_.name, out.table.row_count(),
        lines_.size() - first_row_,
        frame ? "" : "; Y is up, x north and z east, unless --frame nwu says that Z is up and x north"));
    return out;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw ConfigError(file_, 0, "", what); }

  void find_body(bool has_quaternions) {
    const Fields names = csv_fields(lines_[first_row_ - 1].text);
    const Fields kinds = csv_fields(lines_[first_row_ - 2].text);
    std::size_t types = 0;
    while (types < first_row_ && lines_[types].text.find("Rigid Body") == std::string::npos) ++types;
    if (types + 1 >= first_row_) types = 0;
    const Fields types_of = csv_fields(lines_[types].text);
    const Fields bodies_of = csv_fields(lines_[types + 1].text);
    std::vector<Body> bodies;
    for (std::size_t i = 2; i < names.size(); ++i) {
      if (cell(types_of, i) != "Rigid Body") continue;
      const std::string name(cell(bodies_of, i));
      const std::size_t axis = std::string_view("XYZW").find(names[i]);
      if (names[i].size() != 1 || axis == std::string_view::npos) continue;
      if (bodies.empty() || bodies.back().name != name) bodies.push_back({name});
      if (cell(kinds, i) == "Position" && axis < 3) bodies.back().place[axis] = i;
      if (cell(kinds, i) == "Rotation" && has_quaternions) bodies.back().quaternion[axis] = i;
    }
    const auto is_lost = [](const Body& body) { return !body.has_place(); };
    bodies.erase(std::remove_if(bodies.begin(), bodies.end(), is_lost), bodies.end());
    if (bodies.empty()) fail("is a take of Motive without a rigid body that has positions");
    std::vector<std::string> found;
    for (const Body& body : bodies) found.push_back(body.name);
    if (bodies.size() > 1) fail("has the rigid bodies " + joined(found, ", ") + ": export one of them");
    body_ = bodies.front();
  }

  // Digits stay as they are written: they say how exact a place is.
  std::vector<std::string> row_of(const Fields& fields, int line, bool keeps_axes) const {
    const auto text = [&](std::size_t column, const char* name) {
      csv_number(cell(fields, column), name, file_, line);
      return std::string(fields[column]);
    };
    const std::string x = text(body_.place[0], "X"), y = text(body_.place[1], "Y"),
                      z = text(body_.place[2], "Z");
    std::vector<std::string> row{text(1, "Time (Seconds)"), x};
    row.push_back(keeps_axes ? y : z);
    row.push_back(keeps_axes ? z : negated(y));
    if (!body_.has_quaternion()) return row;
    std::array<double, 4> q{};
    for (std::size_t i = 0; i < q.size(); ++i)
      q[i] = csv_number(cell(fields, body_.quaternion[i]), "Rotation", file_, line);
    const double up = keeps_axes ? q[2] : -q[1], side = keeps_axes ? q[1] : q[2];
    row.push_back(fmt::format(
        "{:.6f}", std::atan2(2.0 * (q[3] * up + q[0] * side), 1.0 - 2.0 * (side * side + up * up))));
    return row;
  }

  const std::string& file_;
  const std::vector<CsvLine> lines_;
  std::size_t first_row_ = 0;
  std::string unit_;
  Body body_;
};

}  // namespace

bool is_motive_take(std::string_view content) {
  constexpr std::string_view kBegin = "Format Version";
  const bool is_quoted = !content.empty() && content.front() == '"';
  return content.substr(is_quoted ? 1 : 0, kBegin.size()) == kBegin;
}

MissionTable read_motive_take(std::string_view text, const std::string& file_name,
                              std::optional<MissionFrame> frame) {
  return Take(text, file_name).read(frame);
}

}  // namespace swiftlet::io
