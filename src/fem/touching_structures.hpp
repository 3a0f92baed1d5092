// SPDX-License-Identifier: GPL-3.0-or-later
// Structures whose surfaces push each other, and themselves, apart (fem/contact.hpp). The force between two of them is
// equal and opposite at every instant only if both are there at the same instants, so all advance in common sub-steps.
#pragma once

#include <vector>

#include "fem/contact.hpp"
#include "fem/structure.hpp"

namespace drogue::fem {

class TouchingStructures {
 public:
  /// The structures outlive it and keep the inertia that they have now. Throws InputError for options out of range, if
  /// there are no surfaces, or if a structure is to move implicitly.
  TouchingStructures(std::vector<Structure*> structures, const ContactOptions& options);

  /// As Structure::advance() does each of them, explicitly.
  void advance(double dt, double time);
  double stable_step() const;  ///< [s] longest sub-step, as Structure::stable_step(), with what touched last

 private:
  std::vector<Structure::Data*> structures_;
  Contact contact_;
};

}  // namespace drogue::fem
