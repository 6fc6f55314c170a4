"""Drawing a program in the frame of other offsets than its own: what a change of offsets does to its path."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

from core.executor.job import Job
from core.interpreter.job_setup import ToolOffset
from core.machine.model import Machine

if TYPE_CHECKING:
    from app.desk.latest import Watch
    from app.offsets.effect import Draw
    from app.path.path_picture import Picture, Timed


def drawer(machine: Machine) -> Draw:
    """Draws a job on this machine, each tool in the frame of the offset that is given for it."""

    def draw(job: Job, frame: Mapping[int, ToolOffset], watch: Watch) -> Picture:
        from app.path.path_picture import sketched
        from core.proving.program_timeline import Timeline, timed_blocks

        blocks = timed_blocks(Timeline.of(job.reading, job.setup, machine))
        return sketched(_seen(blocks, frame), watch)

    return draw


def _seen(blocks: Iterator[Timed], frame: Mapping[int, ToolOffset]) -> Iterator[Timed]:
    """The same blocks, with part zero where the offsets of ``frame`` have it."""
    for block, start, end in blocks:
        modal = block.modal
        offset = frame.get(modal.tool, ToolOffset())
        if (modal.tool_x, modal.tool_z) == (offset.x, offset.z):
            yield block, start, end
        else:
            yield replace(block, modal=modal._replace(tool_x=offset.x, tool_z=offset.z)), start, end
