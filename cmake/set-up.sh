#!/usr/bin/env bash
# Installs the Debian packages that are missing, then configures and builds.
# Usage: cmake/set-up.sh PRESET [TARGET...]   (run from anywhere; ./run and ./test call it)
# With every package in place nothing is installed and no privilege is needed.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
preset=$1
shift

mapfile -t wanted < <(sed -e 's/#.*//' -e '/^[[:space:]]*$/d' "$root/cmake/packages.txt")
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

build="$root/build/$preset"
cd "$root"
if [ ! -f "$build/build.ninja" ]; then
  echo "Configuring ($preset)" >&2
  cmake --preset "$preset" >"$root/configure.log" 2>&1 || { cat "$root/configure.log" >&2; exit 1; }
  rm -f "$root/configure.log"
fi
# Two compilers at once: a deal.II translation unit takes up to 2 GB.
cmake --build "$build" --parallel 2 ${1:+--target "$@"} >&2
