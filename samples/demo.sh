#!/bin/sh
# The main job on one sample: compress, stats, decompress, verify.  Fails where any command fails.
set -eu

samples=$(cd "$(dirname "$0")" && pwd)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
trap 'exit 1' HUP INT TERM
cp "$samples/trefoil.ply" "$folder"
cd "$folder"

# sh has no pipefail: a failure inside of a pipeline leaves a note.
ebz() {
    command ebz "$@" || echo "ebz $*" >> failed
}

run() {
    printf '\n$ %s\n' "$1"
    eval "$1" || echo "$1" >> failed
    if [ -e failed ]; then
        printf 'demo: failed: %s\n' "$(head -n 1 failed)" >&2
        exit 1
    fi
}

run 'ebz compress trefoil.ply'
run 'wc -c trefoil.ply trefoil.ply.ebz'
run 'ebz stats trefoil.ply.ebz'
run 'ebz decompress -o back.ply trefoil.ply.ebz'
run 'ebz verify --against back.ply trefoil.ply.ebz'
run 'cat trefoil.ply | ebz compress | ebz verify --against trefoil.ply'
run 'ebz decompress < trefoil.ply.ebz | ebz compress | cmp - trefoil.ply.ebz'
run 'ebz compress --max-error 0.001 < trefoil.ply | wc -c'
