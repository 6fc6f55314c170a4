"""Jog by a controller's own jog: the same questions, one jog at a time, limits that the controller keeps."""

from __future__ import annotations

import dataclasses

import pytest

from core.executor.hand_motion.jog_line import SOFT_LIMIT_MARGIN, JogLine
from core.executor.hand_motion.jogging import BlockJogger, Jogger, create_jogger
from core.executor.machine_context import MachineContext
from tests.executor.played_controller import PlayedController, context_of
from tests.texts import text

LEASE = 0.4


def jogger_on(controller: PlayedController) -> tuple[BlockJogger, MachineContext]:
    context = context_of(controller)
    jogger = create_jogger(context)
    assert isinstance(jogger, BlockJogger)
    return jogger, context


def test_jogger_type_depends_on_the_driver() -> None:
    assert type(create_jogger(context_of(None))) is Jogger


@pytest.mark.parametrize(
    ("controller", "why"),
    [
        (PlayedController(hindrance="its modes are being verified"), "its modes are being verified"),
        (PlayedController(resting=False), text("executor.controller-moving")),
        (PlayedController(), ""),
    ],
)
def test_a_controller_that_is_not_ready_does_not_jog(controller: PlayedController, why: str) -> None:
    jogger, _ = jogger_on(controller)
    assert jogger.find_jog_refusal_reason("X", 5.0, LEASE) == why
    assert jogger.find_step_refusal_reason("X", 0.1, 5.0) == why


def test_controller_rejects_jog_along_a_tilted_direction() -> None:
    jogger, _ = jogger_on(PlayedController())
    why = text("executor.controller-axes-only", axis="X")
    assert jogger.find_jog_refusal_reason("X", 5.0, LEASE, (1.0, 0.0, 0.0)) == why
    assert jogger.find_step_refusal_reason("X", 0.1, 5.0, (1.0, 0.0, 0.0)) == why


def test_jog_command_carries_reduced_travel_and_lease_of_at_most_1_s() -> None:
    controller = PlayedController()
    jogger, context = jogger_on(controller)
    low, high = context.machine.find_axis("X").travel or (0.0, 0.0)
    assert jogger.start_or_renew_jog("X", -5.0, 7.0)
    assert controller.jogged == [("X", -5.0, 1.0, (low + SOFT_LIMIT_MARGIN, high - SOFT_LIMIT_MARGIN))]
    assert jogger.axis_name == "X"


def test_unhomed_axis_jogs_without_limits_at_a_tenth_of_the_speed() -> None:
    controller = PlayedController()
    jogger, context = jogger_on(controller)
    context.axis_sample = context.axis_sample._replace(homed=(False, False, False))
    tenth = 0.1 * min(context.machine.find_axis("X").max_speed, context.machine.limits.manual_rapid)
    assert jogger.start_or_renew_jog("X", 500.0, LEASE)
    assert controller.jogged == [("X", pytest.approx(tenth), LEASE, None)]


def test_jog_that_the_controller_does_not_accept_is_not_started() -> None:
    jogger, _ = jogger_on(PlayedController(jogs=False))
    assert not jogger.start_or_renew_jog("X", 5.0, LEASE)
    assert not jogger.jog_to_target("X", 1.0, 5.0, LEASE)
    assert jogger.axis_name == ""


@pytest.mark.parametrize(
    ("target", "velocity", "limits"), [(2.0, 5.0, (0.0, 2.0)), (-3.0, -5.0, (-3.0, 0.0))]
)
def test_jog_to_target_stops_at_the_target(
    target: float, velocity: float, limits: tuple[float, float]
) -> None:
    controller = PlayedController()
    jogger, _ = jogger_on(controller)
    assert jogger.jog_to_target("Z", target, 5.0, LEASE)
    assert controller.jogged == [("Z", velocity, LEASE, limits)]


def test_step_starts_from_the_commanded_position() -> None:
    controller = PlayedController()
    jogger, context = jogger_on(controller)
    context.axis_sample = context.axis_sample._replace(demand=(1.0, 2.0, 0.0))
    jogger.start_step("Z", -0.5, 5.0)
    assert controller.steps == [("Z", 1.5, 5.0)]
    assert jogger.find_step_refusal_reason("Z", 0.1, 5.0) == text("executor.step-not-over", axis="Z")


def test_stop_without_a_jog_sends_no_command() -> None:
    controller = PlayedController()
    jogger, _ = jogger_on(controller)
    jogger.stop()
    assert controller.asked == []


