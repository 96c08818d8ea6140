#!/bin/sh
# Builds the Debian packages slipway and slipway-service into build/packages. The same tree gives the same bytes.
#   sh deploy/package.sh [REVISION]      what follows the version in their names; 1 without it
#   BUILD=FOLDER sh deploy/package.sh    of a folder that is built already
#   PACKAGES=FOLDER sh deploy/package.sh into another folder
set -eu
cd "$(dirname "$0")/.."
revision="${1:-1}"
packages="${PACKAGES:-build/packages}"
# What else could get into the packages: who packs, where, and when. Their time is that of the last commit.
umask 022
export LC_ALL=C TZ=UTC
: "${SOURCE_DATE_EPOCH:=$(git log -1 --format=%ct || true)}"
[ -n "$SOURCE_DATE_EPOCH" ] || { echo "package: this is no clone of git: give SOURCE_DATE_EPOCH, in seconds" >&2; exit 1; }
export SOURCE_DATE_EPOCH
if [ -z "${BUILD:-}" ]; then
  BUILD=build/release
  sh deploy/install.sh
  cmake --preset release
  cmake --build --preset release
fi
tools="dpkg-dev file binutils python3-debian python3-license-expression"
dpkg-query -W $tools >/dev/null 2>&1 || {
  [ "$(id -u)" = 0 ] || { echo "package: of $tools something is missing, and only root can install it" >&2; exit 1; }
  apt-get install -q -y --no-install-recommends $tools
}
cmake -S . -B "$BUILD" -DSLIPWAY_PACKAGE_REVISION="$revision" >/dev/null
made="$packages/made"
cpack --config "$BUILD/CPackConfig.cmake" -B "$made"
# CPack counts folders into the installed size, which are as large as the file system here has them. Of files alone, as Debian
# counts them, it is the same everywhere.
for package in "$made"/*.deb; do
  dpkg-deb -R "$package" "$made/open"
  size=$(find "$made/open" -name DEBIAN -prune -o -type f -printf '%s\n' | awk '{ kib += int(($1 + 1023) / 1024) } END { print kib }')
  sed -i "s/^Installed-Size: .*/Installed-Size: $size/" "$made/open/DEBIAN/control"
  dpkg-deb --root-owner-group -Zgzip -b "$made/open" "$packages/$(basename "$package")" >/dev/null
  rm -rf "$made/open"
done
rm -rf "$made"
ls -l "$packages"/*.deb
