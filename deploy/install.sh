#!/bin/sh
# Installs what building and testing Slipway takes on Debian 12. Run as root; does nothing where all is there.
#   sh deploy/install.sh          what building and serving takes
#   sh deploy/install.sh --test   also what the tests and benchmarks take
set -eu

packages="g++ cmake ninja-build pkg-config ccache
  libeigen3-dev libxsimd-dev libfmt-dev libexpected-dev
  libgdal-dev libproj-dev libompl-dev libboost-dev libceres-dev libsundials-dev
  libcpp-httplib-dev nlohmann-json3-dev libsqlite3-dev libpq-dev libssl-dev zlib1g-dev libcli11-dev libtoml11-dev
  prometheus-cpp-dev libspdlog-dev libarchive-dev"
if [ "${1:-}" = "--test" ]; then
  packages="$packages libgtest-dev libbenchmark-dev libsimbody-dev clang-format curl python3 python3-jsonschema python3-debian python3-license-expression nginx-light openssl chromium gdal-bin
    postgresql"
  # Another Node with an npm of its own does as well, and Debian's npm conflicts with it.
  command -v npm >/dev/null || packages="$packages nodejs npm"
fi

missing=""
for package in $packages; do
  dpkg-query -W -f '${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing="$missing $package"
done
if [ -z "$missing" ]; then
  echo "install: everything is there"
  exit 0
fi
if [ "$(id -u)" != 0 ]; then
  echo "install: these packages are missing and only root can install them:$missing" >&2
  echo "install: run this script as root once, or: apt-get install$missing" >&2
  exit 1
fi
echo "install: fetching$missing"
export DEBIAN_FRONTEND=noninteractive
if ! apt-get update -q || ! apt-get install -q -y --no-install-recommends $missing; then
  echo "install: apt-get failed; see its message above, check the network and the package sources, and run this again" >&2
  exit 1
fi