def test_stopped_step_is_reported_as_cut_short() -> None:
    controller = PlayedController()
    jogger, context = jogger_on(controller)
    said: list[str] = []
    context.handle_event = lambda event: said.append(event.text)
    jogger.start_step("Z", -0.5, 5.0)
    jogger.stop()
    assert controller.asked == ["jog stop"]
    controller.resting = False
    assert not jogger.finish_if_at_rest()
    controller.resting = True
    assert jogger.finish_if_at_rest()
    assert said == [text("executor.step-cut-short", axis="Z")]


def let_go(controller: PlayedController) -> tuple[BlockJogger, MachineContext]:
    """X was jogged and let go, and is pressed the other way while it still ends."""
    jogger, context = jogger_on(controller)
    jogger.start_or_renew_jog("X", 5.0, LEASE)
    controller.resting = False
    jogger.stop()
    assert jogger.start_or_renew_jog("X", -5.0, LEASE)
    assert len(controller.jogged) == 1
    return jogger, context


def test_repeated_key_press_waits_for_stop_and_uses_remaining_lease() -> None:
    controller = PlayedController()
    jogger, context = let_go(controller)
    context.now += 0.3
    controller.resting = True
    assert not jogger.finish_if_at_rest()
    assert controller.jogged[1][:2] == ("X", -5.0)
    assert controller.jogged[1][2] == pytest.approx(0.1)


@pytest.mark.parametrize("spoilt", ["lease", "hindrance", "let go"])
def test_repeated_key_press_starts_no_jog_after_lease_fault_or_release(spoilt: str) -> None:
    controller = PlayedController()
    jogger, context = let_go(controller)
    controller.resting = True
    if spoilt == "lease":
        context.now += LEASE
    elif spoilt == "hindrance":
        controller.hindrance = "it is reset"
    else:
        jogger.stop()
    assert jogger.finish_if_at_rest()
    assert len(controller.jogged) == 1


# --- along an axis of a tilted plane, by setpoints ----------------------------------------------------------


def test_lathe_rejects_jog_in_a_tilted_plane() -> None:
    jogger = Jogger(context_of(None))
    assert jogger.find_jog_refusal_reason("X", 5.0, LEASE, (1.0, 0.0, 0.0)).startswith(
        text("executor.tilted-needs")
    )


def three_axes() -> MachineContext:
    """The lathe with its last axis called Y, which is enough for a direction of three."""
    context = context_of(None)
    x, z, c = context.machine.axes
    context.machine = dataclasses.replace(context.machine, axes=(x, z, dataclasses.replace(c, name="Y")))
    return context


@pytest.mark.parametrize("direction", [(0.6, 0.8, 0.1), (0.0, 0.0, 0.0), (float("nan"), 0.0, 1.0)])
def test_invalid_jog_direction_is_rejected(direction: tuple[float, float, float]) -> None:
    why = Jogger(three_axes()).find_jog_refusal_reason("X", 5.0, LEASE, direction)
    assert why == text("executor.tilted-needs")


def test_tilted_jog_requires_all_axes_to_be_homed() -> None:
    context = three_axes()
    assert Jogger(context).find_jog_refusal_reason("X", 5.0, LEASE, (0.6, 0.8, 0.0)) == ""
    context.axis_sample = context.axis_sample._replace(homed=(True, False, True))
    why = Jogger(context).find_jog_refusal_reason("X", 5.0, LEASE, (0.6, 0.8, 0.0))
    assert why == text("executor.tilted-homed")


def test_three_axis_jog_is_limited_by_first_end_and_weakest_axis() -> None:
    """X Y Z in .6, 0 and .8: 8 mm of Z are 10 mm of the line; 800 mm/s² of Z are 1000 along it."""
    x, z, y = three_axes().machine.axes
    axes = (
        dataclasses.replace(x, travel=(-100.0, 100.0), max_acceleration=3000.0),
        dataclasses.replace(z, travel=(-100.0, 8.0 + SOFT_LIMIT_MARGIN), max_acceleration=800.0),
        dataclasses.replace(y, travel=(0.0, 0.0)),
    )
    line = JogLine.from_direction(axes, (0.6, 1e-12, 0.8))
    assert [(axis.name, share) for _, axis, share in line.iter_moving_axes()] == [("X", 0.6), ("Z", 0.8)]
    assert line.get_distance_to_limit((0.0, 0.0, 0.0), 1.0) == pytest.approx(10.0)
    assert line.max_acceleration == pytest.approx(1000.0)
    assert not line.has_same_direction(JogLine.from_axis(axes, 0))
    assert not line.has_same_direction(None)
