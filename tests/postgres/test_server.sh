#!/bin/bash
# The one PostgreSQL server of a run of ctest: test_server.sh begin|end FILE. FILE names its folder meanwhile; there is none
# where the server's programs are not installed, and tests that want it say that they are skipped.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
file=$2

case "$1" in
  begin)
    rm -f "$file"
    if ! "$here/server.sh" available; then
      echo "SKIPPED: no PostgreSQL server is installed (deploy/install.sh --test installs it)"
      exit 0
    fi
    folder=$(mktemp -d /tmp/slipway-pg-XXXXXX)
    "$here/server.sh" start "$folder"
    "$here/server.sh" guard "$folder" "$PPID"
    echo "$folder" >"$file"
    ;;
  end)
    [ -s "$file" ] || exit 0
    folder=$(cat "$file")
    rm -f "$file"
    "$here/server.sh" stop "$folder" immediate
    rm -rf "$folder"
    ;;
esac
