#!/bin/sh
# Answers stay the same to the byte: runs the commands of tests/same_bytes.txt and compares the SHA-256 of what each prints (JSON
# without `provenance`, which names the build) or writes (the file OUT.*) with the one that stands before it.
#   sh tests/same_bytes.sh SLIPWAY quick|all [--write]
# quick leaves out the diagnoses. --write renews the hashes, after a change that means to change answers: the commit says why.
set -eu
slipway=$(realpath "${1:?usage: sh tests/same_bytes.sh SLIPWAY quick|all [--write]}")
which=${2:?quick or all}
write=${3:-}
tests=$(cd "$(dirname "$0")" && pwd)
list="$tests/same_bytes.txt"
here=$(mktemp -d)
trap 'rm -rf "$here"' EXIT
ln -s "$tests/../data" "$tests/../api" "$here"
cd "$here"

without_provenance() {
  python3 -c '
import json, sys
def without(value):
    if isinstance(value, dict):
        return {key: without(each) for key, each in value.items() if key != "provenance"}
    return [without(each) for each in value] if isinstance(value, list) else value
json.dump(without(json.load(sys.stdin)), sys.stdout, separators=(",", ":"))'
}

# Leaves what a command answers in the file `answer`.
answer_of() {
  rm -f OUT.* answer
  status=0
  # shellcheck disable=SC2086  # the words of the list
  case "$*" in
    "the API document") without_provenance <api/openapi.json >answer ;;
    *OUT.*) "$slipway" $* --data data >said 2>err && cat OUT.* >answer || status=$? ;;
    *) "$slipway" $* --data data --json >said 2>err || status=$?
       without_provenance <said >answer || status=9 ;;
  esac
  case "$status" in
    0 | 3 | 4) ;;  # a drive's verdict is no failure
    *) echo "slipway $*: exit status $status" >&2; cat said err >&2; exit 2 ;;
  esac
}

failures=0
: >new
while read -r hash command; do
  case "$which $command" in
    "quick diagnose"*) found=$hash ;;
    *) answer_of "$command"
       found=$(sha256sum answer | cut -d ' ' -f 1) ;;
  esac
  echo "$found  $command" >>new
  [ "$found" = "$hash" ] || { echo "differs: slipway $command"; failures=$((failures + 1)); }
done <"$list"
if [ "$write" = --write ]; then
  cp new "$list"
  echo "$failures of $(wc -l <new) hashes are new"
elif [ "$failures" -gt 0 ]; then
  echo "$failures of $(wc -l <new) answers are not what they were. Where that was meant: sh tests/same_bytes.sh SLIPWAY all --write, and the reason in the commit"
  exit 1
else
  echo "the same bytes: $(wc -l <new) answers"
fi
