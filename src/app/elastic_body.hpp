// SPDX-License-Identifier: GPL-3.0-or-later
// An elastic body: solids, membranes, cables; in the flow, or alone.
#pragma once

#include <optional>
#include <vector>

#include "app/coupled_body.hpp"
#include "core/stopwatch.hpp"
#include "fem/structure.hpp"
#include "fsi/coupling.hpp"

namespace drogue::app {

/// What the body's elements are made of, its cables last.
std::vector<fem::Region> regions_of(const ElasticBody& body, const fem::Mesh& mesh);

class CoupledElasticBody : public CoupledBody {
 public:
  /// `c`, `body` and `forest`, null without a fluid, outlive it. Throws InputError for a mesh or values that cannot be
  /// run.
  CoupledElasticBody(const Case& c, const Body& body, const fem::Mesh& mesh, const amr::Forest* forest);

  void on_fine_step(fluid::FineStep& step) override { coupling_->on_fine_step(step); }
  void step_alone(double time, double dt) override;
  BodyRow measure(const fluid::FluidSolver* fluid) override;
  void write(const std::filesystem::path& file, double time) const override;
  std::string report(const Case& c) const override;
  void transfer_state(Archive& archive) override;
  double structure_seconds() const override;
  std::string solver() const override;
  std::string warning() const override { return warning_; }

  fem::Structure& structure() { return structure_; }
  /// Where there is a fluid.
  fsi::Coupling& coupling() { return *coupling_; }

 private:
  const Case& case_;
  fem::Structure structure_;
  std::optional<fsi::Coupling> coupling_;
  int centre_point_;       // of the inertia: nearest the middle of the reference mesh
  Vec3 centre_reference_;  // where it was [m]
  std::vector<int> probed_nodes_;
  Stopwatch time_alone_;
  std::string warning_;
};

}  // namespace drogue::app
