"""From an empty store to the third part on a mill and on a SINUMERIK lathe: touch-off, MDI, a broken tool."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from core.store.store import Store
from tests.stories.conftest import Story
from tests.stories.operator import Operator
from tests.texts import fragment
from tests.texts import text as wording

# Zero lies where the tip stands; line 4 and block N50 go slowly enough for any hand.
KLARTEXT = (
    "BEGIN PGM AGAIN MM\nTOOL CALL 1 Z S900 F600\nL X+0 Y+0 Z+1 R0 FMAX\nL Z-1 F600\nL X+3 F60\n"
    "L Y+1 F600\nL Z+1 FMAX\nM30\nEND PGM AGAIN MM\n"
)
SINUMERIK = (
    "N10 G54 G90 G94 G71 DIAMON\nN20 T1 D1\nN30 G0 X6 Z1\nN40 G1 Z-1 F600\nN50 X10 F60\nN60 G0 Z1\nN70 M30\n"
)


def on_the_shelf(story: Story, name: str, text: str) -> None:
    programs = story.home / "programs"
    programs.mkdir(parents=True)
    (programs / name).write_text(text)


def preset_is(axis: str, wanted: float, store: Store) -> bool:
    return bool(getattr(store.offsets.presets.read_rows().get(1), axis, 0.0) == wanted)


def kept(operator: Operator, what: Callable[[Store], bool]) -> None:
    """Wait until the store has it: what was touched off is on the disk."""

    def there() -> bool:
        with operator.store() as store:
            return what(store)

    operator.until(there, f"kept: {what}")


def means(operator: Operator) -> None:
    """Y to the question about a large change."""
    question = fragment("offsets.suspicious")
    operator.sees(question)
    operator.until(lambda: operator.says_yes(lambda: not operator.shows(question)), question)


def mdi(operator: Operator, line: str, done: Callable[[], bool]) -> None:
    """A line of MDI, proved and started."""
    operator.key("F1")
    operator.opens("MAIN MENU")
    operator.key("F4")
    operator.opens("MDI")
    operator.enters(line)
    operator.sees(fragment("stories.line-ready"))
    operator.cycle_start()
    operator.until(done, line)


def loads(operator: Operator, name: str) -> None:
    operator.key("F1")
    operator.opens("MAIN MENU")
    operator.key("F2")
    operator.opens("AUTOMATIC")
    operator.key("F2")
    operator.sees(wording("screen.file-to-be-processed"))
    operator.enters(name)


def makes(operator: Operator, parts: int) -> None:
    operator.starts()
    operator.lets_it_run(lambda: operator.machine["parts"] == parts, f"part {parts}")
    operator.reaches("READY")


def new_edge_on_lathe(operator: Operator) -> None:
    """The tip is jogged out in Z, and the new edge touched off: it is 2 mm shorter."""
    operator.key("F1")
    operator.key("F5")
    operator.opens("JOG")
    operator.jogs("Right", lambda: operator.slides[1] > 0.2, "Z clear")
    operator.rests(0.1)
    operator.key("F6")
    operator.enters(f"{operator.slides[1] + 2.0:.3f}")
    means(operator)
    kept(operator, lambda store: abs(store.offsets.tool_offsets.read_rows()[1].z + 2.0) < 0.01)
    operator.key("F1")
    operator.key("F2")
    operator.opens("AUTOMATIC")


def new_tool_on_mill(operator: Operator) -> None:
    """The new tool stands 2 mm higher than the broken one would: it is so much shorter."""
    operator.key("F8")
    operator.opens("TOOL TABLE")  # it stands at L of T1, where it was left
    operator.writes("1")
    operator.key("F2")
    means(operator)
    kept(operator, lambda store: abs(store.offsets.mill_tools.read_rows()[1].length - 78.0) < 0.01)
    operator.key("F1")
    operator.key("F2")
    operator.opens("AUTOMATIC")


def breaks_and_goes_on(
    operator: Operator, line: int, again: int, touched_off: Callable[[Operator], None]
) -> None:
    """The tool breaks in the slow line: pause, reset, another is touched off; SEARCHTO goes on at a line."""
    operator.starts()
    operator.until(lambda: operator.machine["line"] == line, f"line {line}")
    operator.during(0.3)
    operator.key("h")
    operator.reaches("FEED HOLD")
    operator.answers("r", fragment("screen.give-up-program"), lambda: operator.state == "READY")
    touched_off(operator)
    operator.key("F6")
    operator.opens("SEARCHTO")
    operator.enters(str(again))
    operator.sees(wording("search.state-at-line", line=again))
    operator.key("F10")
    operator.sees(fragment("search.confirmed"))
    operator.cycle_start()
    operator.until(lambda: operator.state != "READY", "the start")


def test_parts_are_made_on_mill(story: Story) -> None:
    on_the_shelf(story, "again.h", KLARTEXT)
    operator = story.begins(machine="ac-table-mill.toml")
    operator.drives_on()
    operator.key("F8")
    operator.opens("TOOL TABLE")
    operator.key("Right")
    operator.writes(
        "270"
    )  # the tip stands on a gauge block: the nose is 350 over the zero of the machine file
    operator.key("F2")
    kept(
        operator,
        lambda store: (
            1 in store.offsets.mill_tools.read_rows()
            and store.offsets.mill_tools.read_rows()[1].length == 80.0
        ),
    )
    mdi(operator, "TOOL CALL 1 Z S900", lambda: operator.shows("T1 Z"))
    operator.key("F9")
    operator.opens("PRESETS")
    for axis, wanted in (("x", -1.0), ("y", -1.0), ("z", -81.0)):
        operator.writes("1")  # what the part shall read where the tip stands
        operator.key("F2")
        kept(operator, partial(preset_is, axis, wanted))
        operator.key("Right")
    operator.key("F3")
    operator.sees("active preset: 1")
    loads(operator, "again")
    makes(operator, 1)
    breaks_and_goes_on(operator, 5, 5, new_tool_on_mill)
    operator.reaches("READY")
    for part in range(operator.machine["parts"] + 1, 4):
        makes(operator, part)
    assert operator.is_at((2.0, 0.0, -2.0))


def test_parts_are_made_on_sinumerik_lathe(story: Story) -> None:
    on_the_shelf(story, "again.mpf", SINUMERIK)
    operator = story.begins(machine="sinumerik-modulo.toml")
    operator.drives_on()
    operator.key("F1")
    operator.key("F5")
    operator.opens("JOG")
    operator.key("t")
    operator.enters("1")
    for key, wanted in (("F5", "x"), ("F6", "z")):
        operator.key(key)
        operator.enters("0")  # the tip touches a part that is nothing wide, and its face
        operator.sees("T1")
        assert wanted in "xz"
    kept(operator, lambda store: 1 in store.offsets.tool_offsets.read_rows())
    operator.key("F9")
    operator.opens("ZERO OFFSETS")
    operator.key("Right")
    operator.writes("1")  # the face lies 1 behind the tip
    operator.key("F2")
    kept(
        operator,
        lambda store: (
            54 in store.offsets.zero_offsets.read_rows()
            and store.offsets.zero_offsets.read_rows()[54].z == -1.0
        ),
    )
    mdi(operator, "G54 T1 D1", lambda: operator.shows("T1 D1"))
    loads(operator, "again")
    makes(operator, 1)
    breaks_and_goes_on(operator, 5, 4, new_edge_on_lathe)  # line 5 begins in the work
    operator.reaches("READY")
    for part in range(operator.machine["parts"] + 1, 4):
        makes(operator, part)
    assert operator.is_at((5.0, -2.0))
