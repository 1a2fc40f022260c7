#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-or-later
# As root, from nothing: makes a bare root of each Debian release, clones this checkout into it as it stands (with
# changes that are not committed), and runs there what the README promises. See usage() below.
# Mounts are made in a namespace of their own: they and what runs on them are gone when a command ends, however it ends.
set -euo pipefail

usage() {
    cat <<'USAGE'
usage: packaging/try_systems.sh [OPTION ...] [RELEASE ...]

Runs ./amontons demo and ./amontons test in bare roots of Debian releases (default: bookworm trixie sid), and prints a
table of versions and results. Roots and the packages they fetched are kept: a second try takes what is there.

  --parts LIST     of demo, test, packages (cpack and lintian); default demo,test
  --tests REGEX    only these tests (ctest -R)
  --user           as an ordinary user with sudo; else as root
  --spaces         the clone below a folder with spaces in its name
  --in COMMAND     runs COMMAND by bash in the clone, in place of the parts; no table
  --arch ARCH      another processor, through qemu-user-static and binfmt_misc (arm64)
  --folder FOLDER  where roots, packages and logs lie; default build/systems
  --fresh          makes the roots anew
  --mirror URL     default http://deb.debian.org/debian
USAGE
}

fail() { printf 'try_systems: %s\n' "$*" >&2; exit 2; }

checkout=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)
folder=$checkout/build/systems
mirror=http://deb.debian.org/debian
arch=$(dpkg --print-architecture)
parts=demo,test tests='' user=root spaces='' inside='' fresh=''
releases=()
while (($#)); do
    case $1 in
    --parts) parts=$2; shift ;;
    --tests) tests=$2; shift ;;
    --user) user=user ;;
    --spaces) spaces=1 ;;
    --in) inside=$2; shift ;;
    --arch) arch=$2; shift ;;
    --folder) mkdir -p "$2"; folder=$(realpath "$2"); shift ;;
    --fresh) fresh=1 ;;
    --mirror) mirror=$2; shift ;;
    -h | --help) usage; exit ;;
    -*) usage >&2; fail "no option $1" ;;
    *) releases+=("$1") ;;
    esac
    shift
