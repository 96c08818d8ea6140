#!/bin/sh
# Every source file is as clang-format leaves it.
set -eu
formatter="$1"
cd "$2"
find core dem sim steps planner campaign benchmark gap api validation server tests bench -name '*.cc' -o -name '*.h' | sort | xargs "$formatter" --dry-run --Werror
