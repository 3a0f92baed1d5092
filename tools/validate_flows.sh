#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Runs the flows without bodies over grids, schemes and time steps, and writes their tables of docs/validation.md:
# tools/validate_flows.sh [NAME...] makes the runs named, without names it makes all; with --table it only writes the tables
# from what is there (tools/validation_runs.sh).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. tools/validation_runs.sh
runs=runs/validation_flows

cells() { echo "--set grid.coarsest=$1 --set grid.finest=$1"; }
# The Mach number shrinks with the cells, as the error of the scheme does: by its square.
walls() { echo "$(cells 1/$1) --set fluid.lattice_velocity=0.8/$1 --set domain.upper=[$2,1,\"16/$1\"]"; }
slice() { echo "--set domain.upper=[1,1,\"16/$1\"] --set fluid.lattice_velocity=0.8/$1"; }

matrix() {
  local n u re side octant="--set domain.upper=[\"pi\",\"pi\",\"pi\"]"
  for side in x_min x_max y_min y_max z_min z_max; do octant+=" --set domain.$side.type=free_slip"; done

  # The noise of 16-bit stresses is some 4e-5 of the velocity; the order is seen in doubles.
  for n in 16 32 64; do echo "green-$n|taylor_green|$n cells|$(cells 1/$n) $(slice $n) --set fluid.storage=float64"; done
  for n in 32 64; do echo "green-default-$n|taylor_green|$n cells, default storage|$(cells 1/$n) $(slice $n)"; done
  # The transfer between levels errs in each step; how that changes with the step is seen at fixed velocities in cells a step.
  refined() { echo "--set grid.coarsest=1/$1 --set grid.finest=1/$((2 * $1)) --set grid.region=[{box=[[0,0,0],[0.5,0.5,1]]}] $(slice $1)"; }
  for n in 32 64 96; do
    echo "green-refined-$n|taylor_green|$n cells, a quarter of the square refined, 0.025 cells a step|$(refined $n) --set fluid.lattice_velocity=0.025"
  done
  for u in 0.05 0.0125; do
    echo "green-refined-64-u$u|taylor_green|64 cells, a quarter of the square refined, $u cells a step|$(refined 64) --set fluid.lattice_velocity=$u"
  done

  for n in 64 128 256; do echo "tgv-$n|taylor_green_re1600|$n^3, an eighth of the box|$(cells 2*pi/$n) $octant"; done
  echo "tgv-whole-64|taylor_green_re1600|64^3, the whole box|$(cells pi/32)"
  for u in 0.05 0.15; do
    echo "tgv-128-u$u|taylor_green_re1600|128^3, $u cells a step|--set fluid.lattice_velocity=$u $octant"
  done
  echo "tgv-128-sigma-0.995|taylor_green_re1600|128^3, sigma 0.995|--set fluid.hrr_sigma=0.995 $octant"
  echo "tgv-128-sigma-1|taylor_green_re1600|128^3, sigma 1|--set fluid.hrr_sigma=1 $octant"
  echo "tgv-128-bgk|taylor_green_re1600|128^3, single relaxation time|--set fluid.collision=bgk $octant"
  echo "tgv-inviscid-64|taylor_green_re1600|64^3, the whole box, Re = 1e7, to t = 20|$(cells pi/32) --set fluid.reynolds=1e7 --set time.end=20 --set fluid.lattice_velocity=0.05"

  echo "cavity-48|cavity_re1000|48^3, the whole cube|$(cells 1/48) --set domain.upper=[1,1,1] --set domain.z_max.type=no_slip"
  for n in 64 96 128; do echo "cavity-$n|cavity_re1000|$n^3|$(cells 1/$n)"; done

  for n in 16 32 64; do
    echo "channel-$n|channel|$n cells across|$(walls $n \"16/$n\") --set fluid.storage=float64"
  done
  echo "channel-default-32|channel|32 cells across, default storage|$(walls 32 \"16/32\")"
  for n in 32 64; do
    echo "channel-refined-$n|channel|$n cells across, the lower half refined|$(walls $n \"16/$n\") --set fluid.storage=float64 --set grid.finest=1/$((2 * n)) --set grid.region=[{box=[[0,0,0],[1,0.5,1]]}]"
  done
  for n in 16 32 64; do echo "inlet-$n|channel_inlet|$n cells across|$(walls $n 2)"; done
}

# Adds a column: the order of convergence of the third column from the row before, where both begin with a number of cells
# and are otherwise of the same name.
with_order() {
  awk -F' *\\| *' '{
    split($3, word, " "); n = word[1] + 0; error = $4 + 0; name = $2; gsub(/[0-9]/, "", name)
    order = name == last && n != before && error > 0 ? sprintf("%.2f", log(former / error) / log(n / before)) : "-"
    printf "| %s | %s | %s | %s | %s |\n", $2, $3, $4, $5, order; last = name; before = n; former = error
  }'
}

[[ ${1:-} == --table ]] || make_runs "$@"
{
  heading run 'cells across' 'error of the velocity' 'mass drift' order
  rows green velocity_error mass_drift | with_order
} | write_table 'taylor-green'
{
  heading run 'grid; what differs' 'peak of the dissipation' 'its time' 'mass drift'
  rows tgv dissipation_peak dissipation_peak_time mass_drift
} | write_table 'taylor-green 1600'
{
  heading run grid 'rms of u' 'rms of v' 'mass drift'
  rows cavity rms_u rms_v mass_drift
} | write_table 'cavity'
{
  heading run 'cells across' 'error of the velocity' 'mass drift' order
  { rows channel velocity_error mass_drift; rows inlet velocity_error mass_drift; } | with_order
} | write_table 'channel'
