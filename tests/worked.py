"""The worked examples of the control's manual: read where they are, never copied; absent, the test skips."""

from __future__ import annotations

from pathlib import Path

import pytest

FOLDER = Path(__file__).parents[1].parent / "shared" / "conformance" / "omniturn"


def worked(name: str) -> Path:
    """The file of an example; skips, saying so, where it is absent."""
    path = FOLDER / f"{name}.nc"
    if not path.exists():
        pytest.skip(f"the worked examples are not here: {path}")
    return path
