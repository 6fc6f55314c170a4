# Sourced by app/start.sh, tests/run.sh and install.sh: brings a fresh Debian or Ubuntu machine to where TurnDesk runs.
# Sets PYTHON_ENV, the folder of the Python environment. Installs only what is missing, and says what.
# shellcheck shell=sh

ROOT=${ROOT:-$(CDPATH='' cd -- "$(dirname -- "$0")/.." && pwd)}
PYTHON_ENV=${TURNDESK_VENV:-$ROOT/.venv}
case $PYTHON_ENV in -*) PYTHON_ENV=./$PYTHON_ENV ;; esac  # a folder, never an option of a program

# Qt needs these even without a window (offscreen) …
QT_LIBRARIES="libgl1 libegl1 libglib2.0-0 libxkbcommon0 libdbus-1-3 libfontconfig1 libgssapi-krb5-2"
# … and these for a window on an X11 display.
WINDOW_LIBRARIES="libxcb-cursor0 libxkbcommon-x11-0 libxcb-icccm4 libxcb-keysyms1 libxcb-shape0 libxi6"
# … and these for one on a Wayland display.
WAYLAND_LIBRARIES="libwayland-client0 libwayland-cursor0 libwayland-egl1"
# What the stories of tests/stories need besides: a server without a screen, a window manager, hands.
STORY_PACKAGES="xvfb openbox xdotool x11-utils x11-xkb-utils libxtst6"
# How apt-get is to be asked besides; install.sh leads it to the packages that it brings along.
APT_OPTIONS=""

say() { printf '%s\n' "$*" >&2; }

# patiently WHAT COMMAND …: runs the command, keeps what it says in said (no disk is needed), and shows WHAT every 8 s.
patiently() {
    what=$1
    shift
    (
        trap 'kill "$!"; exit' TERM
        seconds=0
        while sleep 8 & wait "$!" && kill -0 "$$" 2>/dev/null; do  # Ctrl+C ends the shell, not this
            seconds=$((seconds + 8))
            say "$what: $seconds s"
        done
    ) &
    sign=$!
    said=$("$@" 2>&1) && status=0 || status=$?
    kill "$sign"
    wait "$sign" 2>/dev/null || :
    return "$status"
}

installed() {
    # Ubuntu 24.04 renamed libglib2.0-0 to libglib2.0-0t64.
    dpkg-query -W -f='${Status}' "$1" 2>/dev/null | grep -q 'ok installed' \
        || dpkg-query -W -f='${Status}' "$1t64" 2>/dev/null | grep -q 'ok installed'
}

ROUTES=${ROUTES:-/proc/net}  # the folder in which Linux lists its routes

# has_network: whether this computer has a route to a network, or a setting that may work without one.
has_network() {
    [ -r "$ROUTES/route" ] || return 0
    cat "$ROUTES/route" "$ROUTES/ipv6_route" 2>/dev/null \
        | awk '$1 != "Iface" && $1 != "lo" && $NF != "lo" { found = 1 } END { exit !found }' && return
    [ -n "${http_proxy:-}${HTTP_PROXY:-}${https_proxy:-}${HTTPS_PROXY:-}${all_proxy:-}${ALL_PROXY:-}" ]
}

# may_fetch WHAT: ends the set-up at once, with the reason, if WHAT must be downloaded and there is no network.
may_fetch() {
    has_network && return
    say "This computer has no network: it has no route to one. These must be downloaded: $1."
    say "Connect it to a network, then start again. Without a network, install the bundle in one file:"
    say "see 'Install without a network' in docs/integrator/install.md."
    exit 2
}

# Packages of Debian can come from a medium, and those of Python from a folder or an index on this computer.
has_own_debs() { [ -n "$APT_OPTIONS" ] || grep -rqsE '(file|copy|cdrom):|Proxy' /etc/apt/sources.list /etc/apt/sources.list.d /etc/apt/apt.conf /etc/apt/apt.conf.d; }
has_own_wheels() {
    [ -n "${PIP_FIND_LINKS:-}${PIP_CONFIG_FILE:-}${UV_FIND_LINKS:-}" ] && return
    printf '%s\n' "${PIP_INDEX_URL:-} ${UV_DEFAULT_INDEX:-} ${UV_INDEX_URL:-}" \
        | cat - /etc/pip.conf "${HOME:-}/.config/pip/pip.conf" "${HOME:-}/.pip/pip.conf" "${HOME:-}/.config/uv/uv.toml" 2>/dev/null \
        | grep -qE 'file:|localhost|127\.|\[::1\]|find-links|proxy'
}

