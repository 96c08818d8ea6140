#!/bin/sh
# The same tree gives the same packages, to the byte: built in two folders, of which the second is a copy of the tree elsewhere that
# the compiler itself reads and not its cache; packed at another time, in another zone and language, by somebody whose files are nobody
# else's business, and on another kind of file system, which lists its files in another order.
#
# usage: same_package_test.sh SOURCE_DIR BUILD_DIR
set -eu
source="$1"
build="$2"
folder=$(mktemp -d)
other=$(mktemp -d /dev/shm/slipway-XXXXXX)
trap 'rm -rf "$folder" "$other"' EXIT
SOURCE_DATE_EPOCH=$(git -C "$source" log -1 --format=%ct)
export SOURCE_DATE_EPOCH

PACKAGES="$folder/first" BUILD="$build" sh "$source/deploy/package.sh"

umask 077
copy="$folder/copy"
mkdir "$copy"
cd "$source"
git ls-files -z --cached --others --exclude-standard | xargs -0 cp --parents -d -t "$copy"
cmake --preset check -S "$copy" -B "$copy/build/other" >/dev/null
CCACHE_DISABLE=1 cmake --build "$copy/build/other" --target slipway
TZ=Asia/Kathmandu LC_ALL=C.UTF-8 PACKAGES="$other" BUILD=build/other sh "$copy/deploy/package.sh"

for package in "$folder"/first/*.deb; do
  cmp "$package" "$other/$(basename "$package")"
done
dpkg-deb -c "$(echo "$other"/slipway_*.deb)" | grep -q ' ./usr/share/doc/slipway/slipway.spdx.json$'
