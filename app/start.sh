#!/bin/sh
# Starts the operator screen on the simulated lathe with a sample program loaded; does all the set-up it needs.
# Usage: sh app/start.sh [options of turndesk]
set -eu
. "$(dirname -- "$0")/../resources/setup/environment.sh"

# shellcheck disable=SC2086
system_packages ca-certificates $QT_LIBRARIES $WINDOW_LIBRARIES
find_python
python_environment ""

SAMPLE="$ROOT/resources/programs/bushing.nc"
OFFSETS="$ROOT/resources/programs/offsets.toml"
TURNDESK="$PYTHON_ENV/bin/turndesk"
if [ -n "${DISPLAY:-}${WAYLAND_DISPLAY:-}${QT_QPA_PLATFORM:-}" ]; then
    exec "$TURNDESK" --program "$SAMPLE" --offsets "$OFFSETS" "$@"
fi
say "No display here (neither DISPLAY nor WAYLAND_DISPLAY is set), so no operator screen. Without one, TurnDesk proves and runs programs:"
say "\$ turndesk prove $SAMPLE"
"$TURNDESK" prove "$SAMPLE" --offsets "$OFFSETS"
say "\$ turndesk run $SAMPLE --headless"
"$TURNDESK" run "$SAMPLE" --headless --offsets "$OFFSETS"
say "More: $TURNDESK --help"
