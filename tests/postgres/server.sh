#!/bin/bash
# Private PostgreSQL servers for tests, on free ports of the loopback interface. Works as an ordinary user, and as root, who
# becomes the package's user postgres for it. The connection is trusted: for tests alone.
#
#   server.sh available                 status 0 where the server's programs are installed
#   server.sh start DIR                 makes and starts a server in DIR, or starts it again; prints its address
#   server.sh standby PRIMARY_DIR DIR   makes a streaming standby and lets every commit wait for it; prints its address
#   server.sh promote DIR               makes the standby a primary
#   server.sh stop DIR [fast|immediate|kill|crash]
#       kill ends the postmaster alone by SIGKILL, crash all its processes, as the loss of the machine does
#   server.sh guard DIR PID             goes into the background, and stops the server when the process PID has gone
#
# DIR should be short: the path of the socket in it has at most 107 bytes.
set -euo pipefail

bin=$(ls -d /usr/lib/postgresql/*/bin 2>/dev/null | sort -V | tail -1 || true)
[ -x "$bin/initdb" ] || bin=$(pg_config --bindir 2>/dev/null || true)
as=()
[ "$(id -u)" != 0 ] || as=(setpriv --reuid postgres --regid postgres --init-groups --inh-caps=-all)
user=slipway

free_port() { python3 -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0)); print(s.getsockname()[1])'; }
address() { echo "postgresql://$user@127.0.0.1:$(cat "$1/port")/slipway"; }
query() { psql -X -q -A -t -d "$1" -c "$2"; }

make_folder() {
  mkdir -p "$1"
  dir=$(cd "$1" && pwd)
  # Postgres must be able to go into it, whoever made it.
  [ "$(id -u)" != 0 ] || chown postgres:postgres "$dir"
  cd "$dir"
}

run_server() {
  # A cluster that runs already, or whose killed postmaster has left processes, does not start.
  if ! "${as[@]}" "$bin/pg_ctl" -D "$dir/data" status >/dev/null 2>&1; then
    if ! "${as[@]}" "$bin/pg_ctl" -D "$dir/data" -o "-p $port" -l "$dir/server.log" -w -t 60 start >"$dir/pg_ctl.log" 2>&1 </dev/null; then
      cat "$dir/pg_ctl.log" >&2
      tail -n 20 "$dir/server.log" >&2
      exit 1
    fi
  fi
  echo "$port" >"$dir/port"
}

start() {
  make_folder "$1"
  port=$(cat "$dir/port" 2>/dev/null || free_port)
  if [ ! -s "$dir/data/PG_VERSION" ]; then
    # --no-sync: only initdb itself does not wait for the disk; the server does.
    "${as[@]}" "$bin/initdb" -D "$dir/data" -U "$user" -A trust -E UTF8 --locale=C.UTF-8 --no-sync --no-instructions \
      >"$dir/initdb.log" 2>&1 || { cat "$dir/initdb.log" >&2; exit 1; }
    "${as[@]}" mkdir -m 700 "$dir/s"
    "${as[@]}" tee -a "$dir/data/postgresql.conf" >/dev/null <<CONF
listen_addresses = '127.0.0.1'
unix_socket_directories = '$dir/s'
max_connections = 200
shared_buffers = 64MB
fsync = on
synchronous_commit = on
recovery_init_sync_method = syncfs
wal_keep_size = 128MB
log_min_messages = fatal
CONF
  fi
  run_server
  local system="postgresql://$user@127.0.0.1:$port/postgres"
  [ -n "$(query "$system" "SELECT 1 FROM pg_database WHERE datname = 'slipway'")" ] || query "$system" "CREATE DATABASE slipway"
  address "$dir"
}

standby() {
  local primary
  primary=$(cd "$1" && pwd)
  make_folder "$2"
  port=$(free_port)
  "${as[@]}" mkdir -m 700 "$dir/s"
  "${as[@]}" "$bin/pg_basebackup" -d "$(address "$primary")?application_name=standby1" -D "$dir/data" -R -X stream -c fast --no-sync
  # The copy has the primary's settings in it.
  "${as[@]}" tee -a "$dir/data/postgresql.auto.conf" >/dev/null <<CONF
unix_socket_directories = '$dir/s'
synchronous_standby_names = ''
CONF
  run_server
  query "$(address "$primary")" "ALTER SYSTEM SET synchronous_standby_names = 'standby1'"
  query "$(address "$primary")" "SELECT pg_reload_conf()" >/dev/null
  for _ in $(seq 100); do
    if [ "$(query "$(address "$primary")" "SELECT sync_state FROM pg_stat_replication")" = sync ]; then
      address "$dir"
      return
    fi
    sleep 0.1
  done
  echo "server.sh: the standby does not become synchronous" >&2
  exit 1
}

stop() {
  local dir mode pid children alive
  dir=$(cd "$1" && pwd)
  mode=${2:-fast}
  cd "$dir"
  if [ "$mode" != kill ] && [ "$mode" != crash ]; then
    "${as[@]}" "$bin/pg_ctl" -D "$dir/data" -m "$mode" -w -t 30 stop >/dev/null
    return
  fi
  pid=$(head -1 "$dir/data/postmaster.pid")
  children=$(pgrep -P "$pid" || true)
  if [ "$mode" = crash ]; then kill -9 "$pid" $children 2>/dev/null || true; else kill -9 "$pid"; fi
  for _ in $(seq 200); do
    alive=0
    for child in $children; do [ ! -e "/proc/$child" ] || alive=1; done
    [ "$alive" = 1 ] || return 0
    sleep 0.05
  done
  echo "server.sh: processes of the killed postmaster still run: $children" >&2
  exit 1
}

guard() {
  local dir
  dir=$(cd "$1" && pwd)
  (
    while [ -e "/proc/$2" ]; do sleep 1; done
    stop "$dir" immediate 2>/dev/null || true
    rm -rf "$dir"
  ) </dev/null >/dev/null 2>&1 &
}

case "${1:-}" in
  available) [ -x "$bin/initdb" ] ;;
  start) start "$2" ;;
  standby) standby "$2" "$3" ;;
  promote) query "$(address "$2")" "SELECT pg_promote(true, 30)" >/dev/null ;;
  stop) stop "$2" "${3:-fast}" ;;
  guard) guard "$2" "$3" ;;
  *)
    sed -n '2,14p' "$0" >&2
    exit 2
    ;;
esac
