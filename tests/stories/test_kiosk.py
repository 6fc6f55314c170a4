"""TurnDesk under the window manager of the kiosk, which leaves every key to it."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.stories.conftest import Story
from tests.stories.fork_server import ForkServer
from tests.stories.test_stop_keys import cutting
from tests.stories.x11 import Server

CONFIGURATION = Path(__file__).resolve().parents[2] / "resources/setup/debian/kiosk-openbox.xml"


@pytest.fixture
def kiosk(forks: ForkServer, tmp_path: Path) -> Story:
    """A server with the window manager of the kiosk."""
    server = Server(tmp_path / "x")
    server.manage("--config-file", str(CONFIGURATION))
    return Story(server, forks, tmp_path)


def test_kiosk_has_no_key_bindings_and_stop_key_acts_during_the_stall(kiosk: Story) -> None:
    operator = cutting(kiosk)
    try:
        for keys in ("alt+F4", "alt+Tab", "super+d", "ctrl+alt+Right"):
            operator.server.run("xdotool", "key", keys)
        operator.keeps(lambda: bool(operator.screen["active"]), 1.0, "the window with the keyboard")
        assert operator.state == "RUNNING"
        number = operator.freezes(3.0)
        operator.during(0.3)
        operator.once = True
        operator.key("Pause")
        operator.reaches("FEED HOLD")
        assert not operator.answered(number), "it acted only after the stall"
    finally:
        operator.leaves()
        kiosk.server.close()
