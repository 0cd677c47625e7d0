#!/usr/bin/env bash
# Build step of meta.yaml: the program and the Python package, without tests.
set -euo pipefail
cmake -S . -B build/conda -G Ninja -D CMAKE_BUILD_TYPE=Release -D CMAKE_INSTALL_PREFIX="$PREFIX" -D CMAKE_PREFIX_PATH="$PREFIX" \
  -D Python3_EXECUTABLE="$PYTHON" -D BUILD_TESTING=OFF -D LATCON_BENCHMARKS=OFF -D LATCON_DOCS=OFF -D LATCON_PACKAGE=OFF
cmake --build build/conda --parallel "${CPU_COUNT:-2}"
cmake --install build/conda --component runtime
"$PYTHON" -m pip install --no-deps --no-build-isolation --no-index ./python
