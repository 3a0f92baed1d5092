// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/expression.hpp"

#include <fmt/format.h>
#include <muParser.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "core/error.hpp"

namespace drogue {

namespace {

/// muParser's own words, with its codes for what a user gets wrong most often put more plainly.
std::string reason(const mu::ParserError& error) {
  switch (error.GetCode()) {
    case mu::ecUNASSIGNABLE_TOKEN:
      return fmt::format("has an unknown name \"{}\" at position {}", error.GetToken(), error.GetPos() + 1);
    case mu::ecUNEXPECTED_EOF:
      return "ends too early";
    case mu::ecMISSING_PARENS:
      return "lacks a closing parenthesis";
    case mu::ecEXPRESSION_TOO_LONG:
      return "is too long";
    default:
      return fmt::format("has an unexpected \"{}\" at position {}", error.GetToken(), error.GetPos() + 1);
  }
}

}  // namespace

struct Expression::Parser {
  double x = 0.0, y = 0.0, z = 0.0, t = 0.0;
  mu::Parser parser;

  explicit Parser(const std::string& formula) {
    parser.DefineConst("pi", std::numbers::pi);
    parser.DefineVar("x", &x);
    parser.DefineVar("y", &y);
    parser.DefineVar("z", &z);
    parser.DefineVar("t", &t);
    parser.SetExpr(formula);
  }
};

Expression::Expression(double constant) : text_(fmt::format("{}", constant)), constant_(constant) {}

Expression::Expression(const std::string& formula) : text_(formula) {
  if (formula.find_first_not_of(" \t\n") == std::string::npos) throw InputError("an empty formula has no value");
  try {
    auto parser = std::make_unique<Parser>(formula);
    constant_ = parser->parser.Eval();
    const mu::varmap_type& used = parser->parser.GetUsedVar();
    depends_on_time_ = used.contains("t");
    depends_on_place_ = used.contains("x") || used.contains("y") || used.contains("z");
    if (!used.empty()) parser_ = std::move(parser);
  } catch (const mu::ParserError& error) {
    throw InputError(fmt::format("\"{}\" {}", formula, reason(error)));
  }
  if (!parser_ && !std::isfinite(constant_)) throw InputError(fmt::format("\"{}\" is not a finite number", formula));
}

Expression::Expression(const Expression& other)
    : text_(other.text_),
      constant_(other.constant_),
      depends_on_time_(other.depends_on_time_),
      depends_on_place_(other.depends_on_place_),
      parser_(other.parser_ ? std::make_unique<Parser>(other.text_) : nullptr) {}

Expression& Expression::operator=(const Expression& other) {
  if (this != &other) *this = Expression(other);
  return *this;
}

Expression::Expression(Expression&&) noexcept = default;
Expression& Expression::operator=(Expression&&) noexcept = default;
Expression::~Expression() = default;

double Expression::operator()(const Vec3& position, double time) const {
  if (!parser_) return constant_;
  parser_->x = position.x();
  parser_->y = position.y();
  parser_->z = position.z();
  parser_->t = time;
  return parser_->parser.Eval();
}

}  // namespace drogue
