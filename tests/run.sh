#!/bin/sh
# Runs everything that must hold: format, lint, types, import contracts, tests. Does all the set-up it needs.
# Usage: sh tests/run.sh [arguments for pytest, such as --cov --cov-report=term]
#        sh tests/run.sh --quick [arguments for pytest]   under a minute: what a change of the language or of a rule breaks first
set -eu
. "$(dirname -- "$0")/../resources/setup/environment.sh"

# The quick part opens no window and has no stories.
MORE=""
[ "${1:-}" = "--quick" ] || MORE="$WINDOW_LIBRARIES $STORY_PACKAGES"
# shellcheck disable=SC2046,SC2086
system_packages ca-certificates $QT_LIBRARIES $MORE $(python_packages)
[ "${1:-}" = "--quick" ] || optional_packages linuxcnc-uspace mosquitto postgresql codespell
find_python
python_environment tests

QUICK="tests/language tests/geometry tests/interpreter tests/klartext tests/sinumerik tests/motion tests/proving tests/executor tests/alarms tests/machine tests/documents tests/test_map.py"

cd "$ROOT"
PATH="$PYTHON_ENV/bin:$PATH"
export QT_QPA_PLATFORM=offscreen
# A story, a worker and a command are processes: what one has compiled, the others read.
unset PYTHONDONTWRITEBYTECODE
ruff format --check --quiet .
ruff check --quiet .
# Types and contracts are checked beside the tests, with what these leave of two cores.
nice mypy &
TYPES=$!
nice lint-imports &
CONTRACTS=$!
finish() {
    # finish STATUS: the status of the tests, or that of the first other check that failed.
    status=$1
    wait "$TYPES" || { [ "$status" != 0 ] || status=1; echo "mypy failed: see above" >&2; }
    wait "$CONTRACTS" || { [ "$status" != 0 ] || status=1; echo "lint-imports failed: see above" >&2; }
    exit "$status"
}
if [ "${1:-}" = "--quick" ]; then
    shift
    # shellcheck disable=SC2086
    pytest --forked-workers 2 -m "not long" $QUICK "$@" || finish $?
    finish 0
fi
# Two for two cores, and three that begin with what mostly waits: tests/waiting_apart.py.
pytest --forked-workers 5 "$@" || finish $?
finish 0
