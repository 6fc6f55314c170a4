"""The same examples of a property at every run, on every worker, with any part of the suite."""

from __future__ import annotations

import importlib
from typing import Any


def same_examples_whatever_is_loaded() -> None:
    """Keep Hypothesis from drawing the numbers that it finds in our source.

    It reads the constants of every module of ours that is loaded at that moment, even where it is told not
    to throw dice. Which modules those are depends on the tests that this worker has run before: what passed
    in one run failed in the next, on the same source.
    """
    providers: Any = importlib.import_module("hypothesis.internal.conjecture.providers")
    empty = providers.Constants()
    assert not len(empty), "this version of Hypothesis starts with constants of its own"
    providers._get_local_constants = lambda: empty
