#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Shows that the README holds on a machine that has nothing: makes a bare Debian 12 in a folder (debootstrap), copies the
# checkout into it and runs commands there. Needs root and debootstrap.
set -euo pipefail

if (($# < 1)) || ((EUID != 0)); then
  cat >&2 <<'END'
usage (as root): tools/check_bare_system.sh FOLDER [COMMAND ...]

  FOLDER    the bare system; made if it is empty or absent, kept for the next call, remove it for a fresh one
  COMMAND   what to run in the checkout there; by default ./drogue test, then a first moment of the square plate

DEBIAN_MIRROR names the mirror; by default the one that this machine's apt uses.
END
  exit 2
fi

mkdir -p "$1"
root=$(readlink -f "$1")
shift
(($#)) || set -- bash -c './drogue test && ./drogue run cases/square_plate --until 0.05 --force'
cd "$(dirname "$(readlink -f "$0")")/.."

if [[ ! -f $root/etc/debian_version ]]; then
  mirror=${DEBIAN_MIRROR:-$(apt-get indextargets --format '$(RELEASE) $(REPO_URI)' 'Created-By: Packages' |
    awk '$1 == "bookworm" { print $2; exit }')}
  # Without a mirror debootstrap takes Debian's own.
  debootstrap --variant=minbase bookworm "$root" $mirror
fi

mkdir -p "$root/root/drogue"
find "$root/root/drogue" -mindepth 1 -maxdepth 1 ! -name 'build*' ! -name runs -exec rm -rf {} +
tar --create --exclude=./.git --exclude='./build*' --exclude=./runs . | tar --extract --directory "$root/root/drogue"

# The mounts live in a namespace of their own and go with it.
unshare --mount --propagation private bash -c '
  root=$0
  mount --rbind /dev "$root/dev"
  mount --rbind /sys "$root/sys"
  mount -t proc proc "$root/proc"
  cp --dereference /etc/resolv.conf "$root/etc/resolv.conf"
  exec chroot "$root" env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin TERM="$TERM" \
    bash -c "cd /root/drogue && exec \"\$@\"" bash "$@"' "$root" "$@"
