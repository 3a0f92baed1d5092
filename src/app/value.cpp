// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/value.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "app/document.hpp"
#include "core/error.hpp"

namespace drogue::app {

namespace {

[[noreturn]] void refuse(const toml::node& node) {
  throw InputError(fmt::format("{} is {}", text_of(node), kind_of(node)));
}

/// Reads `size` elements of an array by `read(element, index)`.
template <class Read>
void read_elements(const toml::node& node, std::size_t size, Read read) {
  const toml::array* array = node.as_array();
  if (!array) refuse(node);
  if (array->size() != size) {
    throw InputError(fmt::format("{} has {} element{}", text_of(node), array->size(), array->size() == 1 ? "" : "s"));
  }
  for (std::size_t i = 0; i < size; ++i) {
    try {
      read((*array)[i], i);
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}: {}", text_of(node), error.what()));
    }
  }
}

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    if (c == '\n') {
      out += "\\n";
    } else {
      out += c;
    }
  }
  return out + "\"";
}

}  // namespace

void read_value(const toml::node& node, bool& value) {
  if (!node.is_boolean()) refuse(node);
  value = **node.as_boolean();
}

void read_value(const toml::node& node, double& value) {
  if (const auto number = node.value<double>(); number && node.is_number()) {
    value = *number;
  } else if (node.is_string()) {
    const Expression formula(**node.as_string());
    if (!formula.is_constant()) throw InputError(fmt::format("{} is not constant", text_of(node)));
    value = formula(Vec3::Zero(), 0.0);
  } else {
    refuse(node);
  }
  if (!std::isfinite(value)) throw InputError(fmt::format("{} is not finite", text_of(node)));
}

void read_value(const toml::node& node, int& value) {
  double number = 0.0;
  read_value(node, number);
  if (number != std::round(number)) throw InputError(fmt::format("{} is not whole", text_of(node)));
  if (std::abs(number) > std::numeric_limits<int>::max()) {
    throw InputError(fmt::format("{} is too large", text_of(node)));
  }
  value = static_cast<int>(number);
}

void read_value(const toml::node& node, Pair& value) {
  read_elements(node, 2, [&](const toml::node& element, std::size_t i) { read_value(element, value[i]); });
}

void read_value(const toml::node& node, Vec3& value) {
  read_elements(node, 3, [&](const toml::node& element, std::size_t i) {
    read_value(element, value[static_cast<Eigen::Index>(i)]);
  });
}

void read_value(const toml::node& node, Index2& value) {
  read_elements(node, 2, [&](const toml::node& element, std::size_t i) { read_value(element, value[i]); });
}

void read_value(const toml::node& node, Corners& value) {
  read_elements(node, 4, [&](const toml::node& element, std::size_t i) { read_value(element, value[i]); });
}

void read_value(const toml::node& node, Index3& value) {
  read_elements(node, 3, [&](const toml::node& element, std::size_t i) { read_value(element, value[i]); });
}

void read_value(const toml::node& node, Box& value) {
  read_elements(node, 2, [&](const toml::node& element, std::size_t i) {
    read_value(element, i == 0 ? value.lower : value.upper);
  });
}

void read_value(const toml::node& node, Expression& value) {
  if (node.is_string()) {
    value = Expression(**node.as_string());
  } else {
    double number = 0.0;
    read_value(node, number);
    value = Expression(number);
  }
}

void read_value(const toml::node& node, Formulas& value) {
  read_elements(node, 3, [&](const toml::node& element, std::size_t i) { read_value(element, value[i]); });
}

void read_value(const toml::node& node, std::string& value) {
  if (!node.is_string()) refuse(node);
  value = **node.as_string();
}

void read_value(const toml::node& node, std::filesystem::path& value) {
  if (!node.is_string()) refuse(node);
  value = **node.as_string();
}

std::string write_value(bool value) { return value ? "true" : "false"; }
std::string write_value(int value) { return fmt::format("{}", value); }
std::string write_value(double value) { return fmt::format("{}", value); }
std::string write_value(const Pair& v) { return fmt::format("[{}, {}]", v[0], v[1]); }
std::string write_value(const Vec3& v) { return fmt::format("[{}, {}, {}]", v[0], v[1], v[2]); }
std::string write_value(const Index2& v) { return fmt::format("[{}, {}]", v[0], v[1]); }
std::string write_value(const Corners& v) {
  return fmt::format("[{}, {}, {}, {}]", write_value(v[0]), write_value(v[1]), write_value(v[2]), write_value(v[3]));
}
std::string write_value(const Index3& v) { return fmt::format("[{}, {}, {}]", v[0], v[1], v[2]); }
std::string write_value(const Box& box) {
  return fmt::format("[{}, {}]", write_value(box.lower), write_value(box.upper));
}
std::string write_value(const Expression& value) {
  return value.is_constant() ? write_value(value(Vec3::Zero(), 0.0)) : quoted(value.text());
}
std::string write_value(const Formulas& v) {
  return fmt::format("[{}, {}, {}]", write_value(v[0]), write_value(v[1]), write_value(v[2]));
}
std::string write_value(const std::string& value) { return quoted(value); }
std::string write_value(const std::filesystem::path& value) { return quoted(value.string()); }

}  // namespace drogue::app
