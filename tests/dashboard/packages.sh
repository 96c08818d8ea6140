#!/bin/sh
# The dashboard's sources with the packages of its lock file, in a folder of the tests' own: packages.sh SOURCE WORK
set -eu
source="$1"
work="$2"
command -v npm >/dev/null || { echo "there is no npm"; exit 77; }
mkdir -p "$work"
# The packages stay where the lock file is the same.
if [ -d "$work/node_modules" ] && cmp -s "$source/dashboard/package-lock.json" "$work/package-lock.json"; then fresh=no; else fresh=yes; fi
for name in src tests build dist; do rm -rf "${work:?}/$name"; done
(cd "$source/dashboard" && cp -r src tests build index.html package.json package-lock.json tsconfig.json vite.config.ts .npmrc "$work")
cp "$source/api/openapi.json" "$work/openapi.json"
[ "$fresh" = no ] && exit 0
rm -rf "$work/node_modules"
cd "$work"
if npm ci --no-progress >npm.log 2>&1; then exit 0; fi
cat npm.log
rm -rf node_modules
grep -qE 'ENOTFOUND|ECONNREFUSED|ETIMEDOUT|EAI_AGAIN|ENETUNREACH' npm.log && { echo "npm's registry can't be reached"; exit 77; }
exit 1
