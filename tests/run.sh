#!/bin/sh
# Runs everything that must hold: format, lint, types, import contracts, tests. Does all the set-up it needs.
# Usage: sh tests/run.sh [arguments for pytest, such as --cov --cov-report=term]
#        sh tests/run.sh --quick [arguments for pytest]   under a minute: what a change of the language or of a rule breaks first
set -eu
. "$(dirname -- "$0")/../resources/setup/environment.sh"

# shellcheck disable=SC2086
system_packages ca-certificates $QT_LIBRARIES $WINDOW_LIBRARIES $STORY_PACKAGES
optional_packages linuxcnc-uspace
find_python
python_environment "[dev]"

QUICK="tests/language tests/geometry tests/interpreter tests/klartext tests/sinumerik tests/motion tests/proving tests/executor tests/alarms tests/machine tests/test_map.py"

cd "$ROOT"
PATH="$PYTHON_ENV/bin:$PATH"
export QT_QPA_PLATFORM=offscreen
ruff format --check --quiet .
ruff check --quiet .
mypy
lint-imports
if [ "${1:-}" = "--quick" ]; then
    shift
    # shellcheck disable=SC2086
    exec pytest -n 2 -m "not long" $QUICK "$@"
fi
# One more than there are cores: a story mostly waits for what it looks at.
pytest -n 3 "$@"