# may_install PACKAGES: whether packages can be installed by this user; else it says what whoever can has to do.
may_install() {
    [ "$(id -u)" = 0 ] && return
    command -v sudo >/dev/null && sudo -v && return
    say "These packages are missing, and $(id -un) may not install them. Ask whoever looks after this computer for"
    say "  ${AS_ROOT:-apt-get install$1}"
    say "as root; then start again."
    return 1
}

as_root() { if [ "$(id -u)" = 0 ]; then "$@"; else sudo "$@"; fi; }

# apt_get INSTRUCTION …: apt-get without questions, its last lines kept in apt_says.
apt_get() {
    # shellcheck disable=SC2086
    patiently "apt-get $1" as_root env DEBIAN_FRONTEND=noninteractive LC_ALL=C apt-get -qq \
        -o Acquire::http::Timeout=10 -o Acquire::https::Timeout=10 $APT_OPTIONS "$@" && return
    apt_says=$(printf '%s\n' "$said" | grep -E '^[EW]:|No space left' | tail -n 4)
    return 1
}

fresh_package_lists() {
    [ -n "${LISTS_RENEWED:-}" ] && return
    LISTS_RENEWED=yes
    apt_get update || say "The package lists could not be renewed; going on with those that are here."
}

# fedora_name PACKAGE: prints the name of a Debian package on Fedora, and nothing for a part of Fedora's python3.
fedora_name() {
    case $1 in
        libgl1) echo libglvnd-glx ;;
        libegl1) echo libglvnd-egl ;;
        libglib2.0-0) echo glib2 ;;
        libxkbcommon0) echo libxkbcommon ;;
        libdbus-1-3) echo dbus-libs ;;
        libfontconfig1) echo fontconfig ;;
        libgssapi-krb5-2) echo krb5-libs ;;
        libxcb-cursor0) echo xcb-util-cursor ;;
        libxkbcommon-x11-0) echo libxkbcommon-x11 ;;
        libxcb-icccm4) echo xcb-util-wm ;;
        libxcb-keysyms1) echo xcb-util-keysyms ;;
        libxcb-shape0) echo libxcb ;;
        libxi6) echo libXi ;;
        libwayland-client0 | libwayland-cursor0) echo "${1%0}" ;;
        libwayland-egl1) echo libwayland-egl ;;
        python3 | ca-certificates) echo "$1" ;;
    esac
}

# name_packages PACKAGES: without apt-get, says which packages of Fedora are missing; the set-up installs none of them.
name_packages() {
    command -v dnf >/dev/null || { say "No apt-get here: see README for the libraries that Qt needs."; return; }
    missing=""
    for package in "$@"; do
        name=$(fedora_name "$package")
        [ -z "$name" ] || rpm -q "$name" >/dev/null 2>&1 || missing="$missing $name"
    done
    [ -z "$missing" ] || say "TurnDesk was not tested on Fedora. It needs these packages: sudo dnf install$missing"
}

system_packages() {
    command -v apt-get >/dev/null || { name_packages "$@"; return; }
    missing=""
    for package in "$@"; do installed "$package" || missing="$missing $package"; done
    [ -z "$missing" ] && return
    has_own_debs || may_fetch "system packages$missing"
    may_install "$missing" || exit 2
    say "Installing system packages:$missing"
    fresh_package_lists
    # shellcheck disable=SC2086
    apt_get install -y --no-install-recommends $missing || not_installed
}

not_installed() {
    say "Not installed:$missing. apt-get says:"
    say "$apt_says"
    case $apt_says in
        *"No space left"* | *"enough free space"*) say "Its disk is full: make room, then start again." ;;
        *ertificate*)
            say "The certificate of the package server is not trusted. If a proxy decrypts the traffic, copy its certificate to"
            say "/usr/local/share/ca-certificates, run update-ca-certificates as root, then start again." ;;
        *"Unable to locate"* | *"no installation candidate"* | *"Failed to fetch"* | *resolving* | *onnect*)
            say "Is there a network? Without one, bring the bundle in one file (docs/integrator/install.md), or install them from the distribution's medium." ;;
    esac
    exit 2
}

optional_packages() {
    # What a test can be skipped without: where apt has it not, or nobody may install, it is said and left out.
    command -v apt-get >/dev/null || return 0
    for package in "$@"; do
        installed "$package" && continue
        { { has_own_debs || has_network; } && may_install " $package" && apt_get install -y --no-install-recommends "$package"; } \
            || say "$package cannot be installed here: tests that need it are skipped"
    done
}

# The Pythons for which the packages are locked: lock.py's PYTHONS, pyproject.toml's requires-python.
supported() { "$1" -c 'import sys; sys.exit(not (3, 11) <= sys.version_info[:2] <= (3, 14))' 2>/dev/null; }

