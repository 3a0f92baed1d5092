// SPDX-License-Identifier: GPL-3.0-or-later
// How each type of value that a case may hold is written in TOML. A number may be given as a constant formula: "1/64".
#pragma once

#include <toml++/toml.h>

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "core/expression.hpp"
#include "core/types.hpp"

namespace drogue::app {

using Pair = std::array<double, 2>;
using Index2 = std::array<int, 2>;
using Corners = std::array<Vec3, 4>;
using Formulas = std::array<Expression, 3>;

/// Converts a node; throws InputError "<value> <what is wrong with it>".
void read_value(const toml::node& node, bool& value);
void read_value(const toml::node& node, int& value);
void read_value(const toml::node& node, double& value);
void read_value(const toml::node& node, Pair& value);
void read_value(const toml::node& node, Vec3& value);
void read_value(const toml::node& node, Index2& value);
void read_value(const toml::node& node, Index3& value);
void read_value(const toml::node& node, Corners& value);
void read_value(const toml::node& node, Box& value);
void read_value(const toml::node& node, Expression& value);
void read_value(const toml::node& node, Formulas& value);
void read_value(const toml::node& node, std::string& value);
void read_value(const toml::node& node, std::filesystem::path& value);

/// The value as TOML that reads back to the same value.
std::string write_value(bool value);
std::string write_value(int value);
std::string write_value(double value);
std::string write_value(const Pair& value);
std::string write_value(const Vec3& value);
std::string write_value(const Index2& value);
std::string write_value(const Index3& value);
std::string write_value(const Corners& value);
std::string write_value(const Box& value);
std::string write_value(const Expression& value);
std::string write_value(const Formulas& value);
std::string write_value(const std::string& value);
std::string write_value(const std::filesystem::path& value);

/// What a value of a type is called in messages.
template <class T>
inline constexpr const char* expected = nullptr;
template <>
inline constexpr const char* expected<bool> = "true or false";
template <>
inline constexpr const char* expected<int> = "an integer";
template <>
inline constexpr const char* expected<double> = "a number";
template <>
inline constexpr const char* expected<Pair> = "two numbers";
template <>
inline constexpr const char* expected<Vec3> = "three numbers";
template <>
inline constexpr const char* expected<Index2> = "two integers";
template <>
inline constexpr const char* expected<Index3> = "three integers";
template <>
inline constexpr const char* expected<Corners> = "four corners [[x, y, z], ...]";
template <>
inline constexpr const char* expected<Box> = "two corners [[x, y, z], [x, y, z]]";
template <>
inline constexpr const char* expected<Expression> = "a number or a formula in x, y, z, t";
template <>
inline constexpr const char* expected<Formulas> = "three numbers or formulas in x, y, z, t";
template <>
inline constexpr const char* expected<std::string> = "a string";
template <>
inline constexpr const char* expected<std::filesystem::path> = "the name of a file";

/// The numbers of a value that the range of its key is about.
template <class T>
std::vector<double> numbers(const T&) {
  return {};
}
inline std::vector<double> numbers(int value) { return {static_cast<double>(value)}; }
inline std::vector<double> numbers(double value) { return {value}; }
inline std::vector<double> numbers(const Pair& v) { return {v[0], v[1]}; }
inline std::vector<double> numbers(const Vec3& v) { return {v[0], v[1], v[2]}; }
inline std::vector<double> numbers(const Index2& v) { return {1.0 * v[0], 1.0 * v[1]}; }
inline std::vector<double> numbers(const Index3& v) { return {1.0 * v[0], 1.0 * v[1], 1.0 * v[2]}; }

}  // namespace drogue::app
