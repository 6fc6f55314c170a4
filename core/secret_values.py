"""Keys of a machine file whose values contain passwords or tokens."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    pass


# Keys whose values contain passwords or tokens. Addresses may contain them before @, in the path or after the
# question mark. A removed key may still occur in older files, which are compared with newer ones.
_SECRETS = frozenset(
    {
        "announce.hook",
        "announce.password",
        "sharing.git",
        "sharing.postgresql",
        "status_page.agents",
        "status_page.desks",
        "status_page.token",
    }
)


SECRET_MASK = "***"


# Keys of earlier versions, with their replacements.
_REMOVED = {
    "sharing.git": (
        "sharing by git was removed; use a folder (key folder) or a PostgreSQL database (key postgresql)"
    )
}


def format_toml_value(value: object) -> str:
    """Return a value in TOML syntax, shortened for a message."""
    if isinstance(value, bool):
        return "true" if value else "false"
    text = f'"{value}"' if isinstance(value, str) else str(value)
    return text if len(text) <= 40 else text[:37] + "..."


def format_without_secrets(path: str, value: object) -> str:
    """Return a value in TOML syntax, masked if it contains a password or token."""
    return SECRET_MASK if path in _SECRETS else format_toml_value(value)
