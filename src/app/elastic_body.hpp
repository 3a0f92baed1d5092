// SPDX-License-Identifier: GPL-3.0-or-later
// A hyperelastic body in the flow.
#pragma once

#include "app/coupled_body.hpp"
#include "fem/hex_mesh.hpp"
#include "fem/structure.hpp"
#include "fsi/coupling.hpp"

namespace drogue::app {

class CoupledElasticBody : public CoupledBody {
 public:
  /// `body` and `forest` outlive it. Throws InputError for a mesh or values that cannot be run.
  CoupledElasticBody(const Case& c, const Body& body, fem::HexMesh mesh, const amr::Forest& forest);

  void on_fine_step(fluid::FineStep& step) override { coupling_.on_fine_step(step); }
  BodyRow measure(const fluid::FluidSolver& fluid) override;
  void write(const std::filesystem::path& file, double time) const override;
  std::string report(const Case& c) const override;
  void transfer_state(Archive& archive) override;
  double structure_seconds() const override { return coupling_.structure_seconds(); }

 private:
  fem::Structure structure_;
  fsi::Coupling coupling_;
  int centre_point_;       // of the inertia: nearest the middle of the reference mesh
  Vec3 centre_reference_;  // where it was [m]
};

}  // namespace drogue::app
