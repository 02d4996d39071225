// Binds a struct of settings by its visit (plant/model/setting.hpp): a property for each member.
#pragma once

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "bindings.hpp"

#include "swiftlet/plant/model/setting.hpp"

namespace swiftlet::python {

// Finds a member by its name.
struct MemberFinder {
  std::string_view name;
  void* found = nullptr;

  template <class T, class... Arguments>
  void operator()(const plant::Setting& setting, T& member, Arguments...) {
    if (setting.name.member == name) found = &member;
  }
  template <class Enum>
  void operator()(const plant::Setting& setting, Enum& member, plant::ValueNames) {
    if (setting.name.member == name) found = &member;
  }
};

template <class Member, class Settings>
Member& member_of(Settings& settings, std::string_view name) {
  MemberFinder finder{name};
  visit(settings, finder);
  return *static_cast<Member*>(finder.found);
}

// "Of planned references, m/s."
inline std::string docstring(const plant::Setting& setting) {
  std::string text = setting.meaning;
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  const std::string unit = setting.unit;
  if (unit != "1" && !unit.empty()) text += (text.empty() ? "" : ", ") + unit;
  return text.empty() ? text : text + ".";
}

// "'a', 'b' or 'c'"
inline std::string alternatives(const std::vector<std::string>& names) {
  std::string out;
  for (std::size_t i = 0; i < names.size(); ++i)
    out += (i == 0 ? "'" : i + 1 == names.size() ? " or '" : ", '") + names[i] + "'";
  return out;
}

// The name in Python of a struct of settings. Specialized where it differs from that in C++.
template <class Settings>
std::string class_name() {
  const std::string type = py::type_id<Settings>();
  return type.substr(type.rfind(':') + 1);
}

template <class Settings>
py::class_<Settings> settings_class(py::module_& module, const std::string& name, const std::string& doc);

template <class Settings>
class PropertyBinder {
 public:
  PropertyBinder(py::module_& module, py::class_<Settings>& type) : module_(module), type_(type) {}

  template <class T, class... Arguments>
  void operator()(const plant::Setting& setting, T&, Arguments...) {
    if constexpr (plant::kIsSection<T>) add_class<T>(docstring(setting));
    const char* const name = setting.name.member;
    type_.def_property(
        name, [name](Settings& self) -> const T& { return member_of<T>(self, name); },
        [name](Settings& self, const T& value) { member_of<T>(self, name) = value; },
        docstring(setting).c_str());
  }
  // A text in Python.
  template <class Enum>
  void operator()(const plant::Setting& setting, Enum&, plant::ValueNames values) {
    const char* const name = setting.name.member;
    const std::vector<std::string> names(values.begin(), values.end());
    type_.def_property(
        name,
        [name, names](Settings& self) {
          return names[static_cast<std::size_t>(member_of<Enum>(self, name))];
        },
        [name, names](Settings& self, const std::string& text) {
          const auto found = std::find(names.begin(), names.end(), text);
          if (found == names.end())
            refuse(std::string(name) + " is '" + text + "', must be " + alternatives(names));
          member_of<Enum>(self, name) = static_cast<Enum>(found - names.begin());
        },
        (alternatives(names) + ". " + docstring(setting)).c_str());
  }

 private:
  // Adds the class of a section, unless the module has it.
  template <class Section>
  void add_class(const std::string& doc) {
    const std::string name = class_name<Section>();
    if (!py::hasattr(module_, name.c_str())) settings_class<Section>(module_, name, doc);
  }

  py::module_& module_;
  py::class_<Settings>& type_;
};

// The class of a struct of settings, with those of the structs in it.
template <class Settings>
py::class_<Settings> settings_class(py::module_& module, const std::string& name, const std::string& doc) {
  py::class_<Settings> type(module, name.c_str(), doc.c_str());
  PropertyBinder<Settings> binder(module, type);
  Settings example;
  visit(example, binder);
  return type;
}

}  // namespace swiftlet::python
