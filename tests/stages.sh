# Runs the stages of tests/run.sh and measures them; to be sourced. The tables are printed however the script ends.

stage_table=""

say() { printf '\n== %s\n' "$*"; }
fail() { echo "tests/run.sh: $*" >&2; exit 1; }

# Hundredths of a second of the processor, user and system, that the finished children of this shell have used.
processor_ticks() { awk '{ print $16 + $17 }' "/proc/$$/stat"; }

# stage NAME COMMAND...: runs the command and notes its minutes by the clock and of the processor.
stage() {
  stage_name="$1"
  shift
  say "$stage_name"
  stage_began=$(date +%s)
  stage_ticks=$(processor_ticks)
  stage_status=0
  "$@" || stage_status=$?
  stage_table="$stage_table$stage_name|$(($(date +%s) - stage_began))|$(($(processor_ticks) - stage_ticks))
"
  return "$stage_status"
}

print_stages() {
  [ -n "$stage_table" ] || return 0
  printf '%s' "$stage_table" | awk -F'|' '
    BEGIN { printf "\n%-28s %12s %17s\n", "stage", "minutes", "processor minutes" }
    { printf "%-28s %12.1f %17.1f\n", $1, $2 / 60, $3 / 6000; clock += $2; ticks += $3 }
    END { printf "%-28s %12.1f %17.1f\n", "all of them", clock / 60, ticks / 6000 }'
}
trap print_stages EXIT
