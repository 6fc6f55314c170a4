# Sourced by app/start.sh and tests/run.sh: brings a fresh Debian or Ubuntu machine to where TurnDesk runs.
# Sets PYTHON_ENV, the folder of the Python environment. Installs only what is missing, and says what.
# shellcheck shell=sh

ROOT=$(CDPATH='' cd -- "$(dirname -- "$0")/.." && pwd)
PYTHON_ENV=${TURNDESK_VENV:-$ROOT/.venv}

# Qt needs these even without a window (offscreen) …
QT_LIBRARIES="libgl1 libegl1 libglib2.0-0 libxkbcommon0 libdbus-1-3 libfontconfig1"
# … and these for a window on an X11 display.
WINDOW_LIBRARIES="libxcb-cursor0 libxkbcommon-x11-0 libxcb-icccm4 libxcb-keysyms1 libxcb-shape0"
# What the stories of tests/stories need besides: a server without a screen, a window manager, hands.
STORY_PACKAGES="xvfb openbox xdotool x11-utils x11-xkb-utils libxtst6"

say() { printf '%s\n' "$*" >&2; }

installed() {
    # Ubuntu 24.04 renamed libglib2.0-0 to libglib2.0-0t64.
    dpkg-query -W -f='${Status}' "$1" 2>/dev/null | grep -q 'ok installed' \
        || dpkg-query -W -f='${Status}' "$1t64" 2>/dev/null | grep -q 'ok installed'
}

as_root() {
    if [ "$(id -u)" = 0 ]; then "$@"; return; fi
    command -v sudo >/dev/null || { say "These packages need root; run as root or install sudo: $missing"; exit 2; }
    sudo "$@"
}

system_packages() {
    command -v apt-get >/dev/null || { say "No apt-get here: see README for the libraries that Qt needs."; return; }
    missing=""
    for package in "$@"; do installed "$package" || missing="$missing $package"; done
    [ -z "$missing" ] && return
    say "Installing system packages:$missing"
    as_root env DEBIAN_FRONTEND=noninteractive apt-get update -qq
    # shellcheck disable=SC2086
    as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends $missing >/dev/null
}

optional_packages() {
    # What a test can be skipped without: where apt has it not, or nobody may install, it is said and left out.
    command -v apt-get >/dev/null || return 0
    for package in "$@"; do
        installed "$package" && continue
        say "Installing $package (tests that need it are skipped without)"
        (missing=$package; as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq \
            --no-install-recommends "$package" >/dev/null) || say "$package cannot be installed here"
    done
}

new_enough() { "$1" -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null; }

usable_python() { new_enough "$1" && "$1" -c 'import ensurepip, venv' 2>/dev/null; }

find_python() {
    for candidate in python3 python3.13 python3.12 python3.11; do
        if usable_python "$candidate"; then PYTHON=$candidate; return; fi
    done
    if command -v python3 >/dev/null && ! new_enough python3; then
        system_packages python3.11 python3.11-venv
        PYTHON=python3.11
    else
        system_packages python3 python3-venv
        PYTHON=python3
    fi
    usable_python "$PYTHON" || { say "TurnDesk needs Python 3.11 or newer with venv; found: $($PYTHON --version)"; exit 2; }
}

# python_environment EXTRAS: makes or renews the environment when the list of packages has changed.
python_environment() {
    stamp="$PYTHON_ENV/.turndesk$1"
    wanted=$(cat "$ROOT/pyproject.toml" "$ROOT/resources/setup/constraints.txt" "$ROOT/setup.cfg" | cksum)
    [ -f "$stamp" ] && [ "$(cat "$stamp")" = "$wanted" ] && return
    say "Setting up Python packages in $PYTHON_ENV"
    if command -v uv >/dev/null; then
        uv venv -q --allow-existing --python "$PYTHON" "$PYTHON_ENV"
        uv pip install -q --python "$PYTHON_ENV/bin/python" -c "$ROOT/resources/setup/constraints.txt" -e "$ROOT$1"
    else
        "$PYTHON" -m venv "$PYTHON_ENV"
        "$PYTHON_ENV/bin/python" -m pip install -q --disable-pip-version-check \
            -c "$ROOT/resources/setup/constraints.txt" -e "$ROOT$1"
    fi
    printf '%s\n' "$wanted" >"$stamp"
}

export OPENBLAS_NUM_THREADS=1
