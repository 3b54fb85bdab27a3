#!/bin/sh
# probes.sh FOLDER PROGRAM SCHEMA: probes of two techniques, read by programs of others. 77: they, or a device, are not there.
set -eu
here=$(dirname "$0") folder=$1 program=$2 schema=$3
sh "$here/run.sh" "$folder" probes.mjs "$schema" || exit $?
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export AFTERGLOW_CACHE="$work/cache"
"$program" list --json | grep -q '"devices": \[\]' && { echo "skipped: no Vulkan device"; exit 77; }
"$program" bake @cornell --gi radiosity:probes=true,texels=4096,rays=64 --quiet --probes "$work/radiosity"
"$program" bake @cornell:light=point --gi lpv:probes=true,dim=16 --quiet --probes "$work/lpv"
sh "$here/run.sh" "$folder" probes.mjs "$schema" "$work/radiosity" "$work/lpv"
