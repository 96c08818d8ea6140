#!/bin/sh
# The dashboard in Chromium against a running service; pictures of its states are left in WORK/screenshots.
#   browser.sh SOURCE WORK SLIPWAY
set -eu
[ -d "$2/node_modules" ] || { echo "the packages are not there"; exit 77; }
CHROMIUM="${CHROMIUM:-/usr/bin/chromium}"
[ -x "$CHROMIUM" ] || { echo "there is no Chromium"; exit 77; }
cd "$2"
export CHROMIUM SLIPWAY="$3" SLIPWAY_SOURCE="$1" SCREENSHOTS="$2/screenshots"
# Its files run side by side: much of their time is waiting for what is drawn, or for the clock.
exec node --test --test-concurrency=2 --test-timeout=800000 tests/
