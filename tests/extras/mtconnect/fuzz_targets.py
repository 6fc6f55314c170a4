"""Lines of SHDR: texts of programs and alarms that go out, and bytes of an agent that come in."""

from __future__ import annotations

import socket
from collections.abc import Iterable

from app.extras.mtconnect.driver.agent_links import (
    ActiveCondition,
    AgentLink,
    AgentLostError,
    format_value,
    make_values_line,
    replace_separators,
)
from app.extras.mtconnect.driver.mtconnect_items import DataItem, DataItemCategory
from tests.fuzz.fuzz_target import Target

_ITEM = DataItem("block", DataItemCategory.EVENT, "BLOCK")


def _shdr(data: bytes) -> Iterable[str]:
    """Texts of programs and alarms go out as values; bytes of an agent come in."""
    texts = data.decode("utf-8", "surrogateescape").split("\0")
    for text in texts:
        line = make_values_line(
            "t", {"block": format_value(_ITEM, text), "program": replace_separators(text)}
        )
        if line.count("\n") != 1 or line.count("|") != 4 or "--multiline--" in line:
            raise AssertionError(f"two values have not stayed two: {line!r}")
        line.encode("utf-8")
        replace_separators(ActiveCondition("FAULT", text, text).condition_text)
    ours, theirs = socket.socketpair()
    with ours, theirs:
        ours.setblocking(False)
        link = AgentLink(ours, 10.0)
        for at in range(0, len(data), 1000):
            theirs.sendall(data[at : at + 1000])
            link.read_data(float(at))
            link.check_timeout(float(at))
    return ()


NAMES = ("SHDR lines",)
TARGETS = (
    Target(
        "SHDR lines",
        lambda: (b"* PING\n", b'G90 X1|2\0"x"\0--multiline--\0\xff\xfe'),
        _shdr,
        (AgentLostError,),
    ),
)
