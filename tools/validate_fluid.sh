#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Runs the rigid bodies over grids, deltas and time steps, and writes their table of docs/validation.md:
# tools/validate_fluid.sh [NAME...] makes the runs named, without names it makes all; with --table it only writes the table
# from what is there (tools/validation_runs.sh).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. tools/validation_runs.sh
runs=runs/validation_fluid

# Of a case around a body of 1 m that refines by boxes: the finest cells 1/$1 m; the boxes are 2 and 4 times as coarse.
cells() {
  local coarsest=1/2
  case $1 in 12 | 24 | 48) coarsest=1/3 ;; esac
  echo "--set grid.coarsest=$coarsest --set grid.finest=1/$1 --set grid.region.1.spacing=2/$1 --set grid.region.2.spacing=4/$1"
}

# name | case | what it changes | arguments of ./drogue run
matrix() {
  local n re tube="--set body.cylinder.shape.length=8/3 --set body.cylinder.shape.centre=[0,0,\"4/3\"]"
  for re in 100 200; do
    for n in 12 16 24 32 48; do
      echo "sphere$re-$n|sphere_re$re|$n cells|$(cells $n)"
    done
    for n in 16 32; do
      echo "sphere$re-$n-unretracted|sphere_re$re|$n cells, markers on the surface|$(cells $n) --set body.sphere.coupling.retraction=0"
    done
  done
  for n in 16 32; do
    echo "sphere100-$n-peskin3|sphere_re100|$n cells, three-point delta|$(cells $n) --set body.sphere.coupling.delta=peskin3"
  done
  echo "sphere100-16-passes|sphere_re100|16 cells, four passes of forcing|$(cells 16) --set body.sphere.coupling.iterations=4"
  echo "sphere100-16-step-half|sphere_re100|16 cells, half the time step and Mach number|$(cells 16) --set fluid.lattice_velocity=0.025"
  echo "sphere100-16-step-double|sphere_re100|16 cells, twice the time step and Mach number|$(cells 16) --set fluid.lattice_velocity=0.1"
  echo "sphere100-16-wide|sphere_re100|16 cells, domain 1.5 times as wide|$(cells 16) --set domain.lower=[-24,-24,-24] --set domain.upper=[32,24,24]"
  echo "sphere100-16-fine-wake|sphere_re100|16 cells, finest ones to 3 m|$(cells 16) --set grid.region.1.spacing=1/16"
  echo "cylinder-16|oscillating_cylinder|16 cells|--set grid.finest=1/16"
  echo "cylinder-24|oscillating_cylinder|24 cells|--set grid.coarsest=1/6 --set grid.finest=1/24 --set grid.region.1.spacing=1/12 --set domain.lower=[-13.3333333333333333,-13.3333333333333333,0] --set domain.upper=[13.3333333333333333,13.3333333333333333,\"8/3\"] $tube"
  echo "cylinder-32|oscillating_cylinder|32 cells|"
  echo "cylinder-32-unretracted|oscillating_cylinder|32 cells, markers on the surface|--set body.cylinder.coupling.retraction=0"
  for n in 16 24 32; do echo "disk-$n|disk_normal|$n cells|$(cells $n)"; done
  for n in 16 24 32; do echo "plate-$n|plate_normal|$n cells|$(cells $n)"; done
}

[[ ${1:-} == --table ]] || make_runs "$@"
{
  heading run 'cells across the body; what differs' 'C_D stable' drift 'C_D peak' 'wake length' 'slip, rms [m/s]'
  rows '' cd_stable cd_stable_drift cd_peak wake_length slip_rms_stable
} | write_table 'rigid bodies'
