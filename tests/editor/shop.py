"""An editor in a temporary folder: the real prover, and an archive in memory."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from hashlib import sha256
from pathlib import Path

from app.compose.machine.machine_files import load_machine
from app.compose.machine.machine_setup import create_power_up_setup
from app.compose.program_proving import create_proof
from app.desk.background_work import ProgressCallback
from app.desk.programs.program_loading import LoadingSteps, ProvedJob
from app.editor.editor_model import ClosedProgram, EditorModel
from app.path.path_picture import ProgramPicture, build_picture
from core.executor.job import Job
from core.interpreter.dialects import SharedProgram
from core.interpreter.shared.job_setup import ToolOffset
from core.language.source import ProgramSource, load_source
from core.proving.program_timeline import Timeline, iter_timed_blocks
from core.proving.prove_program import prove
from core.store.store_errors import StoreError
from core.store.store_rows import ProgramVersionRow

GOOD = "G90G94F300G72\nT1\nM03S1000\nX1Z.1\nZ-.5\nM05\nM30\n"
TOOLS = {1: ToolOffset(-12.7, -76.2)}


@dataclass
class Memory:
    """Versions as the store keeps them: the same text again is no new one."""

    kept: dict[str, list[tuple[bytes, str]]] = field(default_factory=dict)
    full: bool = False

    def versions(self, name: str) -> tuple[ProgramVersionRow, ...]:
        rows = [
            ProgramVersionRow(n, sha256(text).hexdigest(), "2026-03-01T10:00:00.000Z", why, len(text))
            for n, (text, why) in enumerate(self.kept.get(name, []), 1)
        ]
        return tuple(reversed(rows))

    def read_version_text(self, name: str, version: int) -> bytes:
        return self.kept[name][version - 1][0]

    def save_version(self, name: str, text: bytes, reason: str) -> int:
        if self.full:
            raise StoreError("the disk is full")
        rows = self.kept.setdefault(name, [])
        if not rows or rows[-1][0] != text:
            rows.append((text, reason))
        return len(rows)


def workshop() -> LoadingSteps:
    """The real interpreter and prover on the shipped lathe."""
    lathe = load_machine(None)

    def make_job(source: ProgramSource, block_delete: bool) -> Job:
        setup = create_power_up_setup(
            lathe, tool_offsets=TOOLS, secondary_offsets={}, block_delete=block_delete
        )
        return Job(source, setup, source.text, SharedProgram(source), frozenset(TOOLS))

    def proved(job: Job, watch: ProgressCallback) -> ProvedJob:
        report = prove(job.source, job.setup, lathe, watch)
        return ProvedJob(create_proof(job, report), report.diagnostics)

    def draw(job: Job, watch: ProgressCallback) -> ProgramPicture:
        return build_picture(iter_timed_blocks(Timeline.from_program(job.source, job.setup, lathe)), watch)

    return LoadingSteps(load_source, make_job, proved, draw)


def editor_in(
    folder: Path, archive: Memory | None = None, left: Callable[[ClosedProgram], None] = lambda _: None
) -> EditorModel:
    """The operator's programs and the samples, both empty at first."""
    (folder / "samples").mkdir(exist_ok=True)
    return EditorModel(workshop(), archive or Memory(), folder / "programs", folder / "samples", left)
