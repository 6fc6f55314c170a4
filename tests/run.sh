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
[ "${1:-}" = "--quick" ] || optional_packages linuxcnc-uspace mosquitto postgresql git
find_python
python_environment tests

QUICK="tests/language tests/geometry tests/interpreter tests/klartext tests/sinumerik tests/motion tests/proving tests/executor tests/alarms tests/machine tests/test_map.py"

cd "$ROOT"
PATH="$PYTHON_ENV/bin:$PATH"
export QT_QPA_PLATFORM=offscreen
# A story, a worker and a command are processes: what one has compiled, the others read.
unset PYTHONDONTWRITEBYTECODE
ruff format --check --quiet .
ruff check --quiet .
mypy &
TYPES=$!
lint-imports
if [ "${1:-}" = "--quick" ]; then
    shift
    wait "$TYPES"
    # shellcheck disable=SC2086
    exec pytest -n 2 -m "not long" $QUICK "$@"
fi
pytest --collect-only --quiet --quiet >/dev/null || true  # compiled once, before every worker does it for itself
wait "$TYPES"
# Two for two cores, and two that begin with what mostly waits: tests/waiting_apart.py.
pytest -n 4 "$@"
