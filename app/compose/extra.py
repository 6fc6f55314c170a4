"""Optional features: the table in which they are registered, and the interface of a feature.

The code of a feature is in ``core/extras/NAME`` (without Qt), ``app/extras/NAME`` and ``tests/extras/NAME``.
``app.extras.NAME.extra`` contains ``EXTRA``, a subclass of ``Extra`` that overrides the parts that the
feature adds. No module outside a feature imports it. If its folders are deleted, TurnDesk works without the
feature.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from functools import cache
from importlib import import_module
from importlib.util import find_spec
from typing import TYPE_CHECKING, NamedTuple, TypeVar

if TYPE_CHECKING:
    from app.compose.backends.backend_entry import Answers, Connected
    from app.compose.runs.journal import Journal
    from app.desk.background_work import Latest
    from app.desk.desk import Desk
    from app.desk.page_description import PageEntry
    from app.desk.persistence import Persistence
    from app.desk.programs.program_loading import LoadingSteps
    from app.special.special_functions import SpecialFunction
    from core.executor.snapshot import Snapshot
    from core.json_key import Output
    from core.machine.machine_model import Machine
    from core.store.people import PersonRow
    from core.store.store import Store

NAMES = (
    *("access", "quality", "jobs", "pendant", "mtconnect", "office", "sharing", "analyses", "scheduler"),
    *("shapes", "drawings", "convert", "tool_tables"),
)
"""All optional features. A feature comes after the features that it needs."""

Tell = Callable[[str], None]
Close = Callable[[], None]
T = TypeVar("T")


class Subcommand(NamedTuple):
    """A subcommand of ``turndesk``: the subcommand that it follows in the help, and its help line."""

    follows: str
    help: str


class Extra:
    """Base class of an optional feature. A feature overrides only the parts that it adds.

    ``commands`` are its subcommands. The module of a subcommand is ``app.extras.NAME.SUBCOMMAND_command``.
    ``threads`` maps each supervised thread to the function that is lost when the thread ends.
    ``own_functions`` names the special functions that a page of the feature shows, so that F10 does not show
    them. ``needs`` names the features that this feature requires. ``proof_workers`` is the dotted name of a
    class of workers on other computers, which prove programs. ``drawings`` are the suffixes of drawings from
    which this feature makes programs; the list of programs shows them. ``editor_panel`` is the dotted name of
    a subclass of ``EditorPanel`` that replaces the editor's text area and writes lines. ``machine_actions``
    lists the actions of ``turndesk machine``, each with a module ``app.extras.NAME.ACTION_command``.
    ``machine_tables`` maps each module whose ``DRIVER`` declares tables of the machine file to the paths of
    these tables. ``tables_follow`` is the table of the machine file after which the tables of this feature
    are listed; empty lists them last.
    """

    needs: Sequence[str] = ()
    commands: Mapping[str, Subcommand] = {}
    machine_actions: Sequence[str] = ()
    threads: Mapping[str, str] = {}
    proof_workers = ""
    drawings: Sequence[str] = ()
    editor_panel: str = ""
    machine_tables: Mapping[str, tuple[str, ...]] = {}
    tables_follow: str = ""
    own_functions: Collection[str] = ()

    @property
    def pages(self) -> Sequence[PageEntry]:
        """The pages of the main window that this feature adds."""
        return ()

    def wired(self, machine: Machine) -> Machine:
        """Return the machine without the inputs that this feature provides, as its backend is wired."""
        return machine

    def connect(self, machine: Machine, connected: Connected) -> Connected:
        """Add what this feature provides to the ports of a connected machine."""
        return connected

    def attach(self, desk: Desk, machine: Machine, journal: Journal | None, work: LoadingSteps) -> None:
        """Attach the models of this feature to the operator screen; without a ``journal`` nothing is saved.

        ``work`` reads and proves programs with the present offsets, and saves nothing.
        """

    def special_functions(
        self, desk: Desk, machine: Machine, persistence: Persistence, worker: Latest
    ) -> Sequence[tuple[SpecialFunction, str]]:
        """Return the special functions (F10) of this feature.

        Each function has the name of its predecessor in the list.
        """
        return ()

    def extend(self, part: object, desk: Desk, machine: Machine) -> None:
        """Extend ``part``, a model of a required feature, when that model is created."""

    def start(self, desk: Desk, journal: Journal, tell: Tell) -> Close | None:
        """Start the threads of this feature; return the function that ends them, or None.

        The callback reports on the prompt line and in the event log why the feature cannot run.
        """

    def start_headless(
        self, machine: Machine, snapshot: Callable[[], Snapshot], tell: Tell, *, paced: bool
    ) -> Close | None:
        """Start the services of this feature for a run without a screen; return the function that ends them.

        ``paced`` means that the run takes as long as on the machine. The callback prints the reason if the
        feature cannot run.
        """

    def json_outputs(self) -> Mapping[str, Sequence[Output]]:
        """Return the declared outputs of --json of this feature.

        The keys are the outputs that they follow in the reference.
        """
        return {}

    def words(self) -> Sequence[str]:
        """Return screen texts that look like names in the source, for the list of all texts."""
        return ()

    def floor_outputs(self) -> Sequence[Output]:
        """Return the declared data that this feature sends to the shop network.

        ``command`` is the title of the section in the reference.
        """
        return ()

    def demand_pin(self, store: Store, row: PersonRow, remedy: str) -> bool:
        """Ask for the PIN of this user on the command line.

        The result is False if this feature does not support PINs. ``remedy`` is the instruction for a user
        without a PIN. Raises CommandError if the PIN is wrong.
        """
        return False

    def check(self, machine: Machine, answers: Answers) -> None:
        """Add the rows of this feature to ``turndesk machine check``."""


@cache
def extras() -> Mapping[str, Extra]:
    """Return the optional features that are installed, by name."""
    found: dict[str, Extra] = {}
    for name in NAMES:
        if _is_installed(name):
            extra: Extra = import_module(f"app.extras.{name}.extra").EXTRA
            if found.keys() >= set(extra.needs):
                found[name] = extra
    return found


def _is_installed(name: str) -> bool:
    """Return whether the feature has its module; a folder with only cache files has none."""
    return find_spec(f"app.extras.{name}") is not None and find_spec(f"app.extras.{name}.extra") is not None


def command_modules() -> Mapping[str, str]:
    """Return the module of each subcommand that an optional feature adds."""
    return _modules(lambda extra: extra.commands)


def action_modules() -> Mapping[str, str]:
    """Return the module of each action of ``turndesk machine`` that an optional feature adds."""
    return _modules(lambda extra: extra.machine_actions)


def _modules(words_of: Callable[[Extra], Iterable[str]]) -> Mapping[str, str]:
    return {
        word: f"app.extras.{name}.{word}_command"
        for name, extra in extras().items()
        for word in words_of(extra)
    }


def proof_workers() -> str:
    """Return the dotted name of the class of workers on other computers; empty without such a feature."""
    return next((extra.proof_workers for extra in extras().values() if extra.proof_workers), "")


def drawing_endings() -> tuple[str, ...]:
    """Return the suffixes of all drawings from which an optional feature makes programs."""
    return tuple(ending for extra in extras().values() for ending in extra.drawings)


def insert_after(items: Iterable[T], name_of: Callable[[T], str], added: Iterable[tuple[T, str]]) -> list[T]:
    """Return ``items`` with each item of ``added`` inserted after the item that its pair names.

    That item may also be an addition. Additions that follow the same item retain their order. If no item has
    that name, the addition is appended.
    """
    found, waiting = list(items), list(added)
    newest: dict[str, str] = {}
    while waiting:
        names = [name_of(each) for each in found]
        item, after = next((pair for pair in waiting if pair[1] in names), waiting[0])
        waiting.remove((item, after))
        place = newest.get(after, after)
        found.insert(names.index(place) + 1 if place in names else len(found), item)
        newest[after] = name_of(item)
    return found
