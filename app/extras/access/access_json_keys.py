"""Keys of the JSON that ``turndesk access`` prints, for the reference and its tests."""

from __future__ import annotations

from core.json_key import Output, keys

ACCESS_LIST = Output(
    "access list --json",
    "One object.",
    keys(
        """
on | boolean | | Whether access levels are on.
damaged | boolean | | Whether an entry of a user is damaged, so that this user cannot log in.
people | list | | Users.
people[].name | string | | Name.
people[].level | string | | Level: OPERATOR, SETUP or SERVICE.
"""
    ),
)
ACCESS_TABLE = Output(
    "access table --json",
    "One object with a key for each kind of change, such as ZERO OFFSETS.",
    keys(
        """
*.level | string | | Level that the change needs.
*.what | string | | Description of the change.
"""
    ),
)
OUTPUTS = {"scope FILE --json": (ACCESS_LIST, ACCESS_TABLE)}
