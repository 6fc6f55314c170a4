"""The special functions, the list of programs and the settings of a desk: put together and given to it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from app.compose.program_transfer import PLAIN, SerialLines, proving
from app.desk.data_folder import data_folder
from app.desk.desk import Desk
from app.desk.latest import Latest
from app.desk.persistence import Persistence
from app.desk.program_loading import LoadingSteps
from app.desk.screen_settings import SettingsBook
from app.programs.folder_chooser import Chooser
from app.programs.import_export import Traffic
from app.programs.preview import Preview
from app.programs.program_list import FilesDesk
from app.programs.run_record import RunRecord
from app.special.backup import KeepingSection
from app.special.drive_status import DrivesSection
from app.special.event_log import EventsSection
from app.special.inputs_outputs import SignalsSection
from app.special.machine_file_acceptance import MachineFileSection
from app.special.part_count import PartCounter
from app.special.parts_counter import PartsSection
from app.special.preferences import PreferencesSection
from app.special.section import Section
from app.special.special_functions import SpecialDesk
from app.special.spindle_limit import SpeedSection
from app.transfer.serial_transfer import TransferSection
from core.machine.machine_model import Machine

MakeSection = Callable[[Desk, Machine, Persistence, Latest], Section]


def _keeping(desk: Desk, _machine: Machine, keep: Persistence, worker: Latest) -> Section:
    section = KeepingSection(desk, keep, worker, data_folder() / "backups")

    def restored() -> None:
        desk.settings.reload()
        desk.counter.reload()

    section.restored = restored
    return section


def _transfer(desk: Desk, machine: Machine, keep: Persistence, workshop: LoadingSteps, own: Path) -> Section:
    """RS-232, at first as [dnc] of the machine file says. What comes in is proved as an import is."""
    ending = {"mill": ".h"}.get(machine.kind, ".nc")
    lines = SerialLines(proving(workshop), ending)
    return TransferSection(desk, keep, lines, machine.hardware.dnc or PLAIN, own)


# One line for each special function, in the order of the list; one whose hardware is not there has none.
ITEMS: tuple[MakeSection, ...] = (
    lambda desk, machine, _keep, _worker: SpeedSection(desk, machine.spindle),
    lambda desk, _machine, _keep, _worker: PartsSection(desk),
    lambda desk, machine, _keep, _worker: SignalsSection(desk, machine),
    lambda desk, machine, _keep, _worker: DrivesSection(desk, machine),
    lambda desk, _machine, keep, worker: EventsSection(desk, keep, worker),
    _keeping,
    lambda desk, _machine, _keep, _worker: PreferencesSection(desk),
    lambda desk, _machine, _keep, _worker: MachineFileSection(desk, desk.changes),
)


def furnish(
    desk: Desk, machine: Machine, keep: Persistence, workshop: LoadingSteps, own: Path | None = None
) -> None:
    """Give the desk what it remembers, and the pages that show it.

    ``workshop`` keeps nothing of what it proves; ``own`` is the operator's folder.
    """
    desk.settings = SettingsBook(keep)
    desk.counter = PartCounter(keep)
    desk.record = RunRecord(keep)
    worker = Latest("editing-special")
    own = own or data_folder() / "programs"
    sections = [make(desk, machine, keep, worker) for make in ITEMS]
    sections.append(_transfer(desk, machine, keep, workshop, own))
    desk.attach(SpecialDesk(sections, worker))
    desk.attach(_files(desk, keep, workshop, own))


def _files(desk: Desk, keep: Persistence, workshop: LoadingSteps, own: Path) -> FilesDesk:
    """The list of programs; what comes in is proved with the offsets of that moment."""

    def check(path: Path) -> str:
        job = workshop.make_job(workshop.read(path), False)
        proved = workshop.prove(job, lambda _count: None)
        errors = proved.proof.errors
        result = f"{len(errors)} ERRORS: {errors[0]}" if errors else "PROVED"
        keep.program_proved(path.name, result, None if errors else proved.proof.cycle_time)
        return errors[0] if errors else ""

    worker = Latest("editing-programs")
    traffic = Traffic(desk, own, keep, worker, check, Chooser(Path.home()))
    return FilesDesk(desk, own, keep, worker, Preview(workshop), traffic, lambda: desk.session.now)
