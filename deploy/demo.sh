#!/bin/sh
# From a fresh machine to a plan: installs, builds, serves the shipped terrain, and asks the service over HTTP for routes
# between two places where Curiosity really stopped, and whether two drives may be commanded. Goes on serving until interrupted; --once ends it.
#   sh deploy/demo.sh [--once] [--built PROGRAM]     PORT=8080 by default
# --built takes a slipway that is built already, and installs and builds nothing.
set -eu
cd "$(dirname "$0")/.."
. tests/stages.sh
port="${PORT:-8080}"
once=""
slipway=""
while [ $# -gt 0 ]; do
  case "$1" in
    --once) once=yes ;;
    --built) slipway="${2:?--built needs a program}"; shift ;;
    *) echo "usage: sh deploy/demo.sh [--once] [--built PROGRAM]" >&2; exit 2 ;;
  esac
  shift
done

fail() { echo "demo: $*" >&2; exit 1; }

if [ -z "$slipway" ]; then
  stage "install packages" sh deploy/install.sh ||
    fail "the packages above could not be installed; mend that and run this again"
  stage "configure" cmake --preset release ||
    fail "cmake could not configure; the first message above says what is missing"
  stage "build" cmake --build --preset release || fail "the build broke; the first error above says where"
  slipway=build/release/server/slipway
fi

mkdir -p var
log=var/demo.log
say "starting the service on the shipped terrain"
# The log is emptied here: the shell that starts the service opens it a moment later, and an older log says "serves", too.
: >"$log"
"$slipway" serve --port "$port" --jobs var/demo-jobs.sqlite >>"$log" 2>&1 &
server=$!
end_service() {
  kill "$server" 2>/dev/null || true
  wait "$server" 2>/dev/null || true
}
trap end_service EXIT INT TERM
url="http://127.0.0.1:$port"
# Another service may hold the port and answer in this one's place: only what this one says of itself counts.
tries=0
until grep -q " serves .* on $url," "$log"; do
  kill -0 "$server" 2>/dev/null || { cat "$log" >&2; fail "the service did not start; is port $port taken? PORT=8081 sh deploy/demo.sh uses another"; }
  tries=$((tries + 1))
  [ "$tries" -lt 100 ] || fail "the service did not start within 10 s; its log is $log"
  sleep 0.1
done

say "asking $url for routes from Curiosity's stop of sol 960 to its stop of sol 1073"
status=0
stage "plan" "$slipway" plan --url "$url" --terrain gale --rover msl-class --start 8142688.55,-276614.34 \
  --goal 8142528.03,-276775.79 --map var/demo-routes.svg || status=$?
echo
case "$status" in
  0) echo "The best route is GO." ;;
  3) [ -s var/demo-routes.svg ] || fail "there is no plan"
     echo "No route is GO: the best one breaks a limit, for the reasons above." ;;
  4) echo "The best route is UNKNOWN: what is known of the ground does not decide, for the reasons above." ;;
  *) fail "there is no plan" ;;
esac
echo "The routes on the hillshade: var/demo-routes.svg"

# check NAME PATH...: what the service says of one drive, with the page to take into the meeting.
check() {
  name="$1"
  shift
  status=0
  echo
  say "asking $url whether a drive may be commanded: $name"
  stage "check: $name" "$slipway" check --url "$url" --terrain gale --rover msl-class --path "$@" --rules every_5_m \
    --report "var/demo-check-$name.html" || status=$?
  case "$status" in
    0) echo "GO: this drive may be commanded." ;;
    3) echo "NO-GO: this drive may not be commanded, for the reasons above." ;;
    4) echo "UNKNOWN: the draws of the ground do not decide, for the reasons above." ;;
    *) fail "there is no answer to the check" ;;
  esac
  echo "One page for a meeting: var/demo-check-$name.html"
}
check plain 8142566,-276711 8142566,-276696
check slope 8142579.7,-276648.7 8142578,-276680

print_stages
if [ -n "$once" ]; then
  exit 0
fi
echo
echo "Serving on $url until interrupted (Ctrl-C). Try: curl $url/v1/terrains"
wait "$server"
