#!/bin/sh
# systemd reads the units that ship without a complaint, and calls what they may do little.
#
# usage: systemd_units_test.sh SLIPWAY SOURCE_DIR
set -eu
slipway="$1"
source="$2"
if ! command -v systemd-analyze >/dev/null; then
  echo "SKIPPED: systemd-analyze is not installed"
  exit 77
fi
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
for unit in slipway.service slipway-worker@.service; do
  # The program is where the package would have put it.
  sed "s|/usr/bin/slipway|$slipway|" "$source/deploy/systemd/$unit" >"$folder/$unit"
  instance=$(echo "$folder/$unit" | sed 's/@\./@1./')
  [ "$instance" = "$folder/$unit" ] || cp "$folder/$unit" "$instance"
  systemd-analyze --man=no --recursive-errors=no verify "$instance" >"$folder/said" 2>&1 || { cat "$folder/said"; exit 1; }
  if [ -s "$folder/said" ]; then
    cat "$folder/said"
    exit 1
  fi
  systemd-analyze security --offline=yes --threshold=20 --no-pager "$instance" >"$folder/said" 2>&1 || { cat "$folder/said"; exit 1; }
  tail -n 1 "$folder/said"
done
# A key that systemd does not know is told.
sed 's/^ProtectHome=/ProtectHomes=/' "$folder/slipway.service" >"$folder/faulty.service"
systemd-analyze --man=no --recursive-errors=no verify "$folder/faulty.service" 2>&1 | grep -q ProtectHomes