done
((${#releases[@]})) || releases=(bookworm trixie sid)
((EUID == 0)) || fail 'only root can make a root'
command -v debootstrap >/dev/null || fail 'debootstrap is missing: apt-get install debootstrap'

# --- a root ---------------------------------------------------------------------------------------

# Runs a command in the root $1 as user $2 in the folder $3: with its own /proc, terminals and shared memory, the packages
# fetched before, and nothing of this session's environment (OPENBLAS_CORETYPE, locale, ...) but the way to the mirror.
enter() {
    local root=$1 who=$2 place=$3 home=/root
    shift 3
    [[ $who == root ]] || home=/home/$who
    # shellcheck disable=SC2016   # expanded inside
    unshare --mount --propagation private --pid --fork --kill-child bash -c '
        root=$1 debs=$2; shift 2
        mount -t proc proc "$root/proc" && mount -t sysfs -o ro sysfs "$root/sys" &&
        mount -t devpts -o newinstance,ptmxmode=666,mode=620,gid=5 devpts "$root/dev/pts" &&
        mount -t tmpfs -o mode=1777 tmpfs "$root/dev/shm" &&
        mount --bind "$debs" "$root/var/cache/apt/archives" || exit 125
        exec "$@"' enter "$root" "$folder/debs/${root##*/}" \
        chroot --userspec="$who" --groups="$who" "$root" env -i -C "$place" HOME="$home" USER="$who" LOGNAME="$who" SHELL=/bin/bash \
        TERM="${TERM-dumb}" PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin \
        ${http_proxy:+http_proxy="$http_proxy"} "$@"
}

# Makes the root $2 of the release $1 where it is not there; it has its name when it is whole.
make_root() {
    local release=$1 root=$2 part=$2.part
    [[ -z $fresh ]] || rm -rf --one-file-system "$root"
    mkdir -p "$folder/debs/${root##*/}/partial"
    [[ ! -d $root ]] || return 0
    rm -rf --one-file-system "$part"
    # debootstrap mounts /proc and /sys, too, and leaves them where it is ended.
    unshare --mount --propagation private --pid --fork --kill-child \
        debootstrap --variant=minbase --arch="$arch" "$release" "$part" "$mirror" >"$root.debootstrap.log" 2>&1 || {
        tail -n 5 "$root.debootstrap.log" >&2
        fail "debootstrap of $release failed"
    }
    # A mirror of some day in the past is good enough.
    printf 'Acquire::Check-Valid-Until "false";\nAcquire::Check-Date "false";\n' >"$part/etc/apt/apt.conf.d/90mirror"
    echo force-unsafe-io >"$part/etc/dpkg/dpkg.cfg.d/unsafe-io"   # packages are on the disk already
    cp /etc/resolv.conf /etc/hosts "$part/etc/"
    mkdir -p "$part/home"
    mv "$part" "$root"
}

# An ordinary user who may become root.
make_user() {
    local root=$1
    enter "$root" root / bash -c '
        id user >/dev/null 2>&1 || useradd --create-home --shell /bin/bash user
        command -v sudo >/dev/null || { apt-get -q update && apt-get -qy install --no-install-recommends sudo; }
        echo "user ALL=(ALL) NOPASSWD: ALL" >/etc/sudoers.d/user' >"$root.user.log" 2>&1 ||
        fail "no user could be made: $root.user.log"
}

# Brings the clone $1 of user $2 in the root $3 to what this checkout has now; git works in folders of its own user alone.
update_clone() {
    local clone=$1 who=$2 root=$3 state
    state=$(git -C "$checkout" stash create)
    [[ -n $state ]] || state=$(git -C "$checkout" rev-parse HEAD)
    mkdir -p "$clone"
    chown -R root: "$clone"
    [[ -d $clone/.git ]] || git init -q "$clone"
    git -C "$checkout" push -q --force "$clone" "$state:refs/heads/tried"
    git -C "$clone" checkout -q --force --detach tried
    chroot "$root" chown -R "$who:" "${clone#"$root"}"
}

# --- what is tried --------------------------------------------------------------------------------

# Runs `$2...` in the clone of $root; its output goes into a file of the part $1. Prints how long it took or that it failed.
try_part() {
    local part=$1 log=$root.$1.log begin=$SECONDS result=ok
    shift
    enter "$root" "$user" "$place" "$@" >"$log" 2>&1 </dev/null || result="FAILED ($?)"
    printf '%s, %d:%02d min' "$result" $(((SECONDS - begin) / 60)) $(((SECONDS - begin) % 60))
}

# Prints the row of one release; $root, $place: its root and the clone's place in it.
try_release() {
    local release=$1 demo=- test=- packages=- versions count
    [[ ,$parts, != *,demo,* ]] || demo=$(try_part demo ./amontons demo)
    if [[ ,$parts, == *,test,* ]]; then
        test=$(try_part test ./amontons test ${tests:+-R "$tests"})
        count=$(sed -nE 's/.* ([0-9]+) tests failed out of ([0-9]+).*/\1 of \2 failed/p' "$root.test.log")
        test="$test, ${count:-no test ran}"
    fi
    if [[ ,$parts, == *,packages,* ]]; then
        # The launcher installs what a build needs; the rest is what makes manual pages and looks at packages.
        try_part packages ./amontons --version >/dev/null
        enter "$root" root / apt-get -qy install --no-install-recommends help2man man-db lintian >"$root.lintian.log" 2>&1 </dev/null ||
            fail "lintian cannot be installed: $root.lintian.log"
        packages=$(try_part packages bash -c 'cmake --preset release && cmake --build build && rm -rf build/packages &&
            cpack --config build/CPackConfig.cmake -B build/packages && lintian --allow-root --fail-on error,warning build/packages/*.deb')
    fi
    # shellcheck disable=SC2016   # expanded by dpkg-query
    versions=$(enter "$root" "$user" "$place" bash -c 'echo gcc $(gcc -dumpfullversion)
        dpkg-query -W -f "Mesa \${source:Upstream-Version}\n" libegl-mesa0
        ./amontons --version | sed -n "s/^built with //p"' 2>&1 | paste -sd, | sed 's/,\([^ ]\)/, \1/g')
    printf '| %s %s | %s | %s | %s | %s |\n' "$release" "$arch" "$versions" "$demo" "$test" "$packages"
}

rows=()
status=0
for release in "${releases[@]}"; do
    root=$folder/$release-$arch
    home=/root
    [[ $user == root ]] || home=/home/$user
    place=$home/${spaces:+a clone/}$(basename "$checkout")
    make_root "$release" "$root"
    [[ $user == root ]] || make_user "$root"
    update_clone "$root$place" "$user" "$root"
    if [[ -n $inside ]]; then
        enter "$root" "$user" "$place" bash -c "$inside" || status=$?
        continue
    fi
    row=$(try_release "$release")
    [[ $row != *FAILED* ]] || status=1
    rows+=("$row")
    printf '%s\n' "$row" >&2
done
[[ -z $inside ]] || exit "$status"
printf '| system | versions | ./amontons demo | ./amontons test | packages |\n|---|---|---|---|---|\n'
printf '%s\n' "${rows[@]}"
echo "logs: $folder/*.log"
exit "$status"