version_of() { "$1" -c 'import sys; print("%d.%d" % sys.version_info[:2])' 2>/dev/null; }

# These four are how it is done with a network; install.sh does them with what it brings along.
PYTHON_PACKAGES="python3 python3-venv"
can_make_environment() { command -v uv || "$1" -c 'import ensurepip, venv'; }
make_environment() {
    if command -v uv >/dev/null; then
        uv venv -q --allow-existing --python "$PYTHON" "$PYTHON_ENV"
    else
        "$PYTHON" -m venv "$PYTHON_ENV"
    fi
}
place() { printf '%s' "$ROOT $PYTHON_ENV"; }

usable_python() { supported "$1" && can_make_environment "$1" >/dev/null 2>&1; }

# search_python: sets PYTHON to the first of those here with which an environment can be made.
search_python() {
    for PYTHON in python3 python3.14 python3.13 python3.12 python3.11; do
        usable_python "$PYTHON" && return
    done
    return 1
}

# python_packages: what has to be installed for that, in one go with everything else.
python_packages() {
    search_python && return
    if ! command -v python3 >/dev/null; then echo "$PYTHON_PACKAGES"
    elif supported python3; then echo python3-venv; fi
}

find_python() {
    search_python && return
    if supported python3; then
        say "Python $(version_of python3) is here without venv and ensurepip: install them (Debian: python3-venv), then start again."
    else
        say "TurnDesk needs Python 3.11, 3.12, 3.13 or 3.14; here is $(version_of python3 || echo none). Install one of them, then start again."
    fi
    exit 2
}

# right_environment: whether the Python environment that is there works where it is and was made by a set-up of ours.
right_environment() {
    version=$(version_of "$PYTHON_ENV/bin/python") || return 1
    supported "$PYTHON_ENV/bin/python" && [ -d "$PYTHON_ENV/lib/python$version" ] || return 1
    [ -x "$PYTHON_ENV/bin/pip" ] || command -v uv >/dev/null || return 1
    # A clone that was moved or copied: its programs still name the old place.
    [ ! -f "$PYTHON_ENV/.turndesk-place" ] || [ "$(cat "$PYTHON_ENV/.turndesk-place")" = "$(place)" ]
}

new_environment() {
    if [ -d "$PYTHON_ENV" ]; then
        # Somebody's own folder is never emptied.
        for ours in "$PYTHON_ENV"/.turndesk*; do
            [ -f "$ours" ] || { say "$PYTHON_ENV is there, but is no Python environment of TurnDesk: name another folder in TURNDESK_VENV, or take this one away."; exit 2; }
            break
        done
        say "The Python environment was made by another Python or at another place; making it anew"
        rm -rf -- "$PYTHON_ENV"
    fi
    # First its sign: what is broken off here is made anew next time.
    said=$({ LC_ALL=C mkdir -p "$PYTHON_ENV" && place | LC_ALL=C cat >"$PYTHON_ENV/.turndesk-place"; } 2>&1) || not_fetched
    patiently "Making the Python environment" make_environment || not_fetched
}

# pip_install WORDS: pip install of the environment, or uv's, which is quicker; what it says is kept in said.
pip_install() {
    if [ -x "$PYTHON_ENV/bin/pip" ]; then
        patiently "Python packages" "$PYTHON_ENV/bin/python" -m pip install -q --disable-pip-version-check "$@"
    else
        patiently "Python packages" uv pip install -q --python "$PYTHON_ENV/bin/python" "$@"
    fi
}

log_has() { printf '%s\n' "$said" | grep -qiE "$1"; }

# has_less_than MB FOLDER: whether the disk of the folder has less than this left, in MB.
has_less_than() {
    free=$(df -Pk -- "$2" 2>/dev/null | awk 'NR == 2 { print $4 }')
    [ "${free:-999999999}" -lt "$(($1 * 1024))" ]
}

# Python's venv does not say why it gave up, so that a disk with 2 MB left counts as full.
is_full() { has_less_than 2 "$1"; }

NEEDED=500  # MB for the Python packages

# name_full_disks: prints each disk without room for the Python packages, by its mount point and a folder on it.
name_full_disks() {
    for folder in "$PYTHON_ENV" "${TMPDIR:-/tmp}"; do
        has_less_than "$NEEDED" "$folder" || continue
        df -Pk -- "$folder" | awk -v folder="$folder" \
            'NR == 2 { printf "  %s, with %s: %d MB free\n", $6, folder, $4 / 1024 }'
    done
}

