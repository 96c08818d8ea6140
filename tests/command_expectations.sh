# For tests of commands, sourced by them: needs $folder, for what the command prints.

# expect STATUS COMMAND...: it ends with this status; its output is then in $folder/out and $folder/err.
expect() {
  wanted="$1"
  shift
  status=0
  "$@" >"$folder/out" 2>"$folder/err" || status=$?
  case "$wanted:$status" in
    verdict:0 | verdict:3 | verdict:4) return 0 ;;  # a drive or a plan was answered, whatever its verdict
  esac
  if [ "$status" != "$wanted" ]; then
    echo "exit status $status, expected $wanted, of: $*"
    cat "$folder/err"
    exit 1
  fi
}
# holds PATTERN FILE
holds() { grep -q -- "$1" "$2" || { echo "\"$1\" is not in $2:"; cat "$2"; exit 1; }; }
