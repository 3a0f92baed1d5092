#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Runs the square plate over grids, time steps, held patches, meshes and laws, and writes its table of docs/validation.md:
# tools/validate_square_plate.sh [NAME...] makes the runs named, without names it makes all; with --table it only writes the table
# from what is there (tools/validation_runs.sh).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. tools/validation_runs.sh
runs=runs/validation

# name | case | what it changes | arguments of ./drogue run
matrix() {
  cat <<END
base|square_plate|the case|
grid-48|square_plate|cells of 1/48 m|--set grid.coarsest=1/12 --set grid.finest=1/48 --set grid.region.0.spacing=1/48 --set grid.region.1.spacing=1/24 --set grid.region.2.spacing=1/12
grid-32|square_plate|cells of 1/32 m|--set grid.finest=1/32 --set grid.region.0.spacing=1/32 --set grid.region.1.spacing=1/16 --set grid.region.2.spacing=1/8
grid-96|square_plate|cells of 1/96 m|--set grid.coarsest=1/12 --set grid.finest=1/96 --set grid.region.0.spacing=1/96 --set grid.region.1.spacing=1/48 --set grid.region.2.spacing=1/24
step-half|square_plate|half the time step and Mach number|--set fluid.lattice_velocity=0.025
step-double|square_plate|twice the time step and Mach number|--set fluid.lattice_velocity=0.1
patch-16mm|square_plate|held patch 1/64 m, one element|--set body.plate.hold.0.patch=0.016
patch-63mm|square_plate|held patch 1/16 m|--set body.plate.hold.0.patch=0.063
mesh-26|square_plate|26 x 26 hexahedra|--set body.plate.mesh.elements=[26,26,1]
assumed-strain|square_plate|hexahedra that do not lock|--set body.plate.element="assumed_strain"
mesh-104|square_plate|104 x 104 hexahedra|--set body.plate.mesh.elements=[104,104,1]
delta-3|square_plate|three-point delta|--set body.plate.coupling.delta=peskin3
peskin|square_plate|plain IB/FE coupling, corners held rigidly, quarter time step|--set body.plate.coupling.scheme=peskin --set fluid.lattice_velocity=0.0125 --set body.plate.hold=[{nodes="corners",patch=0.032,rigid=true}]
hold-rigid|square_plate|corners held rigidly|--set body.plate.hold=[{nodes="corners",patch=0.032,rigid=true}]
tether-soft|square_plate|tether 100 times as soft|--set body.plate.hold.0.stiffness=1.5e6
stab-0|square_plate|numerical Poisson's ratio 0|--set body.plate.material.poisson_stabilisation=0
density-air|square_plate|fluid and plate of 1.225 kg/m^3|--set fluid.density=1.225 --set body.plate.density=1.225
start-ramp|square_plate|start from rest, inlet ramp of 0.5 s|--set fluid.initial=rest --set domain.x_min.ramp=0.5
wake|square_plate|finest cells to x = 2, y and z to 1|--set grid.region.1.spacing=1/64 --set grid.region.1.box=[[-0.25,-1,-1],[2,1,1]]
rigid|square_plate|all nodes held|--set body.plate.hold=[{nodes="all",rigid=true}]
rigid-wake|square_plate|all nodes held, finest cells to x = 2, y and z to 1|--set body.plate.hold=[{nodes="all",rigid=true}] --set grid.region.1.spacing=1/64 --set grid.region.1.box=[[-0.25,-1,-1],[2,1,1]]
rigid-96|square_plate|all nodes held, cells of 1/96 m|--set body.plate.hold=[{nodes="all",rigid=true}] --set grid.coarsest=1/12 --set grid.finest=1/96 --set grid.region.0.spacing=1/96 --set grid.region.1.spacing=1/48 --set grid.region.2.spacing=1/24
wide|square_plate|domain of 16 x 8 x 8 m|--set domain.lower=[-4,-4,-4] --set domain.upper=[12,4,4]
rigid-wide|square_plate|all nodes held, domain of 16 x 8 x 8 m|--set domain.lower=[-4,-4,-4] --set domain.upper=[12,4,4] --set body.plate.hold=[{nodes="all",rigid=true}]
svk|square_plate_svk|Saint Venant-Kirchhoff|
svk-patch-16mm|square_plate_svk|Saint Venant-Kirchhoff, held patch 1/64 m|--set body.plate.hold.0.patch=0.016
svk-step-half|square_plate_svk|Saint Venant-Kirchhoff, half the time step|--set fluid.lattice_velocity=0.025
END
}

[[ ${1:-} == --table ]] || make_runs "$@"
{
  heading run 'what differs' 'C_D peak' 'at [s]' 'C_D 4 to 8 s' drift 'dx peak [m]' 'dx 4 to 8 s [m]'
  rows '' cd_peak cd_peak_time cd_stable cd_stable_drift centre_dx_peak centre_dx_stable
} | write_table 'square plate'
