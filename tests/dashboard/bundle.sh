#!/bin/sh
# The bundle that ships is what the sources give, and they agree with the API's description: bundle.sh SOURCE WORK
set -eu
source="$1"
work="$2"
[ -d "$work/node_modules" ] || { echo "the packages are not there"; exit 77; }
cd "$work"
npx openapi-typescript openapi.json -o src/api/types.ts >types.log 2>&1 || { cat types.log; exit 1; }
# What the README asks with curl is a request to whoever generates types with the generator's own settings.
{
  echo 'import type { components } from "./src/api/types";'
  echo "const request: components[\"schemas\"][\"PlanRequest\"] = $(sed -n "s/^curl -s [^ ]*\/v1\/plans .* -d '\(.*\)'$/\1/p" "$source/README.md");"
  echo 'void request;'
} >readme_request.ts
npx tsc --noEmit --strict --skipLibCheck readme_request.ts || { echo "a request of the README does not type-check"; exit 1; }
npm run --silent build
diff -r dist "$source/dashboard/dist" || { echo "dashboard/dist is not what its sources give: run npm run build in dashboard/"; exit 1; }
