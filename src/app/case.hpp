// SPDX-License-Identifier: GPL-3.0-or-later
// A case: everything that decides a run, in SI, read and validated. Plain data; `case_reader` fills it.
#pragma once

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "amr/forest.hpp"
#include "core/types.hpp"
#include "fem/contact.hpp"
#include "fem/mesh_shapes.hpp"
#include "fem/structure.hpp"
#include "fluid/specification.hpp"
#include "fsi/coupling.hpp"
#include "geometry/surface.hpp"
#include "ib/rigid_body.hpp"

namespace drogue::app {

struct Case;

/// Cells of at most `spacing` in a box, or within `distance` of a body and of the places it moves through.
struct Region {
  std::optional<Box> box;
  std::string body;
  double distance = 0.0;      ///< [m]
  Vec3 sweep = Vec3::Zero();  ///< [m]
  double spacing = 0.0;       ///< [m]
};

/// Nodes by the name of their set (fem::nodes_named).
struct NodesNamed {
  std::string name;
  double patch = 0.0;  ///< [m] edge of the corners, if the name is "corners"
};

/// The solid that a sheet sweeps out.
struct BlockDescription {
  fem::SheetDescription base;
  Vec3 way = Vec3::Zero();  ///< [m]
  int layers = 1;
};

/// A mesh to be read or made; one without anything is filled by points and cables.
using MeshDescription = std::variant<std::filesystem::path, fem::PlateDescription, fem::SheetDescription,
                                     fem::DiskDescription, BlockDescription, fem::Mesh>;

struct PointDescription {
  std::string name;
  Vec3 place = Vec3::Zero();  ///< [m]
  double mass = 0.0;          ///< [kg]
};

/// Straight in the mesh, from every node of one set to the nearest of the other.
struct CableDescription {
  std::string name;
  std::string from, to;
  int elements = 1;
  double length = 0.0;  ///< unstressed [m]; 0 for that in the mesh
  fem::Region region;
};

struct HoldDescription {
  NodesNamed nodes;
  fem::Hold hold;  ///< without its nodes
};

struct ForceDescription {
  NodesNamed nodes;
  std::array<Expression, 3> force{};  ///< [N]
};

/// The displacement of a node, as a column of the history and a result.
struct Probe {
  std::string name;
  Vec3 place = Vec3::Zero();       ///< the node nearest to it in the mesh [m]
  Vec3 direction = Vec3::UnitX();  ///< unit vector
  double scale = 1.0;              ///< [m] that the displacement is divided by
  std::string statistic;           ///< see results.cpp
};

struct ElasticBody {
  MeshDescription mesh;
  std::vector<PointDescription> points;
  std::vector<CableDescription> cables;
  std::vector<fem::Region> regions;  ///< besides the cables
  std::vector<HoldDescription> holds;
  std::vector<ForceDescription> forces;
  std::vector<fem::Pressure> pressures;
  Vec3 gravity = Vec3::Zero();     ///< [m/s^2]
  double damping = 0.0;            ///< [1/s]
  double stiffness_damping = 0.0;  ///< [s]
  fem::StructureOptions structure;
  std::vector<Probe> probes;
  fsi::CouplingOptions coupling;
};

struct RigidBody {
  geometry::Shape shape;
  std::string key;  ///< that gave the shape: "shape" or "surface"
  ib::RigidMotion motion;
  ib::RigidBodyOptions coupling;
};

struct Body {
  std::string name;
  double reference_area = 0.0;  ///< [m^2] of force coefficients
  std::variant<ElasticBody, RigidBody> kind;
  bool in_flow = true;  ///< as all are where there is a fluid
};

/// What columns of the history and results ask of a body.
bool in_flow(const Body& body);
bool is_elastic(const Body& body);
bool is_elastic_in_flow(const Body& body);
bool is_rigid(const Body& body);
const std::vector<Probe>& probes_of(const Body& body);
/// "m", or "1" for a displacement over a length.
const char* unit_of(const Probe& probe);
/// Whether it stands still and has a width, by which the length of its wake is told.
bool has_wake(const Body& body);

/// Points (x, y).
struct Curve {
  std::vector<double> x, y;
};

/// A straight line along which the flow is sampled.
struct Profile {
  std::string name;
  Vec3 from = Vec3::Zero(), to = Vec3::Zero();  ///< [m]
  int points = 0;
  int component = 0;  ///< of the velocity that the reference holds
  Curve reference;    ///< of distance from the beginning [m] and velocity [m/s]; may be empty

