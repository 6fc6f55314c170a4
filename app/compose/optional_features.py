"""Table of the installed optional features, and interface of a feature.

The code of a feature is in ``core/extras/NAME`` (without Qt), ``app/extras/NAME`` and
``tests/extras/NAME``. ``app.extras.NAME.extra`` contains ``EXTRA``, a subclass of ``OptionalFeature`` that
overrides the members that the feature adds. Modules outside a feature do not import the feature. If its
folders are deleted, TurnDesk works without the feature.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from functools import cache
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple, TypeVar

if TYPE_CHECKING:
    from app.compose.backends.backend_entry import ConnectedMachine, MachineCheckResults
    from app.compose.runs.journal import Journal
    from app.desk.background_work import LatestRequestWorker
    from app.desk.desk import Desk
    from app.desk.page_description import PageDescription
    from app.desk.persistence import Persistence
    from app.desk.programs.program_loading import LoadingSteps
    from app.special.special_functions import SpecialFunction
    from core.executor.snapshot import Snapshot
    from core.json_keys import JsonOutput
    from core.machine.machine_model import Machine
    from core.store.store import Store
    from core.store.user_records import UserRow

FEATURE_NAMES = (
    *("access", "quality", "jobs", "pendant", "mtconnect", "office", "sharing", "analyses", "scheduler"),
    *("shapes", "drawings", "convert", "tool_tables", "lessons", "tour"),
)
"""Names of all optional features, ordered so that each feature follows the features that it needs."""

ReportFunction = Callable[[str], None]
CloseFunction = Callable[[], None]
T = TypeVar("T")


class Subcommand(NamedTuple):
    """Entry for a subcommand in the help of ``turndesk``.

    ``preceding_subcommand`` is the subcommand listed above it, and ``help_line`` is its help text.
    """

    preceding_subcommand: str
    help_line: str


class OptionalFeature:
    """Base class of an optional feature. A feature overrides only the members that it adds.

    - ``subcommands`` have the modules ``app.extras.NAME.SUBCOMMAND_command``.
    - ``supervised_threads`` maps each supervised thread to the function lost if the thread ends.
    - ``own_special_functions`` names the special functions that a page of the feature shows. They
      are not in the F10 list.
    - ``required_features`` names the features that this feature requires.
    - ``worker_class_name`` is the dotted class name of workers that prove programs on other
      computers.
    - ``drawing_suffixes`` are the suffixes of drawings from which this feature makes programs.
      The program list also shows files with these suffixes.
    - ``editor_panel_class`` is the dotted name of an ``EditorPanel`` subclass. Its panel replaces
      the text area of the editor and writes lines.
    - ``opening_show_class`` is the dotted name of an ``OpeningShow`` class, which the window can show
      before the operator screen.
    - ``machine_actions`` are actions of ``turndesk machine``
      (``app.extras.NAME.ACTION_command``).
    - ``machine_tables`` maps each module whose ``DRIVER`` declares machine file tables to the
      paths of these tables.
    - ``preceding_table`` is the machine file table listed before the tables of this feature, or
      empty to list them last.
    """

    required_features: Sequence[str] = ()
    subcommands: Mapping[str, Subcommand] = {}
    machine_actions: Sequence[str] = ()
    supervised_threads: Mapping[str, str] = {}
    worker_class_name = ""
    drawing_suffixes: Sequence[str] = ()
    editor_panel_class: str = ""
    opening_show_class: str = ""
    machine_tables: Mapping[str, tuple[str, ...]] = {}
    preceding_table: str = ""
    own_special_functions: Collection[str] = ()

    @property
    def page_descriptions(self) -> Sequence[PageDescription]:
        """Return the descriptions of the pages that this feature adds to the main window."""
        return ()

    def remove_own_inputs(self, machine: Machine) -> Machine:
        """Return a copy of the machine without the inputs that this feature provides.

        The backend of the machine is not wired to these inputs.
        """
        return machine

    def add_ports(self, machine: Machine, connected: ConnectedMachine) -> ConnectedMachine:
        """Return the connected machine with the ports that this feature provides."""
        return connected

    def attach_models(
        self, desk: Desk, machine: Machine, journal: Journal | None, loading_steps: LoadingSteps
    ) -> None:
        """Attach the models of this feature to the operator screen.

        Without a ``journal``, nothing is saved.

        ``loading_steps`` reads and proves programs with the current offsets and saves nothing.
        """

    def list_special_functions(
        self, desk: Desk, machine: Machine, persistence: Persistence, worker: LatestRequestWorker
    ) -> Sequence[tuple[SpecialFunction, str]]:
        """Return the special functions (F10) of this feature.

        Each function is paired with the name of the function that precedes it in the list.
        """
        return ()

    def begins_with_show(self, folder: Path) -> bool:
        """Return whether the show of this feature precedes the screen of the demo.

        ``folder`` is the data folder of the demo.
        """
        return False

    def extend_model(self, model: object, desk: Desk, machine: Machine) -> None:
        """Extend ``model``, the model of a required feature, when that model is created."""

    def start_services(
        self, desk: Desk, journal: Journal, report_reason: ReportFunction
    ) -> CloseFunction | None:
        """Start the threads of this feature, and return the function that ends them.

        The result is None if the feature has no threads. If the feature cannot run, ``report_reason`` shows
        the reason on the prompt line and in the event log.
        """

    def start_headless_services(
        self,
        machine: Machine,
        read_snapshot: Callable[[], Snapshot],
        report_reason: ReportFunction,
        *,
        is_real_time: bool,
    ) -> CloseFunction | None:
        """Start the services of this feature for a program run without a screen.

        Returns the function that ends the services, or None if there are no services. ``is_real_time``
        means that the run takes as long as on the machine. ``report_reason`` prints the reason if the
        feature cannot run.
        """

    def list_json_outputs(self) -> Mapping[str, Sequence[JsonOutput]]:
        """Return the JSON outputs that this feature adds to --json.

        Each key is the existing output that the new outputs follow in the reference page.
        """
        return {}

    def words(self) -> Sequence[str]:
        """Return screen texts that look like identifiers in the source but must be listed as texts."""
        return ()

    def list_shop_outputs(self) -> Sequence[JsonOutput]:
        """Return descriptions of the data that this feature sends to the shop network.

        The member ``command`` of each description is the title of its section in the reference.
        """
        return ()

    def require_pin(self, store: Store, user_row: UserRow, remedy: str) -> bool:
        """Ask for the PIN of this user on the command line, and return whether this feature supports PINs.

        ``remedy`` is the instruction for a user without a PIN. Raises CommandError if no PIN is stored or
        the PIN is wrong.
        """
        return False

    def add_check_rows(self, machine: Machine, results: MachineCheckResults) -> None:
        """Add the rows of this feature to the results of ``turndesk machine check``."""


@cache
def extras() -> Mapping[str, OptionalFeature]:
    """Return the installed optional features by name."""
    found: dict[str, OptionalFeature] = {}
    for name in FEATURE_NAMES:
        if _is_installed(name):
            extra: OptionalFeature = import_module(f"app.extras.{name}.extra").EXTRA
            if found.keys() >= set(extra.required_features):
                found[name] = extra
    return found


def _is_installed(name: str) -> bool:
    """Return whether the module of the feature exists.

    A folder that contains only cache files does not count as an installed feature.
    """
    return find_spec(f"app.extras.{name}") is not None and find_spec(f"app.extras.{name}.extra") is not None


def map_command_modules() -> Mapping[str, str]:
    """Return the module name of each subcommand that an optional feature adds."""
    return _modules(lambda extra: extra.subcommands)


def map_action_modules() -> Mapping[str, str]:
    """Return the module name of each action of ``turndesk machine`` that an optional feature adds."""
    return _modules(lambda extra: extra.machine_actions)


def _modules(words_of: Callable[[OptionalFeature], Iterable[str]]) -> Mapping[str, str]:
    return {
        word: f"app.extras.{name}.{word}_command"
        for name, extra in extras().items()
        for word in words_of(extra)
    }


def find_worker_class_name() -> str:
    """Return the dotted class name of the workers that prove programs on other computers.

    The name is empty if no feature provides such a class.
    """
    return next((extra.worker_class_name for extra in extras().values() if extra.worker_class_name), "")


def list_drawing_suffixes() -> tuple[str, ...]:
    """Return the suffixes of all drawings from which an optional feature makes programs."""
    return tuple(ending for extra in extras().values() for ending in extra.drawing_suffixes)


def insert_items_after(
    items: Iterable[T], get_name: Callable[[T], str], additions: Iterable[tuple[T, str]]
) -> list[T]:
    """Return ``items`` with each addition inserted after the item whose name it specifies.

    The named item may also be an addition. Additions that follow the same item retain their order. An
    addition is appended if no item has the name.
    """
    found, waiting = list(items), list(additions)
    newest: dict[str, str] = {}
    while waiting:
        names = [get_name(each) for each in found]
        item, after = next((pair for pair in waiting if pair[1] in names), waiting[0])
        waiting.remove((item, after))
        place = newest.get(after, after)
        found.insert(names.index(place) + 1 if place in names else len(found), item)
        newest[after] = get_name(item)
    return found
