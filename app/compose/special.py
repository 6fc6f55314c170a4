"""The special functions, the list of programs and the settings of a desk: put together and given to it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from app.compose.transfer import PLAIN, SerialLines, proving
from app.desk.desk import Desk
from app.desk.editing.worker import Worker
from app.desk.files.chooser import Chooser
from app.desk.files.files import FilesDesk
from app.desk.files.preview import Preview
from app.desk.files.record import RunRecord
from app.desk.files.traffic import Traffic
from app.desk.home import home
from app.desk.keep import Keep
from app.desk.session import Workshop
from app.desk.settings import SettingsBook
from app.desk.special.counter import PartCounter
from app.desk.special.drives import DrivesSection
from app.desk.special.events import EventsSection
from app.desk.special.keeping import KeepingSection
from app.desk.special.machine_file import MachineFileSection
from app.desk.special.parts import PartsSection
from app.desk.special.preferences import PreferencesSection
from app.desk.special.sheet import Section
from app.desk.special.signals import SignalsSection
from app.desk.special.special import SpecialDesk
from app.desk.special.speed import SpeedSection
from app.desk.transfer.section import TransferSection
from core.machine.model import Machine

MakeSection = Callable[[Desk, Machine, Keep, Worker], Section]


def _keeping(desk: Desk, _machine: Machine, keep: Keep, worker: Worker) -> Section:
    section = KeepingSection(desk, keep, worker, home() / "backups")

    def restored() -> None:
        desk.settings.reload()
        desk.counter.reload()

    section.restored = restored
    return section


def _transfer(desk: Desk, machine: Machine, keep: Keep, workshop: Workshop, own: Path) -> Section:
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


def furnish(desk: Desk, machine: Machine, keep: Keep, workshop: Workshop, own: Path | None = None) -> None:
    """Give the desk what it remembers, and the pages that show it.

    ``workshop`` keeps nothing of what it proves; ``own`` is the operator's folder.
    """
    desk.settings = SettingsBook(keep)
    desk.counter = PartCounter(keep)
    desk.record = RunRecord(keep)
    worker = Worker()
    own = own or home() / "programs"
    sections = [make(desk, machine, keep, worker) for make in ITEMS]
    sections.append(_transfer(desk, machine, keep, workshop, own))
    desk.special = SpecialDesk(sections, worker)
    desk.files = _files(desk, keep, workshop, own)


def _files(desk: Desk, keep: Keep, workshop: Workshop, own: Path) -> FilesDesk:
    """The list of programs; what comes in is proved with the offsets of that moment."""

    def check(path: Path) -> str:
        job = workshop.make_job(workshop.read(path), False)
        proved = workshop.prove(job, lambda _count: None)
        errors = proved.proof.errors
        result = f"{len(errors)} ERRORS: {errors[0]}" if errors else "PROVED"
        keep.program_proved(path.name, result, None if errors else proved.proof.cycle_time)
        return errors[0] if errors else ""

    worker = Worker()
    traffic = Traffic(desk, own, keep, worker, check, Chooser(Path.home()))
    return FilesDesk(desk, own, keep, worker, Preview(workshop), traffic, lambda: desk.session.now)
