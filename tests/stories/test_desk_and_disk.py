"""What is on the desk and what is on the disk, and a window that somebody closes in a cut."""

from __future__ import annotations

import subprocess

from tests.stories.conftest import Story
from tests.texts import fragment

PART = "G90G94T1\nM03S600\nG01X.5Z.5F10\nX0Z0\nM30\n"
TOOLS = {1: (0.0, 0.0)}


def test_program_changed_on_disk_is_reported_before_start(story: Story) -> None:
    operator = story.begins(PART, tools=TOOLS)
    operator.drives_on()
    (story.folder / "part.nc").write_text(PART.replace("X.5", "X1.5"))
    operator.sees(fragment("programs.changed-on-disk"))
    operator.starts()
    operator.until(lambda: operator.slides[0] > 1.0, "a cut")
    (story.folder / "part.nc").unlink()  # what runs is the text that was proved
    operator.lets_it_run(lambda: operator.machine["parts"] == 1, "a part")
    assert max(seen["slides"][0] for seen in operator.seen) < 0.51 * 25.4
    operator.sees(fragment("programs.not-on-disk"))


def test_window_close_button_does_not_end_a_running_program(story: Story) -> None:
    operator = story.begins(PART, tools=TOOLS)
    operator.drives_on()
    operator.starts()
    operator.until(lambda: operator.slides[0] > 1.0, "a cut")
    close = ["xdotool", "key", "alt+F4"]
    subprocess.run(close, env=story.server.environment, check=True, capture_output=True)
    operator.sees(fragment("screen.program-runs-no-leaving"))
    assert operator.state == "RUNNING"
    operator.lets_it_run(lambda: operator.machine["parts"] == 1, "a part")
