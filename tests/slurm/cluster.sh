#!/bin/bash
# A private Slurm cluster of simulated nodes on this machine, for tests. Needs root and the packages slurmctld, slurmd,
# slurm-client and munge; nothing under /etc is changed. Afterwards: export SLURM_CONF=DIR/slurm.conf
#
#   cluster.sh available                 status 0 where it can be started
#   cluster.sh start DIR NODES CPUS
#   cluster.sh lose_node DIR NODE        SIGKILL to its daemon, its steps and what they started
#   cluster.sh lose_controller DIR       SIGKILL to the controller, which is then started again
#   cluster.sh stop DIR
set -euo pipefail

free_ports() {
  python3 - "$1" <<'PYTHON'
import socket
import sys
held = [socket.socket() for _ in range(int(sys.argv[1]))]
for each in held:
    each.bind(("127.0.0.1", 0))
print(*[each.getsockname()[1] for each in held])
PYTHON
}

write_settings() {
  local ports number=1 host
  host=$(hostname -s)
  read -r -a ports <<<"$(free_ports $(($1 + 1)))"
  cat >"$dir/slurm.conf" <<CONF
ClusterName=slipway
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=${ports[0]}
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket=$dir/munge/socket
CredType=cred/munge
StateSaveLocation=$dir/state
SlurmdSpoolDir=$dir/spool/%n
SlurmctldPidFile=$dir/slurmctld.pid
SlurmdPidFile=$dir/slurmd.%n.pid
SlurmctldLogFile=$dir/log/slurmctld.log
SlurmdLogFile=$dir/log/slurmd.%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerParameters=sched_min_interval=10000,batch_sched_delay=0
AccountingStorageType=accounting_storage/none
JobAcctGatherType=jobacct_gather/none
MpiDefault=none
ReturnToService=2
SlurmdParameters=config_overrides
KillWait=2
SlurmdTimeout=10
MessageTimeout=10
CONF
  for port in "${ports[@]:1}"; do
    echo "NodeName=n$number NodeHostname=$host NodeAddr=127.0.0.1 Port=$port CPUs=$2 RealMemory=1000 State=UNKNOWN" >>"$dir/slurm.conf"
    number=$((number + 1))
  done
  echo "PartitionName=main Nodes=n[1-$1] Default=YES MaxTime=INFINITE State=UP" >>"$dir/slurm.conf"
}

start() {
  mkdir -p "$1"
  dir=$(cd "$1" && pwd)
  mkdir -p -m 755 "$dir"/{log,state,spool,munge}
  dd if=/dev/urandom of="$dir/munge/key" bs=128 count=1 status=none
  chmod 600 "$dir/munge/key"
  munged --key-file="$dir/munge/key" --socket="$dir/munge/socket" --pid-file="$dir/munge/pid" --log-file="$dir/munge/log" \
    --seed-file="$dir/munge/seed" --num-threads=2 --force 2>>"$dir/munge/warnings"
  write_settings "$2" "$3"
  export SLURM_CONF=$dir/slurm.conf
  slurmctld -f "$SLURM_CONF"
  for number in $(seq "$2"); do
    mkdir -p "$dir/spool/n$number"
    slurmd -f "$SLURM_CONF" -N "n$number"
  done
  for _ in $(seq 300); do
    [ "$(sinfo -h -t idle -o %D 2>/dev/null)" != "$2" ] || return 0
    sleep 0.1
  done
  sinfo -N -l >&2
  exit 1
}

lose_node() {
  dir=$(cd "$1" && pwd)
  kill -9 "$(cat "$dir/slurmd.$2.pid")"
  # A step's daemon holds the log of its node open.
  for step in $(pgrep -f '^slurmstepd: ' || true); do
    readlink "/proc/$step"/fd/* 2>/dev/null | grep -qx "$dir/log/slurmd.$2.log" || continue
    kill -9 "$step" $(pgrep -P "$step") 2>/dev/null || true
  done
}

lose_controller() {
  dir=$(cd "$1" && pwd)
  kill -9 "$(cat "$dir/slurmctld.pid")"
  sleep 0.5
  SLURM_CONF=$dir/slurm.conf slurmctld -f "$dir/slurm.conf"
}

stop() {
  dir=$(cd "$1" && pwd)
  SLURM_CONF=$dir/slurm.conf scancel --state=RUNNING --state=PENDING -u "$(id -un)" 2>/dev/null || true
  local pids=() file pid
  # A daemon removes its file of the id before it has gone.
  for file in "$dir"/slurmd.*.pid "$dir/slurmctld.pid" "$dir/munge/pid"; do [ ! -s "$file" ] || pids+=("$(cat "$file")"); done
  for pid in "${pids[@]}"; do kill "$pid" 2>/dev/null || true; done
  for _ in $(seq 100); do
    local left=0
    for pid in "${pids[@]}"; do [ ! -e "/proc/$pid" ] || grep -q '^State:.Z' "/proc/$pid/status" 2>/dev/null || left=1; done
    [ "$left" = 1 ] || return 0
    sleep 0.1
  done
  echo "cluster.sh: daemons still run: ${pids[*]}" >&2
}

case "${1:-}" in
  available) [ "$(id -u)" = 0 ] && command -v slurmctld slurmd sbatch munged >/dev/null ;;
  start) start "$2" "$3" "$4" ;;
  lose_node) lose_node "$2" "$3" ;;
  lose_controller) lose_controller "$2" ;;
  stop) stop "$2" ;;
  *) sed -n '2,9p' "$0" >&2; exit 2 ;;
esac
