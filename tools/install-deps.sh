#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Installs the Debian 12 packages of the tiers that are named, those that are missing only:
#   run     building, running and testing
#   mesh    gmsh, for cases that bring a .geo
#   plot    gnuplot, for figures
#   render  VTK and a virtual display, for pictures
# Works as root or through sudo; where neither is possible it prints the line to run and exits 2.
set -euo pipefail

declare -A tiers=(
  [run]="g++ cmake make ninja-build libopenmpi-dev libp4est-dev libhdf5-dev libeigen3-dev libmuparser-dev
         libspdlog-dev libfmt-dev libcli11-dev libtomlplusplus-dev nlohmann-json3-dev libgtest-dev libbenchmark-dev"
  [mesh]="gmsh"
  [plot]="gnuplot-nox"
  [render]="libvtk9-dev xvfb xauth"
)

wanted=()
for tier in "$@"; do
  [[ -n ${tiers[$tier]:-} ]] || { echo "install-deps: unknown tier '$tier', expected run, mesh, plot or render" >&2; exit 2; }
  wanted+=(${tiers[$tier]})
done
((${#wanted[@]})) || { echo "usage: $0 run|mesh|plot|render ..." >&2; exit 2; }

if ! command -v apt-get >/dev/null; then
  echo "install-deps: no apt-get here; what is missing must come from elsewhere: ${wanted[*]}" >&2
  exit 0
fi

installed=$(dpkg-query --show --showformat ' ${db:Status-Status}:${Package} ' "${wanted[@]}" 2>/dev/null || true)
missing=()
for package in "${wanted[@]}"; do
  [[ $installed == *" installed:$package "* ]] || missing+=("$package")
done
((${#missing[@]})) || exit 0

if ((EUID == 0)); then
  as_root=(env)
elif sudo -n true 2>/dev/null || { command -v sudo >/dev/null && [[ -t 0 ]]; }; then
  as_root=(sudo env)
else
  echo "Drogue needs Debian packages that only root can install. Run this line, then try again:" >&2
  echo "  apt-get update && apt-get install --no-install-recommends ${missing[*]}" >&2
  exit 2
fi

log=$(mktemp)
trap 'rm -f "$log"' EXIT
apt() {
  "${as_root[@]}" DEBIAN_FRONTEND=noninteractive apt-get -qq -y -o Dpkg::Use-Pty=0 -o DPkg::Lock::Timeout=600 "$@" \
    </dev/null >>"$log" 2>&1
}
install() { apt install --no-install-recommends "${missing[@]}"; }

echo "drogue: installing Debian packages: ${missing[*]}" >&2
# Package lists that are absent or out of date make the first try fail.
install || { apt update && install; } || {
  tail -n 20 "$log" >&2
  echo "install-deps: apt-get failed; its last lines are above" >&2
  exit 1
}
