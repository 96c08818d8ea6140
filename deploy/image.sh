#!/bin/sh
# Makes the content of a container: a root file system (tar) with Debian 12 and the packages of build/packages in it.
# Needs root and mmdebstrap. `slipway serve --config /etc/slipway/slipway.toml`, run in it as the user slipway, is the service.
#   sh deploy/image.sh IMAGE.tar
set -eu
image="$1"
cd "$(dirname "$0")/.."
command -v mmdebstrap >/dev/null || apt-get install -q -y --no-install-recommends mmdebstrap
tools=$(ls -t "$PWD"/build/packages/slipway_*.deb 2>/dev/null | head -n 1)
service=$(ls -t "$PWD"/build/packages/slipway-service_*.deb 2>/dev/null | head -n 1)
if [ -z "$tools" ] || [ -z "$service" ]; then
  echo "image: there are no packages in build/packages; sh deploy/package.sh makes them" >&2
  exit 1
fi
# This machine's package sources: they are known to be reached.
sources=$(ls /etc/apt/sources.list.d/debian.sources /etc/apt/sources.list 2>/dev/null | head -n 1)
mmdebstrap --variant=apt --hook-dir=/usr/share/mmdebstrap/hooks/file-mirror-automount \
  --include="$tools" --include="$service" --include=ca-certificates bookworm "$image" "$sources"
