#!/bin/sh
# Starts the operator screen on the simulated lathe with a sample program loaded; does all the set-up it needs.
# The first start begins with a tour of one minute, which any key ends.
# Offsets, counts and settings of it are kept beside your own (turndesk --demo).
# Usage: sh app/start.sh [options of the screen]
set -eu
. "$(dirname -- "$0")/../resources/setup/environment.sh"

# Only what this machine needs: without a display no library of Qt, and on a display those of its kind.
LIBRARIES=""
[ -n "${DISPLAY:-}${WAYLAND_DISPLAY:-}${QT_QPA_PLATFORM:-}" ] && LIBRARIES="$QT_LIBRARIES"
[ -n "${DISPLAY:-}" ] && LIBRARIES="$LIBRARIES $WINDOW_LIBRARIES"
[ -n "${WAYLAND_DISPLAY:-}" ] && LIBRARIES="$LIBRARIES $WAYLAND_LIBRARIES"
# shellcheck disable=SC2046,SC2086
system_packages ca-certificates $LIBRARIES $(python_packages)
find_python
python_environment desk

SAMPLE="$ROOT/resources/programs/bushing.nc"
OFFSETS="$ROOT/resources/programs/offsets.toml"
TURNDESK="$PYTHON_ENV/bin/turndesk"
if [ -n "${DISPLAY:-}${WAYLAND_DISPLAY:-}${QT_QPA_PLATFORM:-}" ]; then
    exec "$TURNDESK" --demo "$@"
fi
say "No display here (neither DISPLAY nor WAYLAND_DISPLAY is set), so no operator screen. Without one, TurnDesk proves and runs programs:"
say "\$ turndesk prove $SAMPLE"
"$TURNDESK" prove "$SAMPLE" --offsets "$OFFSETS"
say "\$ turndesk run $SAMPLE --headless"
"$TURNDESK" run "$SAMPLE" --headless --offsets "$OFFSETS"
say "More: $TURNDESK --help"
