#!/bin/sh
# Builds the Debian packages slipway and slipway-service into build/packages.
#   sh deploy/package.sh [REVISION]      what follows the version in their names; 1 without it
#   BUILD=FOLDER sh deploy/package.sh    of a folder that is built already
set -eu
cd "$(dirname "$0")/.."
revision="${1:-1}"
if [ -z "${BUILD:-}" ]; then
  BUILD=build/release
  sh deploy/install.sh
  cmake --preset release
  cmake --build --preset release
fi
command -v dpkg-shlibdeps >/dev/null || {
  [ "$(id -u)" = 0 ] || { echo "package: dpkg-dev is missing, and only root can install it" >&2; exit 1; }
  apt-get install -q -y --no-install-recommends dpkg-dev file
}
cmake -S . -B "$BUILD" -DSLIPWAY_PACKAGE_REVISION="$revision" >/dev/null
cpack --config "$BUILD/CPackConfig.cmake" -B build/packages
rm -rf build/packages/_CPack_Packages
ls -l build/packages/*.deb
