"""Actions and commands as values: what is equal, and that they do not change."""

from __future__ import annotations

import copy
import pickle

import pytest

from core.executor import commands
from core.executor.commands import FeedHold, JogByStep, SupplyJobProof
from core.interpreter.shared import actions
from core.interpreter.shared.actions import ColletSwitch, CoolantSwitch, CycleRepeatCancel, SpindleRun
from core.plain_value import ValueObject


@pytest.mark.parametrize(
    ("one", "other"),
    [
        (CoolantSwitch(True), CoolantSwitch(True)),
        (CycleRepeatCancel(), CycleRepeatCancel()),
        (SpindleRun(-900.0), SpindleRun(-900.0, None)),
        (JogByStep("X", 1.0, 2.0), JogByStep("X", 1.0, 2.0, None)),
        (FeedHold("key", 3), FeedHold("panel", 4)),
    ],
)
def test_equal_values_have_the_same_hash(one: ValueObject, other: ValueObject) -> None:
    assert one == other
    assert len({one, other}) == 1


@pytest.mark.parametrize(
    ("one", "other"),
    [
        (CoolantSwitch(True), CoolantSwitch(False)),
        (CoolantSwitch(True), ColletSwitch(True)),
        (CoolantSwitch(True), True),
        (CycleRepeatCancel(), commands.Reset()),
        (FeedHold(), commands.Reset()),
        (SpindleRun(900.0, 1.0), SpindleRun(900.0, 2.0)),
        (actions.SpindleStop(), commands.StopSpindle()),
    ],
)
def test_values_of_other_classes_or_with_other_attributes_differ(one: ValueObject, other: object) -> None:
    assert one != other


def test_repr_shows_the_attributes() -> None:
    assert repr(actions.OutputSwitch("m25", True)) == "OutputSwitch(name='m25', on=True)"


def test_match_pattern_follows_the_argument_order() -> None:
    match actions.InputWait("TB2-9", False):
        case actions.InputWait(terminal, closed):
            assert (terminal, closed) == ("TB2-9", False)


def test_copy_equals_the_original() -> None:
    step = JogByStep("Z", -0.5, 3.0, (0.0, 0.0, 1.0))
    assert copy.deepcopy(step) == step == pickle.loads(pickle.dumps(step))


def test_unknown_attributes_and_arguments_are_rejected() -> None:
    with pytest.raises(AttributeError):
        CoolantSwitch(True).off = False  # type: ignore[attr-defined]
    with pytest.raises(TypeError):
        SupplyJobProof()  # type: ignore[call-arg]
