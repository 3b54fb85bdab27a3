#!/bin/sh
# run.sh FOLDER SCRIPT ARGUMENT…: runs a script of this folder by node, with the npm packages of package.json, which FOLDER gets
# from the registry once. 77: node, npm or the packages are not there.
set -eu
here=$(cd "$(dirname "$0")" && pwd) folder=$1 script=$2
shift 2
for program in node npm; do
    command -v $program >/dev/null || { echo "skipped: no $program"; exit 77; }
done
mkdir -p "$folder"
if ! cmp -s "$here/package-lock.json" "$folder/installed.json"; then
    cp "$here/package.json" "$here/package-lock.json" "$folder"
    (cd "$folder" && timeout 120 npm ci --ignore-scripts --no-audit --no-fund --fetch-retries=0 >install.log 2>&1) || {
        echo "skipped: no npm packages"
        exit 77
    }
    cp "$here/package-lock.json" "$folder/installed.json"
fi
cp "$here"/*.mjs "$folder" # modules are looked up beside a script
exec node "$folder/$script" "$@"
