"""The examples of a property do not depend on what else has been loaded."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

HOUSE = Path(__file__).parents[1]
DRAWN = """\
import sys
from hypothesis import given, settings, strategies as st
from tests import conftest
if sys.argv[1:]:
    import core.executor.executor, drivers.simulated.simulated_machine
    import core.interpreter.klartext.klartext_interpreter

seen = []

@settings(max_examples=200)
@given(st.lists(st.floats(0, 4000)), st.integers(0, 10**6))
def drawn(floats, number):
    seen.append((floats, number))

drawn()
print(seen)
"""


def test_examples_are_the_same_with_other_modules_loaded(tmp_path: Path) -> None:
    script = tmp_path / "drawn.py"
    script.write_text(DRAWN)
    steady = {name: value for name, value in os.environ.items() if name != "HYPOTHESIS_PROFILE"}
    steady["PYTHONPATH"] = str(HOUSE)
    outputs = [
        subprocess.run(
            [sys.executable, script, *more], capture_output=True, text=True, check=True, env=steady
        ).stdout
        for more in ([], ["others"])
    ]
    assert len(outputs[0]) > 1000
    assert outputs[0] == outputs[1]