# keep_log: writes what was said to a file, on a disk that has room for it; else the last lines are shown.
keep_log() {
    for log in "$PYTHON_ENV/.turndesk-log" "$(mktemp "${TMPDIR:-/tmp}/turndesk-log-XXXXXX" 2>/dev/null)"; do
        [ -n "$log" ] || continue
        { printf '%s\n' "$said" >"$log"; } 2>/dev/null && { say "All that it said is in $log"; return; }
        rm -f -- "$log"
    done
    say "No disk has room for a log. The last lines were:"
    say "$(printf '%s\n' "$said" | tail -n 4)"
}

# not_fetched: one clear sentence for why pip gave up, told from what it wrote.
not_fetched() {
    if log_has 'do not match the hashes|hash mismatch|bad magic number|BadZipFile|not a zip file|invalid wheel'; then
        say "A Python package that came is not the one TurnDesk was tested with: damaged on the way, or tampered with. It was not installed."
        say "$(printf '%s\n' "$said" | grep -iE '^ +[a-z0-9._-]+==|hash mismatch' | sed 's/ (from -r .*//' | head -n 2)"
        say "Start again; if it stays, find out what stands between here and the package index (a proxy, a mirror, a folder of wheels)."
    elif log_has 'no space left' || is_full "$PYTHON_ENV" || is_full "${TMPDIR:-/tmp}"; then
        say "No room left on the disk of $PYTHON_ENV or of ${TMPDIR:-/tmp}: the Python packages need $NEEDED MB. Make room, then start again."
        name_full_disks >&2
    elif log_has 'permission denied|read-only file system'; then
        say "$(id -un) may not write to $PYTHON_ENV: name a folder in TURNDESK_VENV, or start as its owner."
    elif log_has 'certificate'; then
        say "The package index could not be trusted: is this computer's date right ($(date '+%Y-%m-%d %H:%M'))? A proxy that looks into"
        say "encrypted traffic needs its certificate named in PIP_CERT (for uv: SSL_CERT_FILE)."
        [ -z "${REQUESTS_CA_BUNDLE:-}${CURL_CA_BUNDLE:-}" ] \
            || say "REQUESTS_CA_BUNDLE or CURL_CA_BUNDLE is set, and pip prefers it to PIP_CERT: set it to the same file, or unset it."
    elif log_has 'name resolution|name or service|connection|network is unreachable|timed out|proxy|dns error|error sending request|could not connect'; then
        say "The Python packages could not be fetched: is there a network, or a proxy to be named in https_proxy?"
        say "Without one, bring the bundle in one file: docs/integrator/install.md says how it is made on a computer that has a network."
    elif log_has 'no matching distribution|no wheels with a matching|no usable wheels|has no wheels'; then
        say "There are no Python packages for this computer ($(uname -m), $(getconf GNU_LIBC_VERSION 2>/dev/null || echo 'no glibc')): TurnDesk needs 64-bit x86"
        say "with glibc 2.34 (Debian 12, Ubuntu 22.04) or 64-bit ARM with glibc 2.39 (Debian 13, Ubuntu 24.04), or newer."
    else
        say "The Python packages could not be installed. pip says:"
        say "$(printf '%s\n' "$said" | tail -n 4)"
    fi
    keep_log || :
    exit 2
}

# What is locked is whole, so pip resolves nothing: an older one would look at the newest coverage[toml] first, which has no hash.
LOCKED="--require-hashes --no-deps"

# has_locked_packages FILE: whether the environment contains all packages of the file. Needs no network.
has_locked_packages() {
    # shellcheck disable=SC2086
    right_environment && pip_install --no-index $LOCKED --only-binary :all: -r "$1"
}

# python_environment SET: makes or renews the environment by locked-SET.txt when that or TurnDesk's own list has changed.
python_environment() {
    locked="$ROOT/resources/setup/locked-$1.txt"
    stamp="$PYTHON_ENV/.turndesk-$1"
    wanted=$(cat "$ROOT/pyproject.toml" "$locked" "$ROOT/setup.cfg" | cksum)
    right_environment && [ -f "$stamp" ] && [ "$(cat "$stamp")" = "$wanted" ] && return
    if has_own_wheels || has_network; then
        right_environment || new_environment
        say "Setting up Python packages in $PYTHON_ENV (about 130 MB to fetch, once)"
        # shellcheck disable=SC2086
        pip_install $LOCKED --only-binary :all: -r "$locked" || not_fetched
    else
        has_locked_packages "$locked" || may_fetch "Python packages, about 130 MB"
        say "This computer has no network, and needs none: the Python packages are installed."
    fi
    pip_install --no-deps --no-build-isolation -e "$ROOT" || not_fetched
    said=$({ printf '%s\n' "$wanted" | LC_ALL=C cat >"$stamp"; } 2>&1) || not_fetched
}

export OPENBLAS_NUM_THREADS=1
