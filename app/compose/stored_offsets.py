"""Tool, secondary and zero offsets from the store or an offsets file, for the interpreter and the screen."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, NamedTuple

from app.compose.machine.machine_setup import create_power_up_setup
from app.desk.command_errors import CommandError, convert_to_command_error
from app.desk.data_folder import find_data_folder
from app.offsets.active_offsets import (
    PRESET_SETTING,
    R_PARAMETERS_SETTING,
    MillOffsets,
    add_mill_offsets,
    find_active_preset,
    make_mill_rows,
    make_secondary_offsets,
    make_tool_offsets,
    parse_r_parameters,
)
from core.interpreter.shared.job_setup import InterpreterSetup, SecondaryOffset, ToolOffset, ZeroOffset
from core.message import Message
from core.store.store_file import has_store
from core.store.store_rows import SecondaryOffsetRow, ToolOffsetRow, ZeroOffsetRow

if TYPE_CHECKING:
    from app.compose.runs.journal import Journal
    from app.offsets.offset_book import OffsetBook
    from core.machine.machine_model import Machine
    from core.part.tool_shape import ToolShape
    from core.store.store import Store

OFFSETS_FILE_TEXT = (
    "OFFSETS COME FROM A FILE (--offsets) AND ARE READ-ONLY. CHANGE THIS FILE, OR START WITHOUT THIS OPTION"
)


class Offsets(NamedTuple):
    """All offsets by number, in the interpreter's units (mm, with X as a radius)."""

    tool_offsets: Mapping[int, ToolOffset]
    secondary_offsets: Mapping[int, SecondaryOffset]
    zero_offsets: Mapping[int, ZeroOffset]
    mill_offsets: MillOffsets = MillOffsets()
    r_parameters: Mapping[int, float] = MappingProxyType({})  # =


NO_OFFSETS = Offsets({}, {}, {})


def create_setup_with_offsets(
    machine: Machine,
    offsets: Offsets,
    *,
    input_states: Mapping[str, bool] | None = None,
    block_delete: bool = False,
    is_strict: bool = False,
) -> InterpreterSetup:
    """Return the setup of a program that starts after power-up with these offsets."""
    return add_mill_offsets(
        create_power_up_setup(
            machine,
            tool_offsets=offsets.tool_offsets,
            secondary_offsets=offsets.secondary_offsets,
            zero_offsets=offsets.zero_offsets,
            r_parameters=offsets.r_parameters,
            input_states=input_states,
            block_delete=block_delete,
            is_strict=is_strict,
        ),
        offsets.mill_offsets,
    )


def read_stored_offsets() -> Offsets:
    """Return the offsets in the store, or empty offsets without a store.

    Raises CommandError if the store or an offset is damaged.
    """
    folder = find_data_folder()
    if not has_store(folder):
        return NO_OFFSETS
    from core.store.damaged_rows import TABLES_USED_BY_PROGRAMS
    from core.store.store import Store, StoreError

    with convert_to_command_error(StoreError), Store.open(folder, read_only=True) as store:
        damaged = store.find_damaged_rows(TABLES_USED_BY_PROGRAMS, {PRESET_SETTING, R_PARAMETERS_SETTING})
        if damaged:
            raise CommandError(damaged[0], "damaged-row")
        return read_store_offsets(store)


def read_stored_shapes() -> dict[int, ToolShape]:
    """Return the tool shapes in the store, or {} without a store.

    Raises CommandError if the store is damaged or a shape is invalid.
    """
    folder = find_data_folder()
    if not has_store(folder):
        return {}
    from app.desk.stored_shapes import describe_shape_mistakes, make_tool_shapes
    from core.store.store import Store, StoreError

    with convert_to_command_error(StoreError), Store.open(folder, read_only=True) as store:
        shapes, tools = store.offsets.tool_shapes.read_rows(), store.offsets.tool_offsets.read_rows()
    if wrong := describe_shape_mistakes(shapes, tools):
        remedy = "correct the shape on its page (F8) or with 'turndesk offsets set'"
        raise CommandError(
            Message(
                "a stored tool shape is invalid: {wrong}; {details}", wrong="; ".join(wrong), details=remedy
            ),
            "invalid-shape",
        )
    return make_tool_shapes(shapes, tools)


def try_read_shapes() -> dict[int, ToolShape]:
    """Return the stored tool shapes for a picture, or {} if the store cannot be read.

    The error is not reported here, because other functions report it.
    """
    try:
        return read_stored_shapes()
    except CommandError:
        return {}


def read_store_offsets(store: Store) -> Offsets:
    """Return the offsets of an open store."""
    tables = store.offsets
    found = _of_rows(
        tables.tool_offsets.read_rows(), tables.secondary_offsets.read_rows(), tables.zero_offsets.read_rows()
    )
    presets = tables.presets.read_rows()
    preset = find_active_preset(store.settings.read_setting(PRESET_SETTING), presets)
    r = parse_r_parameters(store.settings.read_setting(R_PARAMETERS_SETTING))
    return found._replace(
        mill_offsets=MillOffsets(tables.mill_tools.read_rows(), presets, preset), r_parameters=r
    )


def read_offsets_file(path: Path) -> Offsets:
    """Return the offsets in an offsets file. Raises CommandError that lists every error."""
    from app.offsets.offsets_file import read_offset_rows

    tools, secondary, zero = read_offset_rows(path)
    return _of_rows(tools, secondary, zero)._replace(mill_offsets=MillOffsets(make_mill_rows(tools)))


def make_offsets_reader(path: str | None) -> Callable[[], Offsets]:
    """Return a function that reads the offsets of a file, or the stored offsets if ``path`` is None.

    The function reads the store again at each call.
    """
    return read_stored_offsets if path is None else partial(read_offsets_file, Path(path))


def create_offset_book(load_offsets: Callable[[], Offsets], journal: Journal | None) -> OffsetBook:
    """Return the offset book that the operator screen shows.

    With a ``journal``, and if ``load_offsets`` is ``read_stored_offsets``, the book has the offsets of the
    journal's store. Otherwise the book is read-only and has the offsets that ``load_offsets`` returns, such
    as those of a file. Raises CommandError if ``load_offsets`` finds errors.
    """
    if journal is not None and load_offsets is read_stored_offsets:
        return journal.book()
    from app.offsets.offset_book import OffsetBook

    tools, secondary, zero, mill, _ = load_offsets()
    return OffsetBook(
        lock_reason=OFFSETS_FILE_TEXT,
        tool_offsets={
            n: ToolOffsetRow(row.x, row.z, row.nose_radius, quadrant=row.quadrant, remark=row.name)
            for n, row in tools.items()
        },
        secondary_offsets={
            n: SecondaryOffsetRow(row.x, row.z, row.nose_radius) for n, row in secondary.items()
        },
        zero_offsets={n: ZeroOffsetRow(row.x, row.z, row.c) for n, row in zero.items()},
        mill_tools=dict(mill.tools),
        presets=dict(mill.presets),
        active_preset=mill.active_preset,
    )


def _of_rows(
    tools: Mapping[int, ToolOffsetRow],
    secondary: Mapping[int, SecondaryOffsetRow],
    zero: Mapping[int, ZeroOffsetRow],
) -> Offsets:
    settable = {code: ZeroOffset(*row) for code, row in zero.items()}
    return Offsets(make_tool_offsets(tools), make_secondary_offsets(secondary), settable)
