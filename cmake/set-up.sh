#!/usr/bin/env bash
# Installs missing Debian packages, then configures and builds.
# Usage: cmake/set-up.sh [--with LIST]... [PRESET [TARGET...]]   (run from anywhere; ./run, ./test and tests/*/run call it)
# --with LIST: also the packages of cmake/packages-LIST.txt; with `tests` the build has tests, benchmarks, documentation and
# Debian packages. Without PRESET nothing is built.
# If all packages are installed, no privilege is needed.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
lists=("$root/cmake/packages.txt")
tests=OFF
while [ "${1-}" = --with ]; do
  lists+=("$root/cmake/packages-$2.txt")
  [ "$2" != tests ] || tests=ON
  shift 2
done

mapfile -t wanted < <(sed -e 's/#.*//' -e '/^[[:space:]]*$/d' "${lists[@]}")
missing=()
for package in "${wanted[@]}"; do
  status=$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null || true)
  [ "$status" = installed ] || missing+=("$package")
done
if [ ${#missing[@]} -gt 0 ]; then
  if [ "$(id -u)" -ne 0 ]; then
    echo "latcon needs packages that are not installed. Ask an administrator to run:" >&2
    echo "  apt-get install --no-install-recommends ${missing[*]}" >&2
    exit 1
  fi
  echo "Installing ${#missing[@]} packages: ${missing[*]}" >&2
  log=$(mktemp)
  if ! { apt-get update -q && DEBIAN_FRONTEND=noninteractive \
           apt-get install -q -y --no-install-recommends "${missing[@]}"; } >"$log" 2>&1; then
    tail -n 30 "$log" >&2
    exit 1
  fi
  rm -f "$log"
fi

# ParaView's VTK for Python conflicts with the one required by libvtk9-dev, so it is unpacked in the build folder. It is needed
# only for testing and using verification/paraview/, so a failure is not an error.
modules="$root/build/paraview"
if [ $tests = ON ] && [ ! -d "$modules" ]; then
  part=$(mktemp -d)
  wanted="python3-paraview=$(dpkg-query -W -f='${Version}' paraview)"
  if (cd "$part" && { apt-get download -q "$wanted" || { apt-get update -q && apt-get download -q "$wanted"; }; } \
        && dpkg-deb -x python3-paraview_*.deb unpacked) >"$part/log" 2>&1; then
    mkdir -p "$root/build"
    mv "$part/unpacked" "$modules"
  else
    echo "ParaView's Python modules could not be unpacked, so ParaView is not tested:" >&2
    tail -n 3 "$part/log" >&2
  fi
  rm -rf "$part"
fi

[ $# -gt 0 ] || exit 0
preset=$1
shift
build="$root/build/$preset"
cd "$root"
# The build folder of a copied or moved clone still refers to the original folder, and would build there.
cached() { sed -n "s/^$1:[A-Z]*=//p" "$build/CMakeCache.txt" 2>/dev/null || true; }
configure=()
if [ ! -f "$build/build.ninja" ] || [ ! "$(cached CMAKE_HOME_DIRECTORY)" -ef "$root" ]; then
  configure=(--fresh)
  # The presets are for developers.
  [ $tests = ON ] || configure+=(-D BUILD_TESTING=OFF -D LATCON_BENCHMARKS=OFF -D LATCON_DOCS=OFF -D LATCON_PACKAGE=OFF -D LATCON_STEPPING=OFF)
elif [ $tests = ON ] && [ "$(cached BUILD_TESTING)" = OFF ]; then
  configure=(-D BUILD_TESTING=ON -D LATCON_BENCHMARKS=ON -D LATCON_DOCS=ON -D LATCON_PACKAGE=ON -D LATCON_STEPPING=ON)
fi
if [ ${#configure[@]} -gt 0 ]; then
  echo "Configuring ($preset)" >&2
  cmake "${configure[@]}" --preset "$preset" >"$root/configure.log" 2>&1 || { cat "$root/configure.log" >&2; exit 1; }
  rm -f "$root/configure.log"
fi
# As many compilers at a time as there are cores and 2.5 GB of memory for each.
jobs=$(($(sed -n 's/^MemAvailable: *\([0-9]*\) kB/\1/p' /proc/meminfo) / 2500000))
[ "$jobs" -le "$(nproc)" ] || jobs=$(nproc)
# Steps are shown to who looks on, and of a first build; a build in a script says only what went wrong.
[ ${#configure[@]} -gt 0 ] || [ -t 2 ] || quiet=--quiet
cmake --build "$build" --parallel $((jobs > 1 ? jobs : 1)) ${1:+--target "$@"} -- ${quiet-} >&2
