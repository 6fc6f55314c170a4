"""Tool, secondary and zero offsets from the store or an offsets file, for interpreter and screen."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, NamedTuple

from app.compose.machine.machine_setup import setup_for
from app.desk.command_errors import CommandError, as_command_error
from app.desk.data_folder import data_folder
from app.offsets.offsets_in_force import (
    PRESET,
    R_PARAMETERS,
    MillOffsets,
    preset_of,
    r_parameters,
    rows_of,
    secondary_offsets,
    tool_offsets,
    with_mill,
)
from core.interpreter.shared.job_setup import SecondaryOffset, Setup, ToolOffset, ZeroOffset
from core.message import Message
from core.store.store_file import has_store
from core.store.store_rows import SecondaryRow, ToolRow, ZeroRow

if TYPE_CHECKING:
    from app.compose.runs.journal import Journal
    from app.offsets.offset_book import OffsetBook
    from core.machine.machine_model import Machine
    from core.part.tool_shape import ToolShape
    from core.store.store import Store

OF_A_FILE = (
    "OFFSETS COME FROM A FILE (--offsets) AND ARE READ-ONLY. CHANGE THIS FILE, OR START WITHOUT THIS OPTION"
)


class Offsets(NamedTuple):
    """All offsets by number, in the interpreter's units: mm, X as a radius."""

    tools: Mapping[int, ToolOffset]
    secondary: Mapping[int, SecondaryOffset]
    zero: Mapping[int, ZeroOffset]
    mill: MillOffsets = MillOffsets()
    r: Mapping[int, float] = MappingProxyType({})  # =


NONE = Offsets({}, {}, {})


def setup_with(
    machine: Machine,
    offsets: Offsets,
    *,
    inputs: Mapping[str, bool] | None = None,
    block_delete: bool = False,
    strict: bool = False,
) -> Setup:
    """Return the context of a program after power-up with these offsets."""
    return with_mill(
        setup_for(
            machine,
            tools=offsets.tools,
            secondary=offsets.secondary,
            zero=offsets.zero,
            r=offsets.r,
            inputs=inputs,
            block_delete=block_delete,
            strict=strict,
        ),
        offsets.mill,
    )


def stored_offsets() -> Offsets:
    """Return the offsets of the store; empty without a store.

    Raises CommandError if the store or one of its offsets is damaged.
    """
    folder = data_folder()
    if not has_store(folder):
        return NONE
    from core.store.damaged_rows import OF_PROGRAMS
    from core.store.store import Store, StoreError

    with as_command_error(StoreError), Store.open(folder, read_only=True) as store:
        damaged = store.find_damaged_rows(OF_PROGRAMS, {PRESET, R_PARAMETERS})
        if damaged:
            raise CommandError(damaged[0], "damaged-row")
        return offsets_of(store)


def stored_shapes() -> dict[int, ToolShape]:
    """Return the tool shapes of the store; empty without a store.

    Raises CommandError if the store is damaged or a shape is invalid.
    """
    folder = data_folder()
    if not has_store(folder):
        return {}
    from app.desk.stored_shapes import tool_shapes, wrong_shapes
    from core.store.store import Store, StoreError

    with as_command_error(StoreError), Store.open(folder, read_only=True) as store:
        shapes, tools = store.offsets.shapes.read_rows(), store.offsets.tools.read_rows()
    if wrong := wrong_shapes(shapes, tools):
        way = "correct the shape on its page (F8) or with 'turndesk offsets set'"
        raise CommandError(
            Message(
                "a stored tool shape is invalid: {wrong}; {details}", wrong="; ".join(wrong), details=way
            ),
            "invalid-shape",
        )
    return tool_shapes(shapes, tools)


def shapes_at_hand() -> dict[int, ToolShape]:
    """Return the tool shapes for a picture; empty if the store cannot be read.

    The error is reported elsewhere.
    """
    try:
        return stored_shapes()
    except CommandError:
        return {}


def offsets_of(store: Store) -> Offsets:
    """Return the offsets of an open store."""
    tables = store.offsets
    found = _of_rows(tables.tools.read_rows(), tables.secondary.read_rows(), tables.zero.read_rows())
    presets = tables.presets.read_rows()
    preset = preset_of(store.settings.read_setting(PRESET), presets)
    r = r_parameters(store.settings.read_setting(R_PARAMETERS))
    return found._replace(mill=MillOffsets(tables.mill_tools.read_rows(), presets, preset), r=r)


def read_offsets(path: Path) -> Offsets:
    """Return the offsets of an offsets file. Raises CommandError with every error."""
    from app.offsets.offsets_file import read_rows

    tools, secondary, zero = read_rows(path)
    return _of_rows(tools, secondary, zero)._replace(mill=MillOffsets(rows_of(tools)))


def chosen_offsets(path: str | None) -> Callable[[], Offsets]:
    """Return a function that reads the offsets of a file, or for None those of the store.

    The store is read again at each call.
    """
    return stored_offsets if path is None else partial(read_offsets, Path(path))


def book_of(offsets: Callable[[], Offsets], journal: Journal | None) -> OffsetBook:
    """Return the offsets for the screen: those of the journal's store, or the read-only offsets of a file.

    Raises CommandError if the file has errors.
    """
    if journal is not None and offsets is stored_offsets:
        return journal.book()
    from app.offsets.offset_book import OffsetBook

    tools, secondary, zero, mill, _ = offsets()
    return OffsetBook(
        locked=OF_A_FILE,
        tools={
            n: ToolRow(row.x, row.z, row.nose_radius, quadrant=row.quadrant, remark=row.name)
            for n, row in tools.items()
        },
        secondary={n: SecondaryRow(row.x, row.z, row.r) for n, row in secondary.items()},
        zero={n: ZeroRow(row.x, row.z, row.c) for n, row in zero.items()},
        mill_tools=dict(mill.tools),
        presets=dict(mill.presets),
        preset=mill.preset,
    )


def _of_rows(
    tools: Mapping[int, ToolRow], secondary: Mapping[int, SecondaryRow], zero: Mapping[int, ZeroRow]
) -> Offsets:
    settable = {code: ZeroOffset(*row) for code, row in zero.items()}
    return Offsets(tool_offsets(tools), secondary_offsets(secondary), settable)
