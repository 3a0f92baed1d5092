#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Runs the structures without a fluid over loads and meshes, and writes their table of docs/validation.md:
# tools/validate_structures.sh [NAME...] makes the runs named, without names it makes all; with --table it only writes the table
# from what is there (tools/validation_runs.sh).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. tools/validation_runs.sh
runs=runs/validation_structures

# membrane LOAD HEIGHT, cable LENGTH SAG, beam ALPHA DEFLECTION SHORTENING: lines of the matrix.
membrane() {
  local n kind
  for n in 6 12 24; do
    for kind in quadrilaterals triangles; do
      echo "membrane-$1-$n-$kind|membrane_inflation_circular|p a/(G h) = $1, $n x 4 $kind around|--set body.membrane.pressure.0.pressure=$1*100 --set reference.apex_over_radius.value=$2 --set body.membrane.mesh.elements=[$n,$n] --set body.membrane.mesh.triangles=$([[ $kind == triangles ]] && echo true || echo false)"
    done
  done
}
cable() {
  echo "cable-$1|cable_catenary|length $1 of the span|--set body.line.cable.rope.length=$1 --set reference.sag_over_span.value=$2"
}
beam() {
  local n
  for n in 10 20 40; do
    echo "beam-$1-$n|cantilever_large_deflection|alpha = $1, $n elements|--set body.beam.mesh.elements=[$n,1,2] --set body.beam.force.0.force=[0,0,$1] --set reference.deflection_over_length.value=$2 --set reference.shortening_over_length.value=$3"
  done
  echo "beam-$1-20-trilinear|cantilever_large_deflection|alpha = $1, 20 trilinear elements|--set body.beam.element=\"trilinear\" --set body.beam.force.0.force=[0,0,$1] --set reference.deflection_over_length.value=$2 --set reference.shortening_over_length.value=$3"
}

# flag NAME FINEST ELEMENTS RATIO WHAT [ARGUMENTS]: cells of 1/FINEST, ELEMENTS elements across, mass ratio RATIO.
flag() {
  local grid="--set grid.finest=1/$2 --set grid.region.1.spacing=2/$2 --set grid.region.2.spacing=4/$2"
  [[ $2 != 48 && $2 != 96 ]] || grid+=' --set grid.coarsest=1/12 --set domain.upper=["26/3",4,2]'
  echo "flag-$1|flag_3d|$5|$grid --set body.flag.mesh.elements=[$3,$3,1] --set body.flag.density=1+100*$4 ${6:-}"
}
short="--set output.fluid=0 --set time.end=14 --set results.stable_window=[6,14]"

# name | case | what it changes | arguments of ./drogue run
matrix() {
  local n
  membrane 0.1 0.19924
  membrane 0.5 0.37430
  membrane 1.0 0.53121
  cable 1.01 0.061451
  cable 1.1 0.200301
  cable 1.2 0.292344
  cable 2 0.796388
  echo "pendulum|cable_pendulum|four cables|"
  beam 1 0.301721 0.056433
  beam 4 0.669964 0.328941
  for n in 8 16 32; do echo "cook-$n-trilinear|cook_membrane|$n x $n trilinear|--set body.panel.mesh.elements=[$n,$n,1] --set body.panel.element=\"trilinear\""; done
  for n in 8 16 32; do echo "cook-$n|cook_membrane|$n x $n|--set body.panel.mesh.elements=[$n,$n,1]"; done
  for n in 8 16; do
    for kind in assumed_strain trilinear; do
      echo "cook-incompressible-$n-$kind|cook_membrane|nu = 0.499, $n x $n $kind (reference 32 x 32)|--set body.panel.mesh.elements=[$n,$n,1] --set body.panel.element=\"$kind\" --set body.panel.material.poisson=0.499 --set reference.tip_displacement.value=0.02749"
    done
  done
  local longer='--set time.end=24 --set results.stable_window=[12,24]'
  flag 32 32 32 1 'cells of 1/32, until 24 s' "$longer"
  flag 64 64 64 1 'cells of 1/64, the case'
  flag 48-coarse 48 32 1 'cells of 1/48, 32 x 32 elements'
  flag 64-coarse 64 32 1 'cells of 1/64, 32 x 32 elements, until 24 s' "$longer"
  flag 96-coarse 96 32 1 'cells of 1/96, 32 x 32 elements, until 16 s' '--set output.fluid=0 --set time.end=16 --set results.stable_window=[9,16]'
  flag 32-fine 32 64 1 'cells of 1/32, 64 x 64 elements, until 14 s' "$short"
  flag 32-delta-3 32 32 1 'cells of 1/32, three-point delta, until 14 s' "$short --set body.flag.coupling.delta=peskin3"
  flag 32-step-half 32 32 1 'cells of 1/32, half the time step and Mach number, until 14 s' "$short --set fluid.lattice_velocity=0.05"
  flag 32-rr 32 32 1 'cells of 1/32, recursive regularised collision, until 14 s' "$short --set fluid.collision=\"rr\""
  flag 32-thin 32 32 1 'cells of 1/32, half as thick at the same weight and bending rigidity, until 14 s' "$short --set body.flag.mesh.thickness=0.005 --set body.flag.density=201 --set body.flag.material.young=8064"
  flag 32-wide 32 32 1 'cells of 1/32, domain of 16 x 12 x 8, until 14 s' "$short --set domain.lower=[-4,-6,-4] --set domain.upper=[12,6,4]"
  flag 32-trilinear 32 32 1 'cells of 1/32, trilinear elements, until 14 s' "$short --set body.flag.element=\"trilinear\""
  flag 32-light 32 32 0.1 'cells of 1/32, mass ratio 0.1, until 14 s' "$short"
  flag 32-massless 32 32 0 'cells of 1/32, mass ratio 0, until 14 s' "$short"
  for n in 8 16 32; do echo "airbag-$n|airbag_square|$n x $n, tension field|--set body.airbag.mesh.elements=[$n,$n]"; done
  echo "airbag-16-compressed|airbag_square|16 x 16, bears compression|--set body.airbag.wrinkling=false"
}

[[ ${1:-} == --table ]] || make_runs "$@"
{
  heading run 'what differs' result reference difference
  rows membrane apex_over_radius reference difference
  rows cable sag_over_span reference difference
  rows pendulum period reference difference
  rows beam deflection_over_length reference difference
  rows cook tip_displacement reference difference
  rows airbag centre_displacement reference difference
} | write_table 'structures'
{
  heading run 'what differs' 'amplitude over length' 'Strouhal number' 'C_D'
  rows flag amplitude_over_length strouhal cd_stable
} | write_table 'flag'
