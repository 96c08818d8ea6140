#!/bin/sh
# Says which branches of what judges a drive and of the jobs' store no test takes: a table by file, and each line with a branch that is
# missed. Branches that only an exception takes are left out.
#   sh tests/coverage.sh [BUILD_FOLDER]     needs what tests/run.sh installs; gcovr is installed here
set -eu
cd "$(dirname "$0")/.."
command -v gcovr >/dev/null || {
  [ "$(id -u)" = 0 ] || { echo "tests/coverage.sh: gcovr is missing, and only root can install it" >&2; exit 1; }
  apt-get install -q -y --no-install-recommends gcovr
}
build=${1:-build/coverage}
[ -n "${1:-}" ] || cmake --preset coverage >/dev/null
cmake --build "$build" --target sim_tests planner_tests api_tests
find "$build" -name '*.gcda' -delete
"$build/tests/sim/sim_tests" --gtest_brief=1 --gtest_filter='*DriveOutcome*:RuleCatalogue*'
"$build/tests/planner/planner_tests" --gtest_brief=1 --gtest_filter='DriveVerdict*:VerdictWords*'
"$build/tests/api/api_tests" --gtest_brief=1 \
  --gtest_filter='Check*:MustNotGo*:DriveOutcomeTable*:*JobStore*:JobId*:SqliteConnection*:*SimulatedStore*:Postgres*:JobRunner*:Artefact*:FailingStore*'
gcovr --root . --object-directory "$build" --exclude-throw-branches --exclude-unreachable-branches --branches --txt \
  --json "$build/branches.json" --filter 'sim/prediction/(rule_catalogue|drive_outcome)\.cc' \
  --filter 'planner/judge/(drive_verdict|verdict_words)\.cc' \
  --filter 'api/jobs/(artefact_job_store|job|job_admission|job_digest|job_store|open_job_store|postgres_.*|sqlite_.*)\.cc' "$build"
python3 - "$build/branches.json" <<'PYTHON'
import json
import sys

for file in json.load(open(sys.argv[1]))["files"]:
    for line in file["lines"]:
        missed = [k for k, branch in enumerate(line["branches"]) if branch["count"] == 0]
        if missed:
            print(f"{file['file']}:{line['line_number']}: {len(missed)} of {len(line['branches'])} branches are taken by no test")
PYTHON
