// SPDX-License-Identifier: GPL-3.0-or-later
// The elements of one family in one region, behind an interface that is called once per batch of elements. What the
// families have in common is in element_batch.hpp, their kernels in hexahedra.cpp, membranes.cpp and cables.cpp.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "fem/element_batch.hpp"
#include "fem/mesh.hpp"
#include "fem/region.hpp"

namespace drogue::fem {

struct GroupDescription {
  const Region& region;                ///< outlives the group
  std::array<double, 2> volume_ratio;  ///< bounds of J that compute_forces() watches
};

/// Elements of one kind with the forces on their nodes.
class ForceGroup {
 public:
  virtual ~ForceGroup() = default;

  int count() const { return static_cast<int>(nodes_.size()) / nodes_per_element_; }
  int batches() const { return (count() + lanes - 1) / lanes; }
  int nodes_per_element() const { return nodes_per_element_; }
  std::span<const int> nodes_of(int element) const {
    return std::span(nodes_).subspan(static_cast<std::size_t>(element) * nodes_per_element_, nodes_per_element_);
  }

  /// Forces of a batch at positions `x`, for force_on() to read; whether the state is within bounds.
  virtual bool compute_forces(int batch, std::span<const Vec3> x) = 0;
  /// Minus the derivative of the forces with the positions, there: a batch's matrix, [row][column] for the coordinates
  /// x, y, z of the first node, of the second and so on [N/m].
  virtual void compute_stiffness(int batch, std::span<const Vec3> x, Pack* matrix) const = 0;
  /// Where the x component of the force on a node of an element is kept; y and z follow at distances of `lanes`.
  virtual const double* force_on(int element, int local_node) const = 0;

 protected:
  ForceGroup(int nodes_per_element, std::vector<int> nodes)
      : nodes_per_element_(nodes_per_element), nodes_(std::move(nodes)) {}

 private:
  int nodes_per_element_;
  std::vector<int> nodes_;
};

class ElementGroup : public ForceGroup {
 public:
  const Region& region() const { return region_; }
  /// Such as "hexahedron 12", with its number in the mesh.
  std::string name_of(int element) const;

  /// A share of the active stress of `time` [s] acts from now on.
  void set_time(double time, double share);
  bool compute_forces(int batch, std::span<const Vec3> x) override;

  /// Of a batch, for nodal_stiffness(): from density times squared frequency of an element, from above, as deformed,
  /// each direction of directional_stiffness() weighted with its lightness.
  void bound_stiffness(int batch, std::span<const Vec3> x);
  /// Where a stiffness [N/m] is kept such that the matrix of an element is at most diagonal with that for each of its
  /// nodes.
  const double* nodal_stiffness(int element) const { return &nodal_stiffness_[element]; }
  /// Masses that its nodes are said to have over those that move along each direction; 1 to begin with.
  void set_lightness(int element, const std::array<double, 3>& lightness) { lightness_[element] = lightness; }

  struct Extreme {
    int element;
    double volume_ratio, excess;  ///< how far out of bounds, as a factor; infinite for no number
  };
  /// The element that was furthest out of bounds in the last compute_forces().
  Extreme worst() const;

  virtual void add_volumes(std::span<double> nodal_volume) const = 0;  ///< [m^3]
  double elastic_energy(std::span<const Vec3> x) const;                ///< [J]
  std::array<double, 2> volume_ratio_range(std::span<const Vec3> x) const;

 protected:
  ElementGroup(const GroupDescription& description, std::string family, int nodes_per_element, std::vector<int> nodes,
               std::vector<int> numbers);
  const ActiveFibre& fibre() const { return fibre_; }
  /// To be called once, when volume_of() is known.
  void keep_volumes();

 private:
  virtual VolumeRatio forces_of(int batch, std::span<const Vec3> x) = 0;
  virtual VolumeRatio volume_ratio_of(int batch, std::span<const Vec3> x) const = 0;
  virtual Pack energy_of(int batch, std::span<const Vec3> x) const = 0;
  virtual Tensor<Pack> stiffness_of(int batch, std::span<const Vec3> x) const = 0;
  virtual double volume_of(int element) const = 0;  // [m^3]

  std::string family_;
  const Region& region_;
  ActiveFibre fibre_;
  std::array<double, 2> bounds_;
  std::vector<int> number_;
  std::vector<VolumeRatio> ratios_;
  std::vector<std::array<double, 3>> lightness_;
  std::vector<double> volume_;  // [m^3]
  std::vector<double> nodal_stiffness_;
};

/// `elements` are numbers in the mesh. Throw InputError for a node number out of range and for an inverted or flat
/// element.
std::unique_ptr<ElementGroup> make_hexahedra(const Solid& solid, const GroupDescription& group, const Mesh& mesh,
                                             const std::vector<int>& elements);
std::unique_ptr<ElementGroup> make_assumed_strain_hexahedra(const Solid& solid, const GroupDescription& group,
                                                            const Mesh& mesh, const std::vector<int>& elements);
std::unique_ptr<ElementGroup> make_quadrilaterals(const Membrane& membrane, const GroupDescription& group,
                                                  const Mesh& mesh, const std::vector<int>& elements);
std::unique_ptr<ElementGroup> make_triangles(const Membrane& membrane, const GroupDescription& group, const Mesh& mesh,
                                             const std::vector<int>& elements);
std::unique_ptr<ElementGroup> make_cables(const Cable& cable, const GroupDescription& group, const Mesh& mesh,
                                          const std::vector<int>& elements);

}  // namespace drogue::fem
