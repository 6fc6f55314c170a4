"""TOML text as tables; whatever is wrong with the text is a ValueError with the cause and the place."""

from __future__ import annotations

import tomllib


def toml_tables(text: str) -> dict[str, object]:
    """Return the tables of a TOML text. Raises ValueError alone, with the cause and, if known, the place."""
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError:
        raise
    except RecursionError as error:
        raise ValueError("brackets are nested too deeply; remove the inner ones") from error
    except ValueError as error:  # Python's own words for an integer that it does not convert
        raise ValueError("a whole number has too many digits; shorten it") from error
