// What a setting is: its key in the file, its unit, its limits and its meaning.
//
// visit(settings, visitor) of a struct of settings (plant/simulation/settings_visit.hpp) calls the visitor for each member, in
// the order of the file:
//
//   visitor(Setting, member)                         a number, a bool, a vector or a list of numbers
//   visitor(Setting, member, {"first", "second"})    an enumeration from 0, with the names of its values
//   visitor(Setting, member, arguments ...)          a struct, of which visit(member, visitor, arguments ...) visits the members
//
// Reader (io/settings/settings_reader.hpp), limits (setting_values.hpp), dispersion and Python follow from it.
#pragma once

#include <initializer_list>
#include <type_traits>

namespace swiftlet::plant {

// The valid range of a number, or of each number of a vector.
struct Range {
  enum class Kind { kAny, kFinite, kAbove, kAtLeast, kBetween };
  Kind kind = Kind::kAny;  // kAny: not a number, or checked elsewhere
  double min = 0.0;
  double max = 0.0;
};

constexpr Range finite() { return {Range::Kind::kFinite, 0.0, 0.0}; }
constexpr Range above(double min) { return {Range::Kind::kAbove, min, 0.0}; }
constexpr Range at_least(double min) { return {Range::Kind::kAtLeast, min, 0.0}; }
constexpr Range between(double min, double max) { return {Range::Kind::kBetween, min, max}; }

enum class InFile { kRequired, kOptional, kAbsent };

struct Setting {
  // Names of the member and its key in the file, which differ mostly by the unit.
  struct Name {
    Name(const char* same) : member(same), key(same) {}  // NOLINT(google-explicit-constructor)
    Name(const char* member_, const char* key_) : member(member_), key(key_) {}
    const char* member;
    const char* key;
  };

  Setting(Name name_, const char* meaning_ = "", InFile in_file_ = InFile::kRequired)
      : Setting(name_, "", {}, meaning_, in_file_) {}
  Setting(Name name_, const char* unit_, Range range_, const char* meaning_ = "",
          InFile in_file_ = InFile::kRequired)
      : name(name_), unit(unit_), range(range_), meaning(meaning_), in_file(in_file_) {}

  // The same, of which no dispersion varies the numbers.
  Setting fixed() const {
    Setting out = *this;
    out.varies = false;
    return out;
  }

  Name name;
  const char* unit;  // "1" of a number without unit, "" of what is no quantity
  Range range;
  const char* meaning;  // a phrase without full stop
  InFile in_file;
  bool varies = true;
};

using ValueNames = std::initializer_list<const char*>;

// True for a struct of settings, unlike numbers, vectors and lists of them.
template <class T, class = void>
constexpr bool kIsSection = std::is_class_v<T>;
template <class T>
constexpr bool kIsSection<T, std::void_t<typename T::value_type>> = false;

}  // namespace swiftlet::plant
