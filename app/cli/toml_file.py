"""Reading a small TOML file that somebody wrote by hand: strictly, and with every mistake named at once."""

from __future__ import annotations

import tomllib
from collections.abc import Iterable
from difflib import get_close_matches
from pathlib import Path

from app.cli.errors import CommandError


def read_toml(path: Path) -> dict[str, object]:
    """The parsed file. Raises CommandError when it cannot be read or is no TOML."""
    try:
        return tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise CommandError(f"{path} cannot be read ({error.strerror}); check name and rights") from error
    except UnicodeDecodeError as error:
        raise CommandError(f"{path} is not UTF-8 text; save it as such") from error
    except tomllib.TOMLDecodeError as error:
        raise CommandError(f"{path} is no TOML: {error}") from error


def unknown(key: str, known: Iterable[str]) -> str:
    """The sentence for a key that nobody reads, with the nearest that somebody does."""
    names = list(known)
    near = get_close_matches(key, names, n=1)
    return f"{key} is unknown; " + (f"did you mean {near[0]}?" if near else f"known here: {', '.join(names)}")


def refuse(path: Path, mistakes: list[str]) -> None:
    """Raises CommandError when there are mistakes."""
    if mistakes:
        raise CommandError(f"{path}: " + "; ".join(mistakes))
