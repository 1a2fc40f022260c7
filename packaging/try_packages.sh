#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-or-later
# As root: installs the packages that `cpack` made into a bare Debian 12 with what they depend on, uses them there as an
# ordinary user (program, C program, Python script), and removes them again. What it prints is the transcript.
#
#     cmake --build build && cpack --config build/CPackConfig.cmake -B build/packages
#     packaging/try_packages.sh build/packages [MIRROR]
set -eu
packages=$(realpath "$1")
mirror=${2-http://deb.debian.org/debian}
root=$(mktemp -d /var/tmp/amontons-root-XXXXXX)
trap 'umount "$root/dev/pts" "$root/proc" 2>/dev/null || true; rm -rf --one-file-system "$root"' EXIT
chmod 755 "$root"
set -x

debootstrap --variant=minbase bookworm "$root" "$mirror" >"$root.log" 2>&1 || { tail "$root.log"; exit 1; }
rm "$root.log"
mount -t proc proc "$root/proc"
mount -t devpts devpts "$root/dev/pts"
[[ ! -d /etc/apt/apt.conf.d ]] || cp -n /etc/apt/apt.conf.d/*proxy* "$root/etc/apt/apt.conf.d/" 2>/dev/null || true
cp /etc/resolv.conf "$root/etc/"
cp "$packages"/*.deb "$root/var/tmp/"
inside() { env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive ${http_proxy:+http_proxy="$http_proxy"} chroot "$root" "$@"; }
as_user() { env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/srv/user LC_ALL=C.UTF-8 chroot --userspec=user "$root" bash -c "cd && $1"; }

inside apt-get -q update | tail -n 1
inside bash -c 'apt-get -q -y install --no-install-recommends /var/tmp/*.deb gcc libc6-dev make cmake pkg-config' | grep -E '^(The following|[0-9]+ upgraded|Setting up (amontons|libamontons|python3-amontons))'
inside useradd --create-home --home-dir /srv/user user

as_user 'amontons --version'
as_user 'time amontons run /usr/share/amontons/validation/paper/fig1.yaml -o fig1 && ls fig1 fig1/figures'
# shellcheck disable=SC2016   # to be expanded inside
as_user 'cc /usr/share/doc/amontons/examples/pressures.c $(pkg-config --cflags --libs amontons) -o by-pkg-config &&
    ./by-pkg-config /usr/share/amontons/validation/paper/fig1.yaml mesh.set.nx=20 mesh.set.nz=20'
as_user 'cmake -S /usr/share/doc/amontons/examples -B example >/dev/null && cmake --build example >/dev/null &&
    example/pressures /usr/share/amontons/validation/paper/fig1.yaml mesh.set.nx=20 mesh.set.nz=20'
as_user 'python3 -c "
import amontons
result = amontons.run(amontons.data_folder() / \"validation/paper/fig1.yaml\", {\"mesh.set.nx\": 20, \"mesh.set.nz\": 20})
print(result.mu_M, result.history.slip_rate.shape)"'

inside apt-get -q -y purge amontons libamontons-dev python3-amontons | grep -E '^(Removing|Purging)'
: "what is left of it:"
inside find /usr /etc /var/lib/dpkg/info -name '*amontons*' -print
