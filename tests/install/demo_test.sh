#!/bin/sh
# The demo plans on its own service, and fails where another service holds its port.
#   demo_test.sh SLIPWAY SOURCE_FOLDER
set -eu
slipway="$1"
source="$2"
folder="$(mktemp -d)"
trap 'kill "${foreign:-}" 2>/dev/null || true; rm -rf "$folder"' EXIT

. "$source/tests/command_expectations.sh"

# A copy of what the demo uses: it writes into the tree that it stands in.
mkdir -p "$folder/tree/tests"
cp -r "$source/deploy" "$folder/tree"
cp "$source/tests/stages.sh" "$folder/tree/tests"

# A foreign service, which answers every question of the demo. Its log is made here: the shell that starts it opens it a
# moment later.
: >"$folder/foreign.log"
"$slipway" serve --port 0 --jobs "" >>"$folder/foreign.log" 2>&1 &
foreign=$!
port=""
for _ in $(seq 100); do
  port="$(sed -n 's|.* on http://127\.0\.0\.1:\([0-9]*\),.*|\1|p' "$folder/foreign.log")"
  [ -z "$port" ] || break
  sleep 0.1
done
[ -n "$port" ] || { echo "the foreign service did not start"; cat "$folder/foreign.log"; exit 1; }

expect 1 env PORT="$port" sh "$folder/tree/deploy/demo.sh" --once --built "$slipway"
holds "is port $port taken" "$folder/err"
kill -0 "$foreign" || { echo "the demo ended the foreign service"; exit 1; }
kill "$foreign"
wait "$foreign" 2>/dev/null || true
# What an earlier demo left in the log is not taken for this one's service.
echo "slipway serves an earlier run on http://127.0.0.1:$port, until interrupted" >"$folder/tree/var/demo.log"
expect 0 env PORT="$port" sh "$folder/tree/deploy/demo.sh" --once --built "$slipway"
holds '^route ' "$folder/out"
holds '^stage  *minutes' "$folder/out"
[ -s "$folder/tree/var/demo-routes.svg" ] || { echo "no picture"; exit 1; }
# A drive that may be commanded and one that may not, with the reasons and a page each.
holds '^GO: every limit holds' "$folder/out"
holds '^GO: this drive may be commanded.$' "$folder/out"
holds '^NO-GO: this drive may not be commanded' "$folder/out"
holds '^NO-GO: immobilised on the mean soils' "$folder/out"
for page in plain slope; do
  grep -q 'class="banner' "$folder/tree/var/demo-check-$page.html" || { echo "no page of the check"; exit 1; }
done
echo "as expected"
