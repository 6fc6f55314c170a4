#!/bin/sh
# TurnDesk @VERSION@ for @MACHINE@, set up without a network: sh @NAME@ [--headless] [FOLDER]
# sh @NAME@ --unpack FOLDER only unpacks it.
set -eu
BUNDLE=$0
export BUNDLE
stop() { printf '%s\n' "$*" >&2; exit 2; }
packed() { tail -c +@START@ "$BUNDLE"; }
[ "$(uname -m)" = @MACHINE@ ] \
    || stop "$BUNDLE is for @MACHINE@, and this computer is $(uname -m): it needs the bundle that is made for it."
[ "$(packed | sha256sum | cut -d ' ' -f 1)" = @SHA256@ ] \
    || stop "$BUNDLE is damaged, or was not copied to its end: copy it again from where it was made."
if [ "${1:-}" = --unpack ]; then
    [ -d "${2:-}" ] || stop "--unpack needs a folder that is there."
    packed | tar -x -C "$2" || stop "No room in $2: it needs @MEGABYTES@ MB."
    exit 0
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
trap 'exit 130' HUP INT TERM
packed | tar -x -C "$work" || stop "No room to unpack in $work: it needs @MEGABYTES@ MB; name a larger folder in TMPDIR."
sh "$work/install.sh" "$@"
exit 0
