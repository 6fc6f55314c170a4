"""Whatever is in a value stays in it, and whenever an agent comes it ends with the same picture."""

from __future__ import annotations

from hypothesis import given, settings
from hypothesis import strategies as st

from app.extras.mtconnect.driver.agent_links import (
    ActiveCondition,
    ItemValue,
    MachineReport,
    SentMachineState,
    make_values_line,
    replace_separators,
)
from app.extras.mtconnect.driver.mtconnect_adapter import make_devices_xml
from app.extras.mtconnect.driver.mtconnect_items import DataItemCategory
from drivers.wakeups import ManualClock
from tests.extras.mtconnect.agent import FakeAgent, tokens
from tests.extras.mtconnect.bench import BEGIN, lathe

AT = "2026-01-01T00:00:00.000Z"
ITEMS = tuple(lathe().iterate_items())
MODEL = make_devices_xml(lathe(), "bench", BEGIN)
TEXTS = st.one_of(
    st.text(max_size=40),
    st.text(alphabet='"|\\\n-* @:multine', max_size=40),
    st.sampled_from(["--multiline--", '"', '""', '"a"|', "* PONG 1", "@ASSET@", "unavailable", "\ud800"]),
)


@given(TEXTS, TEXTS)
def test_two_values_in_a_line_remain_separate(one: str, other: str) -> None:
    line = make_values_line(
        AT, {"block": replace_separators(one), "program": replace_separators(other), "line": "7"}
    )
    assert line.endswith("|line|7\n")
    assert line.count("\n") == 1
    assert "--multiline--" not in line
    assert line.splitlines() == [line[:-1]]
    found = tokens(line.rstrip("\n"))
    assert found[1::2] == ["block", "program", "line"]
    assert (found[2], found[4]) == (replace_separators(one), replace_separators(other))
    line.encode("utf-8")


def values() -> st.SearchStrategy[MachineReport]:
    """Reports with some of the items, sometimes the same again."""
    samples = [item.key for item in ITEMS if item.category is DataItemCategory.SAMPLE]
    events = [item.key for item in ITEMS if item.category is DataItemCategory.EVENT]
    conditions = [item.key for item in ITEMS if item.category is DataItemCategory.CONDITION]
    number: st.SearchStrategy[ItemValue] = st.one_of(st.none(), st.floats(-1e4, 1e4), st.just(0.0))
    text: st.SearchStrategy[ItemValue] = st.one_of(st.none(), TEXTS)
    active = st.builds(
        ActiveCondition, st.sampled_from(["FAULT", "WARNING"]), st.sampled_from(["101", "102", "hold"]), TEXTS
    )
    several = st.lists(active, max_size=3, unique_by=lambda each: each.native_code).map(tuple)
    return st.builds(
        lambda a, b, c: MachineReport({**a, **b}, c),
        st.dictionaries(st.sampled_from(samples), number),
        st.dictionaries(st.sampled_from(events), text),
        st.dictionaries(st.sampled_from(conditions), several),
    )


@settings(max_examples=30)
@given(st.lists(values(), min_size=1, max_size=6), st.data())
def test_late_agent_gets_the_same_state_as_the_others(
    reports: list[MachineReport], data: st.DataObject
) -> None:
    comes = data.draw(st.integers(0, len(reports) - 1))
    told = SentMachineState(ITEMS)
    early, late = (FakeAgent(MODEL, ManualClock()) for _ in range(2))
    hear(early, told.make_complete_state_lines(AT))
    for i, report in enumerate(reports):
        said = told.make_change_lines(report, AT)
        hear(early, said)
        if i == comes:
            hear(late, told.make_complete_state_lines(AT))
        elif i > comes:
            hear(late, said)
    assert early.values == late.values
    assert early.active == late.active
    assert (early.bad, late.bad, early.unknown, late.unknown) == ([], [], [], [])
    last = reports[-1]
    for key, active in early.active.items():
        now = last.active_conditions.get(key)
        wanted = (
            None
            if now is None
            else {
                each.native_code: (each.condition_level, replace_separators(each.condition_text))
                for each in now
            }
        )
        assert active == wanted


def hear(agent: FakeAgent, lines: str) -> None:
    for line in lines.split("\n"):
        agent.hear(line)
