#!/bin/sh
# abi.sh check|write PROGRAM LIST: compares the binary interface that PROGRAM (abi_list) prints with LIST, or writes LIST.
# New rows may be written at any time. A row that changes or goes breaks programs that were compiled before: it is written only
# if AG_VERSION_MINOR or AG_VERSION_MAJOR has changed too, and with it the soname.
set -eu
how=$1 program=$2 list=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
status=0
"$program" >"$work/now" || status=$?
[ $status -eq 0 ] || exit $status # 77: another platform
soversion() { sed -n '1s/^version \([0-9]*\.[0-9]*\)\..*/\1/p' "$1"; }
rows() { sed 1d "$1" | sort; }
[ -n "$(soversion "$work/now")" ] || { echo "$program prints no version"; exit 1; }

rows "$list" >"$work/old_rows"
rows "$work/now" >"$work/new_rows"
comm -23 "$work/old_rows" "$work/new_rows" >"$work/broken"
if [ -s "$work/broken" ] && [ "$(soversion "$list")" = "$(soversion "$work/now")" ]; then
    echo "The binary interface has changed within version $(soversion "$list"): raise AG_VERSION_MINOR in types.h, or undo this:"
    diff "$work/old_rows" "$work/new_rows" || true
    exit 1
fi
if [ "$how" = write ]; then
    cp "$work/now" "$list"
elif ! diff "$list" "$work/now"; then
    echo "$list is out of date: build the target abi_write"
    exit 1
fi
