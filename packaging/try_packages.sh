#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-or-later
# As root: makes the Debian packages of a build, installs them into a bare root of this release with what they depend on, uses them
# there as an ordinary user (program, C program, Python script), and removes them again. What it prints is the transcript:
# packaging/transcript.txt is one. # begins what root does there, $ what the user does.
#
#     cmake --build build
#     packaging/try_packages.sh build [RELEASE [MIRROR]] >packaging/transcript.txt
set -eu
build=$(realpath "$1")
# shellcheck source=/dev/null
release=${2-$(. /etc/os-release && echo "$VERSION_CODENAME")}
mirror=${3-http://deb.debian.org/debian}
root=$(mktemp -d /var/tmp/amontons-root-XXXXXX)
trap 'umount "$root/dev/pts" "$root/proc" 2>/dev/null || true; rm -rf --one-file-system "$root"' EXIT
chmod 755 "$root"

echo 'In the checkout, after cmake --build build'
printf '\n$ cpack --config build/CPackConfig.cmake -B build/packages\n'
rm -rf "$build/packages"
cpack --config "$build/CPackConfig.cmake" -B "$build/packages" | sed -n 's/^.*- package: .*\/\(.*\) generated.*/\1/p'
if command -v lintian >/dev/null; then
    printf '\n$ lintian build/packages/*.deb\n'
    lintian --allow-root "$build"/packages/*.deb 2>/dev/null
fi

clean=(env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive
       ${http_proxy:+http_proxy="$http_proxy"})
as_root() { printf '\n# %s\n' "$1"; "${clean[@]}" HOME=/root chroot "$root" bash -c "cd && $1"; }
as_user() { printf '\n$ %s\n' "$1"; "${clean[@]}" HOME=/srv/user chroot --userspec=user "$root" bash -c "cd && $1" 2>&1; }

debootstrap --variant=minbase "$release" "$root" "$mirror" >"$root.log" 2>&1 || { tail "$root.log" >&2; exit 1; }
rm "$root.log"
mount -t proc proc "$root/proc"
mount -t devpts devpts "$root/dev/pts"
[[ ! -d /etc/apt/apt.conf.d ]] || cp -n /etc/apt/apt.conf.d/*proxy* "$root/etc/apt/apt.conf.d/" 2>/dev/null || true
cp /etc/resolv.conf "$root/etc/"
cp "$build"/packages/*.deb "$root/srv/"
"${clean[@]}" chroot "$root" apt-get -q update >/dev/null

printf '\nIn a bare root (debootstrap --variant=minbase %s), the packages in /srv\n' "$release"
as_root 'cat /etc/debian_version; ls -sh /srv'
as_root 'apt-get -qq -y install --no-install-recommends /srv/*.deb gcc libc6-dev make cmake pkg-config >log 2>&1;
  grep "Setting up.*amontons" log; grep -c "^Setting up" log'
as_root 'useradd --create-home --home-dir /srv/user user'

as_user 'amontons --version'
as_user 'amontons run /usr/share/amontons/validation/paper/fig1.yaml -o fig1 --quiet && ls fig1 fig1/figures'
as_user 'amontons info fig1 | head -n 8'
# shellcheck disable=SC2016   # to be expanded inside
as_user 'cc /usr/share/doc/amontons/examples/pressures.c $(pkg-config --cflags --libs amontons) -o by-pkg-config
  ./by-pkg-config /usr/share/amontons/validation/paper/fig1.yaml mesh.set.nx=20 mesh.set.nz=20'
as_user 'cmake -S /usr/share/doc/amontons/examples -B example >log && cmake --build example >>log
  example/pressures /usr/share/amontons/validation/paper/fig1.yaml mesh.set.nx=20 mesh.set.nz=20'
as_user 'cat >first.py <<END
import amontons

scene = amontons.data_folder() / "validation/paper/fig1.yaml"
result = amontons.run(scene, {"mesh.set.nx": 20, "mesh.set.nz": 20})
print(result.mu_M, result.history.slip_rate.shape)
END
python3 first.py'
as_user 'ls /usr/share/man/man1 | grep amontons'

as_root 'apt-get -qq -y purge amontons libamontons-dev python3-amontons >log 2>&1; grep -E "^(Removing|Purging)" log'
as_root 'find /usr /etc /var/lib/dpkg/info -name "*amontons*"; echo "(end of what is left of it)"'
