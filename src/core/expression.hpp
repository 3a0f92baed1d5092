// SPDX-License-Identifier: GPL-3.0-or-later
// A number or a formula in x, y, z [m] and t [s], as it stands in a case file: "1", "0.5*(1-cos(pi*t))*y".
#pragma once

#include <memory>
#include <string>

#include "core/types.hpp"

namespace drogue {

/// Value semantics; evaluation is const and may run in several threads on distinct copies only.
class Expression {
 public:
  Expression(double constant = 0.0);
  /// Throws InputError that names the formula, the position and what was not understood.
  explicit Expression(const std::string& formula);
  Expression(const Expression&);
  Expression(Expression&&) noexcept;
  Expression& operator=(const Expression&);
  Expression& operator=(Expression&&) noexcept;
  ~Expression();

  double operator()(const Vec3& position, double time) const;
  bool is_constant() const { return parser_ == nullptr; }  ///< depends on neither place nor time
  bool depends_on_time() const { return depends_on_time_; }
  bool depends_on_place() const { return depends_on_place_; }
  const std::string& text() const { return text_; }

 private:
  struct Parser;
  std::string text_;
  double constant_ = 0.0;
  bool depends_on_time_ = false, depends_on_place_ = false;
  std::unique_ptr<Parser> parser_;
};

}  // namespace drogue
