"""Position presets with G92 of LinuxCNC and Mach, and their cancellation."""

from __future__ import annotations

from core.extras.convert.conversion_messages import make_error
from core.extras.convert.path_steps import PathStep, StepKind
from core.extras.convert.source_lines import SourceWord
from core.extras.convert.source_state import SourceState


def add_preset_shift(state: SourceState, before: tuple[float | None, float | None]) -> None:
    """Add the shift of a preset to the total shift that G92.1 cancels.

    If the position is unknown, the total shift becomes unknown too.
    """
    if None in {*before, state.x, state.z} or state.preset_shift is None:
        state.preset_shift = None
        return
    (old_x, old_z), shift = before, state.preset_shift
    assert old_x is not None
    assert old_z is not None
    assert state.x is not None
    assert state.z is not None
    state.preset_shift = shift[0] + old_x - state.x, shift[1] + old_z - state.z


def cancel_preset(state: SourceState, word: SourceWord) -> None:
    """Execute G92.1 or G92.2, which set the position to its value without the earlier presets.

    If the shift of these presets is unknown, the next move raises ProgramError.
    """
    state.has_preset = False
    shift, state.preset_shift = state.preset_shift, (0.0, 0.0)
    if shift is None or state.x is None or state.z is None:
        state.move_error = make_error(word.line_number, word.column, "preset-cancelled", word=word.text)
        return
    state.x, state.z = state.x + shift[0], state.z + shift[1]
    state.append_step(PathStep(StepKind.PRESET, word.line_number, state.x, state.z))
