"""[status_page] and [announce] of the machine file: what the office sees, who is told of ends and stops."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from ipaddress import ip_address
from urllib.parse import urlsplit

from core.table_schema import HIDDEN, Driver, DriverTable, Field, FileReading, Finding, Kind, Unit, written

LEAST_TOKEN = 12  # characters
_WEB = ("http://", "https://")
_PAGE_FIELDS = (
    Field("enabled", Kind.FLAG, default=False),
    Field("bind", Kind.TEXT, default="127.0.0.1"),
    Field("port", Kind.WHOLE, low=1, high=65535, default=8317),
    Field("token", Kind.TEXT, default=""),
    Field("desks", Kind.WORDS, default=""),
    Field("agents", Kind.WORDS, default=""),
)
_ANNOUNCE_FIELDS = (
    Field("mqtt", Kind.TEXT, default=""),
    Field("topic", Kind.TEXT, default="turndesk"),
    Field("user", Kind.TEXT, default=""),
    Field("password", Kind.TEXT, default=""),
    Field("hook", Kind.TEXT, default=""),
    Field("again", Kind.NUMBER, Unit.SECONDS, 1.0, 3600.0, default=10.0),
)


@dataclass(frozen=True, slots=True)
class StatusPageTable:
    """Where browsers find the page of this desk, and what is shown beside it: the pages of other desks, and
    machines that an MTConnect agent tells of (the agent's address with the name of the device).

    ``token`` is the word that a browser must bring; empty only where no other computer can ask.
    """

    enabled: bool
    bind: str
    port: int
    token: str = field(repr=False)
    desks: str = field(repr=False)
    agents: str = field(repr=False)

    @property
    def others(self) -> tuple[str, ...]:
        """Addresses of the other desks' pages."""
        return tuple(self.desks.split())

    @property
    def told_by_agents(self) -> tuple[str, ...]:
        """Addresses of devices at their agents."""
        return tuple(self.agents.split())


@dataclass(frozen=True, slots=True)
class AnnounceTable:
    """The MQTT broker (``host:port``) and the web address that are told; empty: that one is not.

    ``again`` is the seconds after which a broker or host that was away is tried once more.
    """

    mqtt: str
    topic: str
    user: str
    password: str = field(repr=False)
    hook: str = field(repr=False)
    again: float


def loopback(address: str) -> bool:
    """Whether only this computer can ask there."""
    try:
        return ip_address(address).is_loopback
    except ValueError:
        return address == "localhost"


def is_web_address(text: str) -> bool:
    """Whether a host can be asked there."""
    try:
        parts = urlsplit(text)
        return text.startswith(_WEB) and bool(parts.hostname) and parts.port != 0
    except ValueError:  # of a port or an IPv6 address that is none
        return False


def broker_of(text: str) -> tuple[str, int]:
    """Host and port of ``host`` or ``host:port``. Raises ValueError for anything else."""
    host, colon, port = text.rpartition(":")
    if not colon:
        host, port = text, "1883"
    number = int(port)
    if not host or "@" in host or not 0 < number < 65536:
        raise ValueError(text)
    return host, number


def _page_rules(file: FileReading) -> Iterator[Finding]:
    values = file.values
    if not values.has("status_page.bind", "status_page.token", "status_page.desks", "status_page.agents"):
        return
    bind, token = values.text("status_page.bind"), values.text("status_page.token")
    if token and not (token.isascii() and token.replace("-", "").replace("_", "").isalnum()):
        yield Finding("status_page.token", "", "letters, figures, - and _ only", "broken-rule")
    elif not loopback(bind) and len(token) < LEAST_TOKEN:
        why = f"other computers can ask at {bind}: a token of {LEAST_TOKEN} characters or more is needed"
        yield Finding("status_page.token", "", why, "broken-rule")
    for address in values.text("status_page.desks").split():
        if not is_web_address(address):
            yield Finding("status_page.desks", HIDDEN, "an address that begins with http://", "broken-rule")
    for address in values.text("status_page.agents").split():
        if not is_web_address(address) or not urlsplit(address).path.strip("/"):
            why = "the agent's address and the device, such as http://shop-pc:5000/LATHE2"
            yield Finding("status_page.agents", HIDDEN, why, "broken-rule")


def _announce_rules(file: FileReading) -> Iterator[Finding]:
    values = file.values
    if not values.has("announce.mqtt", "announce.hook", "announce.topic"):
        return
    broker, hook = values.text("announce.mqtt"), values.text("announce.hook")
    try:
        if broker:
            broker_of(broker)
    except ValueError:
        yield Finding(
            "announce.mqtt",
            written(broker.rpartition("@")[2]),
            'the address of the broker, such as "shop-pc:1883"',
            "broken-rule",
        )
    if hook and not is_web_address(hook):
        yield Finding(
            "announce.hook", HIDDEN, "an address that begins with http:// or https://", "broken-rule"
        )
    topic = values.text("announce.topic")
    if topic.startswith("/") or any(sign in topic for sign in "+# "):
        yield Finding(
            "announce.topic",
            written(topic),
            "a topic without + # and blanks, such as shop/lathe3",
            "broken-rule",
        )


DRIVER = Driver(
    tables=(
        DriverTable(
            "status_page",
            _PAGE_FIELDS,
            lambda file: file.values.model(StatusPageTable, "status_page"),
            rules=_page_rules,
        ),
        DriverTable(
            "announce",
            _ANNOUNCE_FIELDS,
            lambda file: file.values.model(AnnounceTable, "announce"),
            rules=_announce_rules,
        ),
    )
)
