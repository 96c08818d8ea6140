#!/bin/sh
# The bundle that ships is what the sources give, and they agree with the API's description: bundle.sh SOURCE WORK
set -eu
source="$1"
work="$2"
[ -d "$work/node_modules" ] || { echo "the packages are not there"; exit 77; }
cd "$work"
npx openapi-typescript openapi.json -o src/api/types.ts >types.log 2>&1 || { cat types.log; exit 1; }
npm run --silent build
diff -r dist "$source/dashboard/dist" || { echo "dashboard/dist is not what its sources give: run npm run build in dashboard/"; exit 1; }
