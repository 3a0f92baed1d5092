#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Runs the square plate over grids, time steps, held patches, meshes and laws, and writes the table of docs/validation.md. A run that
# exists is kept, so the table can be extended one run at a time: tools/validate_square_plate.sh [NAME...] makes the runs named,
# without names it makes all; with --table it only writes the table from what is there.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
runs=runs/validation
page=docs/validation.md

# name | what it changes | arguments of ./drogue run
matrix() {
  local plate=cases/square_plate svk=cases/square_plate_svk
  cat <<END
base|the case|$plate
grid-48|cells of 1/48 m|$plate --set grid.coarsest=1/12 --set grid.finest=1/48 --set grid.region.0.spacing=1/48 --set grid.region.1.spacing=1/24 --set grid.region.2.spacing=1/12
grid-32|cells of 1/32 m|$plate --set grid.finest=1/32 --set grid.region.0.spacing=1/32 --set grid.region.1.spacing=1/16 --set grid.region.2.spacing=1/8
grid-96|cells of 1/96 m|$plate --set grid.coarsest=1/12 --set grid.finest=1/96 --set grid.region.0.spacing=1/96 --set grid.region.1.spacing=1/48 --set grid.region.2.spacing=1/24
step-half|half the time step and Mach number|$plate --set fluid.lattice_velocity=0.025
step-double|twice the time step and Mach number|$plate --set fluid.lattice_velocity=0.1
patch-16mm|held patch 1/64 m, one element|$plate --set body.plate.hold.0.patch=0.016
patch-63mm|held patch 1/16 m|$plate --set body.plate.hold.0.patch=0.063
mesh-26|26 x 26 hexahedra|$plate --set body.plate.mesh.elements=[26,26,1]
mesh-104|104 x 104 hexahedra|$plate --set body.plate.mesh.elements=[104,104,1]
delta-3|three-point delta|$plate --set body.plate.coupling.delta=peskin3
peskin|plain IB/FE coupling, corners held rigidly, quarter time step|$plate --set body.plate.coupling.scheme=peskin --set fluid.lattice_velocity=0.0125 --set body.plate.hold=[{nodes="corners",patch=0.032,rigid=true}]
hold-rigid|corners held rigidly|$plate --set body.plate.hold=[{nodes="corners",patch=0.032,rigid=true}]
tether-soft|tether 100 times as soft|$plate --set body.plate.hold.0.stiffness=1.5e6
stab-0|numerical Poisson's ratio 0|$plate --set body.plate.material.poisson_stabilisation=0
density-air|fluid and plate of 1.225 kg/m^3|$plate --set fluid.density=1.225 --set body.plate.density=1.225
start-ramp|start from rest, inlet ramp of 0.5 s|$plate --set fluid.initial=rest --set domain.x_min.ramp=0.5
wake|finest cells to x = 2, y and z to 1|$plate --set grid.region.1.spacing=1/64 --set grid.region.1.box=[[-0.25,-1,-1],[2,1,1]]
rigid|all nodes held|$plate --set body.plate.hold=[{nodes="all",rigid=true}]
rigid-wake|all nodes held, finest cells to x = 2, y and z to 1|$plate --set body.plate.hold=[{nodes="all",rigid=true}] --set grid.region.1.spacing=1/64 --set grid.region.1.box=[[-0.25,-1,-1],[2,1,1]]
rigid-96|all nodes held, cells of 1/96 m|$plate --set body.plate.hold=[{nodes="all",rigid=true}] --set grid.coarsest=1/12 --set grid.finest=1/96 --set grid.region.0.spacing=1/96 --set grid.region.1.spacing=1/48 --set grid.region.2.spacing=1/24
wide|domain of 16 x 8 x 8 m|$plate --set domain.lower=[-4,-4,-4] --set domain.upper=[12,4,4]
rigid-wide|all nodes held, domain of 16 x 8 x 8 m|$plate --set domain.lower=[-4,-4,-4] --set domain.upper=[12,4,4] --set body.plate.hold=[{nodes="all",rigid=true}]
svk|Saint Venant-Kirchhoff|$svk
svk-patch-16mm|Saint Venant-Kirchhoff, held patch 1/64 m|$svk --set body.plate.hold.0.patch=0.016
svk-step-half|Saint Venant-Kirchhoff, half the time step|$svk --set fluid.lattice_velocity=0.025
END
}

value() { sed -n "s/^ *\"$2\": \([-0-9.e+]*\|null\|true\|false\),\{0,1\}$/\1/p" "$1" | head -n 1; }

row() {
  local name=$1 what=$2 summary=$runs/$1/summary.json key cells=()
  [[ -f $summary ]] || return 0
  for key in cd_peak cd_peak_time cd_stable cd_stable_drift centre_dx_peak centre_dx_stable; do
    cells+=("$(value "$summary" $key | awk '{ if ($1 == "null" || $1 == "") print "-"; else printf "%.3g\n", $1 }')")
  done
  [[ $(value "$summary" finished) == true ]] || what+=" (ended at $(value "$summary" t_end | awk '{ printf "%.2f", $1 }') s)"
  printf '| `%s` | %s | %s | %s | %s | %s | %s | %s |\n' "$name" "$what" "${cells[@]}"
}

write_table() {
  local table name what arguments
  table=$(mktemp)
  {
    echo '| run | what differs | C_D peak | at [s] | C_D 4 to 8 s | drift | dx peak [m] | dx 4 to 8 s [m] |'
    echo '|---|---|---|---|---|---|---|---|'
    while IFS='|' read -r name what arguments; do row "$name" "$what"; done < <(matrix)
  } >"$table"
  sed -i -e "/<!-- square plate -->/,/<!-- end -->/ { /<!--/! d }" -e "/<!-- square plate -->/r $table" "$page"
  rm "$table"
}

if [[ ${1:-} != --table ]]; then
  while IFS='|' read -r name what arguments; do
    [[ $# -eq 0 || " $* " == *" $name "* ]] || continue
    [[ -f $runs/$name/summary.json ]] && continue
    echo "$name: $what"
    # shellcheck disable=SC2086
    ./drogue run $arguments -o "$runs/$name" --force --quiet </dev/null || echo "  exit code $?"
  done < <(matrix)
fi
write_table
