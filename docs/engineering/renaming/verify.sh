#!/bin/sh
# verify.sh TREE [--no-tests]: the checks after a run of rename.py; a summary on the last lines. Exit status: number of failed checks.
T=$(cd "$1" && pwd) || exit 9; B=$T/.venv/bin; L=${RN_LOG:-verify-logs}; mkdir -p "$L"; cd "$T" || exit 9
bad=0
step() { name=$1; shift; s=$(date +%s); "$@" > "$L/$name.log" 2>&1; r=$?; [ $r = 0 ] || bad=$((bad + 1)); echo "$name: status $r, $(( $(date +%s) - s )) s; $(tail -1 "$L/$name.log" | cut -c1-150)"; }
export QT_QPA_PLATFORM=offscreen
step format "$B/ruff" format --check .
step ruff "$B/ruff" check --output-format concise .
step mypy "$B/mypy"
step imports "$B/lint-imports"
step collect "$B/pytest" --collect-only -q
[ "$2" = --no-tests ] || for d in tests/language tests/interpreter tests/executor tests/desk tests/machine tests/documents tests/store tests/motion tests/test_map.py tests/test_contracts.py tests/texts tests/screen; do
  [ -e $d ] && step "$(echo $d | tr / _)" "$B/pytest" -q -n 2 --maxfail=80 -p no:cacheprovider $d
done
echo "failed checks: $bad"; exit $bad
