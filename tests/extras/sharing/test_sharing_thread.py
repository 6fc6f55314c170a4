"""The thread that looks: how long a place has been silent, by a clock of the test's own."""

from __future__ import annotations

import threading
from typing import cast

from app.extras.sharing.sharing import ProgramSharing, SharingResult, SharingThread


class Dead:
    """A place on a drive that answers when it is let, and the sharing that waits for it."""

    def __init__(self) -> None:
        self.asked, self.answers = threading.Event(), threading.Event()

    def synchronize(self, *, is_settled: bool) -> SharingResult:
        assert is_settled
        self.asked.set()
        assert self.answers.wait(60.0)
        return SharingResult()


def test_waiting_time_counts_until_a_hung_synchronization_ends() -> None:
    now, dead, heard = [100.0], Dead(), threading.Event()
    thread = SharingThread(cast("ProgramSharing", dead), 3600.0, lambda _shared: heard.set(), lambda: now[0])
    assert thread.get_waiting_time_s() == 0.0
    thread.start()
    assert dead.asked.wait(60.0)
    now[0] = 140.0
    assert thread.get_waiting_time_s() == 40.0
    dead.answers.set()
    assert heard.wait(60.0)
    assert thread.get_waiting_time_s() == 0.0
    thread.close()
