"""Tables [status_page] and [announce] of the machine file: office page, MQTT broker and webhook."""

from __future__ import annotations

from collections.abc import Iterator
from ipaddress import ip_address
from urllib.parse import urlsplit

from core.key_declaration import FileUnit, KeyRange, Words, declare_key, make_key_table
from core.message import Message
from core.secret_values import SECRET_MASK, format_toml_value
from core.table_schema import DriverDeclaration, DriverTable, FileFinding, MachineFileReading

MIN_TOKEN_LENGTH = 12  # characters
_WEB = ("http://", "https://")


@make_key_table
class StatusPageTable:
    """Settings of the office page, including the other machines that it shows.

    The other machines are shown from the office pages of other TurnDesk installations, or are devices of
    MTConnect agents. ``token`` is the password for browsers. It may be empty only if no other computer can
    connect.
    """

    enabled: bool = declare_key(default=False, meaning="true: TurnDesk serves the office page.")
    bind: str = declare_key(
        default="127.0.0.1",
        meaning='Address at which the page is served. "127.0.0.1": only to this computer; "0.0.0.0": to '
        "all computers, which needs a token.",
    )
    port: int = declare_key(KeyRange(1, 65535), default=8317, meaning="TCP port of the page.")
    token: str = declare_key(
        is_secret=True,
        default="",
        meaning="Password in the address of the page: letters, digits, - and _. At least 12 characters if "
        "other computers can connect.",
    )
    desks: Words = declare_key(
        is_secret=True,
        default="",
        meaning="Addresses of the office pages of other machines, with their tokens, to be shown on the "
        "same page.",
    )
    agents: Words = declare_key(
        is_secret=True,
        default="",
        meaning="Addresses of MTConnect agents with the device, such as `http://shop-pc:5000/MILL4`, whose "
        "machines are shown on the same page.",
    )

    @property
    def other_page_addresses(self) -> tuple[str, ...]:
        """Return the addresses of the office pages of other machines."""
        return tuple(self.desks.split())

    @property
    def agent_addresses(self) -> tuple[str, ...]:
        """Return the addresses of the machines that are devices of MTConnect agents."""
        return tuple(self.agents.split())


@make_key_table
class AnnounceTable:
    """Settings of the MQTT broker (``host:port``) and of the webhook.

    An empty address disables the broker or the webhook. ``again`` is the time in seconds after which
    TurnDesk retries a broker or webhook host that did not respond.
    """

    mqtt: str = declare_key(
        default="",
        meaning="MQTT broker as `host` or `host:port`; the default port is 1883. Default: no broker.",
    )
    topic: str = declare_key(default="turndesk", meaning="Topic before `/available`, `/state` and `/event`.")
    user: str = declare_key(default="", meaning="User name for the broker.")
    password: str = declare_key(is_secret=True, default="", meaning="Password for the broker.")
    hook: str = declare_key(
        default="", meaning="Web address that receives each event by POST. Default: none."
    )
    again: float = declare_key(
        KeyRange(1.0, 3600.0, FileUnit.SECONDS),
        default=10.0,
        meaning="Time after which TurnDesk retries a broker or web address that did not respond.",
    )


def is_loopback(address: str) -> bool:
    """Return whether the address can be reached from this computer only."""
    try:
        return ip_address(address).is_loopback
    except ValueError:
        return address == "localhost"


def is_web_address(text: str) -> bool:
    """Return whether a text is a valid web address."""
    try:
        parts = urlsplit(text)
        return text.startswith(_WEB) and bool(parts.hostname) and parts.port != 0
    except ValueError:  # an invalid port or IPv6 address
        return False


def parse_broker_address(text: str) -> tuple[str, int]:
    """Return the host and the port of an address in the form ``host`` or ``host:port``.

    Raises ValueError if the text is invalid.
    """
    host, colon, port = text.rpartition(":")
    if not colon:
        host, port = text, "1883"
    number = int(port)
    if not host or "@" in host or not 0 < number < 65536:
        raise ValueError(text)
    return host, number


def _page_rules(file: MachineFileReading) -> Iterator[FileFinding]:
    values = file.file_values
    if not values.has_values(
        "status_page.bind", "status_page.token", "status_page.desks", "status_page.agents"
    ):
        return
    bind, token = values.text("status_page.bind"), values.text("status_page.token")
    if token and not (token.isascii() and token.replace("-", "").replace("_", "").isalnum()):
        yield FileFinding("status_page.token", "", "use only letters, digits, - and _", "broken-rule")
    elif not is_loopback(bind) and len(token) < MIN_TOKEN_LENGTH:
        why: str = Message(
            "other computers can connect to {bind}, so a token of at least {least_token} "
            "characters is needed",
            bind=bind,
            least_token=MIN_TOKEN_LENGTH,
        )
        yield FileFinding("status_page.token", "", why, "broken-rule")
    for address in values.text("status_page.desks").split():
        if not is_web_address(address):
            yield FileFinding(
                "status_page.desks",
                SECRET_MASK,
                "each entry must be an address that begins with http://",
                "broken-rule",
            )
    for address in values.text("status_page.agents").split():
        if not is_web_address(address) or not urlsplit(address).path.strip("/"):
            why = "each entry must be an agent's address and a device, such as http://shop-pc:5000/LATHE2"
            yield FileFinding("status_page.agents", SECRET_MASK, why, "broken-rule")


def _announce_rules(file: MachineFileReading) -> Iterator[FileFinding]:
    values = file.file_values
    if not values.has_values("announce.mqtt", "announce.hook", "announce.topic"):
        return
    broker, hook = values.text("announce.mqtt"), values.text("announce.hook")
    try:
        if broker:
            parse_broker_address(broker)
    except ValueError:
        yield FileFinding(
            "announce.mqtt",
            format_toml_value(broker.rpartition("@")[2]),
            'this value must be the address of the MQTT broker, such as "shop-pc:1883"',
            "broken-rule",
        )
    if hook and not is_web_address(hook):
        yield FileFinding(
            "announce.hook",
            SECRET_MASK,
            "this value must be an address that begins with http:// or https://",
            "broken-rule",
        )
    topic = values.text("announce.topic")
    if topic.startswith("/") or any(sign in topic for sign in "+# "):
        yield FileFinding(
            "announce.topic",
            format_toml_value(topic),
            "this value must be a topic without +, # or spaces, such as shop/lathe3",
            "broken-rule",
        )


DRIVER = DriverDeclaration(
    tables=(
        DriverTable(
            "status_page",
            StatusPageTable,
            check_rules=_page_rules,
            purpose="The office page: a web page that shows the state of the machine to other computers.",
        ),
        DriverTable(
            "announce",
            AnnounceTable,
            check_rules=_announce_rules,
            purpose="Where TurnDesk reports the state of the machine: an MQTT broker, a web hook, or both.",
        ),
    )
)