  bool has_reference() const { return !reference.x.empty(); }
  /// The point at a distance [m] from the beginning.
  Vec3 at(double distance) const {
    const double share = std::min(1.0, distance / (to - from).norm());
    return (1.0 - share) * from + share * to;  // which is in the domain if both ends are
  }
};

/// What something that passes leaves behind: the largest deviation in a box, over its own amplitude.
struct Residual {
  Box box;                       ///< [m] where the fluid should be undisturbed again
  bool of_pressure = false;      ///< else of the velocity
  Vec3 velocity = Vec3::Zero();  ///< [m/s] undisturbed
  double amplitude = 0.0;        ///< [m/s] or [Pa]
};

/// What is measured of the flow besides what every run tells.
struct Measure {
  bool energy = false;
  Curve dissipation_reference;  ///< time and dissipation, in units of reference velocity and length; may be empty
  std::optional<std::array<Expression, 3>> exact_velocity;  ///< [m/s]
  std::optional<Residual> residual;
  std::vector<Profile> profiles;
};

bool measures_energy(const Case& c);
bool measures_error(const Case& c);
bool measures_residual(const Case& c);

/// Intervals between outputs [s]; 0 for none (history: every coarse step).
struct Output {
  double history = 0.0, fluid = 0.0, canopy = 0.0;
  double checkpoint = 0.0;  ///< of wall time
};

/// How structures move where there is no fluid.
struct StructureSolver {
  bool at_rest = false;  ///< every step ends in equilibrium
  double step = 0.0;     ///< [s]
  fem::EquilibriumOptions equilibrium;
};

struct ResultOptions {
  std::string body;                       ///< whose results are summarised; empty without bodies
  std::array<double, 2> stable_window{};  ///< [s]
  double peak_from = 0.0;                 ///< [s]
};

/// What a result of the run is held against: a published number, or a bound on what should be zero.
struct Reference {
  std::string name;  ///< of the result
  double value = 0.0;
  double within = 0.0;  ///< relative difference; of a bound the largest magnitude
  std::string source;

  bool is_bound() const { return value == 0.0; }
};

struct Case {
  std::filesystem::path file;
  std::string name;  ///< of the folder
  std::string title;
  std::string solver;  ///< of the fluid; "none" for structures alone
  bool has_fluid() const { return solver != "none"; }

  fluid::Specification fluid;
  double reference_length = 0.0;  ///< [m]; 0 if not given
  amr::Domain domain;
  double finest = 0.0;  ///< cell edge [m]
  std::vector<Region> regions;
  std::vector<Body> bodies;
  std::optional<fem::ContactOptions> contact;  ///< of the elastic bodies
  double end = 0.0;                            ///< [s]
  StructureSolver structure;
  Measure measure;
  Output output;
  ResultOptions results;
  std::vector<Reference> references;

  std::map<std::string, std::string> origin;  ///< key -> "file:line" it was given at, for messages
  std::string resolved;                       ///< the case as TOML, every key with its value in use
};

inline constexpr std::array<const char*, 6> face_names{"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"};

/// Number of refinement levels between `coarsest` and `spacing`, or `amr::none` if that is no halving of `coarsest`.
int level_of(double coarsest, double spacing);

/// The body whose results are summarised; null without bodies.
const Body* summarised_body(const Case& c);

/// Step of a level [s]: the reference velocity crosses `lattice_velocity` cells in it.
double time_step(const Case& c, int level);
/// Relaxation time of a level in its own steps.
double relaxation_time(const Case& c, int level);
/// How far before its markers the fluid of the case sees a surface, in cells of the finest level.
double wall_offset(const Case& c, ib::Delta delta);
/// Unit vector of the flow that enters: of the first velocity face at its centre, or x.
Vec3 flow_direction(const Case& c);

}  // namespace drogue::app
