#!/bin/bash
# Keeps pilots in a Slurm cluster for as long as the job store has work: submits an array of them, and another when work is
# left and none of them lives. Slurm's own queue may lose what it has accepted when its controller dies; the jobs are in the
# store, so all that is lost are pilots. They are known by a name, never by Slurm's ids, which it gives out again.
#
#   SLIPWAY_JOBS=postgresql://slipway@db/slipway deploy/slurm/top_up.sh [-n PILOTS] [-s SECONDS] [-k] [-- OPTIONS OF SBATCH]
#
#   -n PILOTS    of one array (default 8)
#   -s SECONDS   between two looks (default 30)
#   -k           goes on when the store is empty, as a daemon does; without it the script ends then
#
# SLIPWAY names the program (default slipway), SLIPWAY_WORKER_OPTIONS what each pilot gets besides: --uploads, --kind, ...
# Passwords belong into ~/.pgpass or a service file, which all nodes see.
set -uo pipefail

pilots=8
every_s=30
keep_on=no
while getopts n:s:k option; do
  case "$option" in
    n) pilots=$OPTARG ;;
    s) every_s=$OPTARG ;;
    k) keep_on=yes ;;
    *) sed -n '2,15p' "$0" >&2; exit 2 ;;
  esac
done
shift $((OPTIND - 1))

: "${SLIPWAY_JOBS:?the address of the job store}"
export SLIPWAY=${SLIPWAY:-slipway} SLIPWAY_JOBS SLIPWAY_WORKER_OPTIONS=${SLIPWAY_WORKER_OPTIONS:-}
here=$(cd "$(dirname "$0")" && pwd)
# The same for every script that looks after the same store, after a restart too.
name=slipway-$(printf %s "$SLIPWAY_JOBS" | sha256sum | cut -c 1-12)
say() { printf '%s %s\n' "$(date -u +%FT%TZ)" "$*" >&2; }

while :; do
  # Neither a store nor a controller that does not answer is an empty one.
  if ! open=$("$SLIPWAY" jobs --jobs "$SLIPWAY_JOBS" --open); then
    say "the store does not answer; looking again in $every_s s"
  elif [ "$open" = 0 ]; then
    [ "$keep_on" = yes ] || { say "no job is left"; exit 0; }
  elif ! living=$(squeue -h -r -n "$name" -t PENDING,CONFIGURING,RUNNING,COMPLETING,SUSPENDED -o %i); then
    say "Slurm does not answer; looking again in $every_s s"
  elif [ -z "$living" ]; then
    if sbatch --parsable -J "$name" --array="0-$((pilots - 1))" "$@" "$here/pilot.sh" >/dev/null; then
      say "$open jobs are open: submitted $pilots pilots as $name"
    else
      say "sbatch refused the pilots; trying again in $every_s s"
    fi
  fi
  sleep "$every_s"
done
