#!/bin/sh
# Sets up TurnDesk from the bundle in one file, without a network; the bundle unpacks itself and runs this.
# Usage: sh TURNDESK.run [--headless] [FOLDER]   FOLDER/VERSION gets it, FOLDER/turndesk starts the version set up last
set -eu
ROOT=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
. "$ROOT/environment.sh"
VERSION=$(cat "$ROOT/VERSION")

SCREEN=yes
[ "${1:-}" = "--headless" ] && { SCREEN=""; shift; }
case ${1:-} in -*) say "Usage: sh $BUNDLE [--headless] [FOLDER]"; exit 2 ;; esac
HOUSE=${1:-}
[ -n "$HOUSE" ] || { [ "$(id -u)" = 0 ] && HOUSE=/opt/turndesk; } || HOUSE=$HOME/.local/opt/turndesk
mkdir -p "$HOUSE" 2>/dev/null && [ -w "$HOUSE" ] \
    || { say "$(id -un) may not write to $HOUSE: name another folder behind $BUNDLE, or run it as root."; exit 2; }
HOUSE=$(CDPATH='' cd -- "$HOUSE" && pwd)
PYTHON_ENV=$HOUSE/$VERSION
FROM="--no-index --find-links $ROOT/wheels --only-binary :all:"
# pip is brought along, so Debian's python3-venv is not needed.
PYTHON_PACKAGES="python3"
can_make_environment() { "$1" -c 'import venv'; }
make_environment() {
    "$PYTHON" -m venv --without-pip "$PYTHON_ENV"
    # shellcheck disable=SC2086
    PYTHONPATH=$(echo "$ROOT"/wheels/pip-*.whl) "$PYTHON_ENV/bin/python" -m pip install -q $FROM $LOCKED -r "$ROOT/locked-installer.txt"
}
place() { printf '%s' "$PYTHON_ENV"; }

if [ -d "$ROOT/debs" ]; then
    # Nothing but what was brought along: apt takes of it what is missing here, and would not wait for a network.
    printf 'deb [trusted=yes] file:%s ./\n' "$ROOT/debs" >"$ROOT/sources.list"
    mkdir -p "$ROOT/lists/partial"
    chmod 755 "$ROOT" "$ROOT/debs" "$ROOT/lists" "$ROOT/lists/partial"
    AS_ROOT="sh $BUNDLE"
    APT_OPTIONS="-o Dir::Etc::sourcelist=$ROOT/sources.list -o Dir::Etc::sourceparts=- -o Dir::State::lists=$ROOT/lists -o APT::Sandbox::User=root"
fi
# shellcheck disable=SC2046,SC2086
system_packages $(python_packages) ${SCREEN:+$QT_LIBRARIES $WINDOW_LIBRARIES $WAYLAND_LIBRARIES}
find_python

say "Setting up TurnDesk $VERSION in $PYTHON_ENV"
right_environment || new_environment
# shellcheck disable=SC2086
pip_install $FROM $LOCKED -r "$ROOT/locked-desk.txt" || not_fetched
# shellcheck disable=SC2086
pip_install $FROM --no-deps --force-reinstall "$ROOT"/turndesk-*.whl || not_fetched
cp -R "$ROOT/licences" "$ROOT/licences.md" "$ROOT/sbom.cdx.json" "$PYTHON_ENV/"

RESOURCES=$("$PYTHON_ENV/bin/python" -c 'import os, turndesk; print(os.path.dirname(turndesk.__file__))')/resources
[ ! -d "$RESOURCES/documents" ] || ln -sfn "$RESOURCES/documents" "$PYTHON_ENV/documents"
SAMPLES=$RESOURCES/programs
"$PYTHON_ENV/bin/turndesk" prove "$SAMPLES/bushing.nc" --offsets "$SAMPLES/offsets.toml" >/dev/null \
    || { say "TurnDesk is in place and does not prove its sample; $HOUSE/turndesk was left as it was."; exit 1; }
ln -sfn "$VERSION/bin/turndesk" "$HOUSE/turndesk.new" && mv -f "$HOUSE/turndesk.new" "$HOUSE/turndesk"
say "Ready: $HOUSE/turndesk --demo is the screen on a simulated lathe; $HOUSE/turndesk --help says the rest."
for other in "$HOUSE"/*/bin/turndesk; do
    [ "$other" = "$PYTHON_ENV/bin/turndesk" ] || say "The version before is still there: $other"
done
