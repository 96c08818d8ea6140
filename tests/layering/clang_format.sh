#!/bin/sh
# Every source file is as clang-format leaves it.
set -eu
formatter="$1"
cd "$2"
find core dem sim steps planner campaign gap api server research tests bench -name "*.cc" -o -name "*.h" | sort | xargs -P 2 -n 400 "$formatter" --dry-run --Werror
