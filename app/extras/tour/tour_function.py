"""Special function TOUR, which starts the tour in a separate window."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Mapping
from contextlib import suppress

from app.desk.desk import Desk
from app.desk.pages.table_content import FunctionKey, TableContent, TableRow
from app.desk.status.prompt_line import ACTIVE_STATES
from app.extras.tour.tour_command import FROM_SCREEN_OPTION
from app.extras.tour.tour_setup import SHOWN_SETTING
from app.special.special_functions import SpecialFunction
from core.executor.snapshot import Snapshot
from core.process_environment import make_module_environment

_SIMULATED_ONLY = "THE TOUR RUNS ONLY ON A SIMULATED MACHINE"
_END_TIMEOUT_S = 2.0  # Seconds that TurnDesk waits for the end of the tour when it closes.
_ROWS = (
    ("1", "A PART IS TURNED, THREADED, MILLED WITH C AND PARTED OFF"),
    ("2", "A WEAR CORRECTION"),
    ("3", "A CRASH FOUND BEFORE IT HAPPENS"),
)


class TourFunction(SpecialFunction):
    """Special function that starts the tour in another process, which has its own simulated lathe.

    The machine, the program and the offsets of this screen do not take part in the tour.
    """

    name = "TOUR"
    use = "watch a part being made"

    def __init__(self, desk: Desk, *, is_simulated: bool) -> None:
        super().__init__(desk)
        self._is_simulated = is_simulated
        self._process: subprocess.Popen[bytes] | None = None

    def make_table(self, _snapshot: Snapshot) -> TableContent:
        """Return the table with the contents of the tour."""
        note = "ENTER: START THE TOUR. ANY KEY OR TOUCH ENDS IT" if self._is_simulated else _SIMULATED_ONLY
        return TableContent("TOUR", ("", ""), (0.07, 0.93), tuple(map(TableRow, _ROWS)), notes=(note,))

    def make_function_keys(self) -> Mapping[str, FunctionKey]:
        """Return the key that starts the tour."""
        return {"F2": FunctionKey("BEGIN", self.start_tour, barred=not self._is_simulated)}

    def activate_selected_row(self) -> bool:
        """Start the tour."""
        self.start_tour()
        return True

    def find_refusal(self) -> str:
        """Return the reason why the tour cannot start now, or an empty string if it can start."""
        if not self._is_simulated:
            return _SIMULATED_ONLY
        if self.desk.window_state.is_kiosk:
            return "IN KIOSK MODE, THE TOUR CANNOT BE STARTED"
        if self.desk.read_snapshot().state in ACTIVE_STATES:
            return "FIRST STOP THE PROGRAM, AND PRESS R"
        if self._process is not None and self._process.poll() is None:
            return "THE TOUR IS RUNNING IN ITS OWN WINDOW"
        return ""

    def start_tour(self) -> None:
        """Start the tour, or show the reason why it cannot start."""
        self.desk.clear_prompt_line()
        if refusal := self.find_refusal():
            self.desk.show_refusal(refusal)
            return
        try:
            self._process = subprocess.Popen(
                [sys.executable, "-m", "app.cli.main", "tour", FROM_SCREEN_OPTION],
                env=make_module_environment(),
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                start_new_session=True,
            )
        except OSError as error:  # for example, no memory for another process
            self.desk.show_refusal(error.strerror or str(error))
            return
        self.desk.show_success("THE TOUR OPENS IN ITS OWN WINDOW")
        persistence = self.desk.settings_store.persistence
        self.desk.try_save(lambda: persistence.save_setting(SHOWN_SETTING, True))

    def close(self) -> None:
        """End the tour when TurnDesk closes."""
        if self._process is not None and self._process.poll() is None:
            self._process.terminate()
            with suppress(subprocess.TimeoutExpired):  # It ends its machine later, without this screen.
                self._process.wait(_END_TIMEOUT_S)
