#!/bin/sh
# Runs everything that must hold: format, lint, types, import contracts, tests. Does all the set-up it needs.
# Usage: sh tests/run.sh [arguments for pytest, such as --cov --cov-report=term]
set -eu
. "$(dirname -- "$0")/../resources/setup/environment.sh"

# shellcheck disable=SC2086
system_packages ca-certificates $QT_LIBRARIES $WINDOW_LIBRARIES $STORY_PACKAGES
find_python
python_environment "[dev]"

cd "$ROOT"
PATH="$PYTHON_ENV/bin:$PATH"
export QT_QPA_PLATFORM=offscreen
ruff format --check --quiet .
ruff check --quiet .
mypy
lint-imports
pytest -n 2 "$@"
