"""The disk is full in the middle of a batch: said as long as it lasts, and nothing of the batch is lost."""

from __future__ import annotations

from tests.store.disk import small_disk
from tests.stories.conftest import Story
from tests.texts import fragment, opening, text

SHORT = "G90G94T1\nM03S600\nG01X.1Z.1F30\nX0Z0\nM30\n"
TOOLS = {1: (0.0, 0.0)}


def test_parts_made_on_full_disk_are_stored_when_it_has_room(story: Story) -> None:
    with small_disk(story.home, size="3m") as disk:
        operator = story.begins(SHORT, tools=TOOLS)
        operator.drives_on()
        operator.key("c")
        operator.starts()
        operator.until(lambda: operator.machine["parts"] == 1, "the first part")
        disk.fill()
        operator.sees(text("screen.not-kept", why=opening("desk.disk-full")))
        operator.until(lambda: operator.machine["parts"] >= 4, "parts")
        operator.keys("F1", "F5")
        operator.opens("JOG")
        operator.sees(text("screen.not-kept", why=opening("desk.disk-full")))
        operator.sees(fragment("stories.held-in-memory"))
        operator.keys("F1", "F2")
        operator.key("c")
        operator.until(lambda: operator.state == "READY", "the end of the part")
        made = operator.machine["parts"]
        with operator.store() as store:
            assert store.runs.read_part_count("part.nc") < made
        operator.key("F4", "alt")
        operator.sees(fragment("stories.lost-by-closing"))
        operator.key("Escape")
        disk.make_room()
        operator.until(lambda: not operator.shows("NOT SAVED"), "all is kept")
        with operator.store() as store:
            assert store.runs.read_part_count("part.nc") == made
        assert len(operator.events("part")) == made
        operator.server.down("Alt_L", "F4")  # nobody is there any more to say that the key has come
        operator.server.up("F4", "Alt_L")
        operator.until(lambda: operator.popen.poll() == 0, "it closes")
