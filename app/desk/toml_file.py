"""Reading of TOML files that users write. All mistakes of a file are reported together."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from pathlib import Path

from app.desk.command_errors import CommandError
from app.desk.standard_input import DASH, standard_input
from core.input_file import TooLargeError, input_bytes, toml_tables
from core.message import CodedError, Message, nearest

_MOST_BYTES = 16 * 1024 * 1024
# Strings and comments are not changed. A number after =, [ or a comma may begin with its point.
_POINT_FIRST = re.compile(r"""(?:"(?:\\.|[^"\\\n])*"|'[^'\n]*'|\#.*)|([=\[,]\s*[-+]?)(?=\.\d)""")


def read_toml(path: Path) -> dict[str, object]:
    """Return the tables of a TOML file. Raises CommandError if the file cannot be read or is invalid.

    Shops write ``.25``, which is not valid in TOML. It is read as 0.25.
    """
    try:
        text = _bytes_of(path).decode("utf-8").replace("\r\n", "\n")
        return toml_tables(_POINT_FIRST.sub(_with_nought, text))
    except TooLargeError as error:
        raise _too_large(path) from error
    except OSError as error:
        raise CommandError(
            Message(
                "{path} cannot be read ({cause}); check the name and the permissions",
                path=path,
                cause=error.strerror,
            ),
            "unreadable",
        ) from error
    except UnicodeDecodeError as error:
        raise CommandError(
            Message("{path} is not UTF-8 text; save the file as UTF-8", path=path), "not-utf8"
        ) from error
    except ValueError as error:
        raise CommandError(
            Message("{path} is not a valid TOML file: {error}", path=path, error=error), "not-toml"
        ) from error


def _with_nought(found: re.Match[str]) -> str:
    return found[0] if found[1] is None else f"{found[1]}0"


def _bytes_of(path: Path) -> bytes:
    """Return the bytes of a file; ``-`` is standard input.

    Raises CommandError if standard input is too large, TooLargeError if the file is, or OSError.
    """
    if str(path) == DASH:
        data = standard_input("TOML")
    else:
        return input_bytes(path, _MOST_BYTES)
    if len(data) > _MOST_BYTES:
        raise _too_large(path)
    return data


def _too_large(path: Path) -> CommandError:
    text = Message(
        "{path} is larger than 16 MB, so it cannot be a file of this type; check the name", path=path
    )
    return CommandError(text, "too-large")


def unknown(key: str, known: Iterable[str]) -> str:
    """Return the error text for an unknown key, with the most similar known key."""
    names = list(known)
    near = nearest(key, names)
    return Message(
        "{key} is unknown; {nearest}",
        key=key,
        nearest=f"did you mean {near}?" if near else f"known here: {', '.join(names)}",
    )


def unknown_key(key: str, known: Iterable[str], table: str = "") -> CodedError:
    """Return the error for an unknown key, with the name of its table."""
    return CodedError(
        Message("[{table}] {key}", table=table, key=unknown(key, known)) if table else unknown(key, known),
        "unknown-key",
    )


def refuse(path: Path, mistakes: Sequence[CodedError]) -> None:
    """Raise CommandError with the texts and codes of all mistakes, if there are any."""
    if mistakes:
        text = "; ".join(str(each) for each in mistakes)
        raise CommandError(
            Message("{path}: {text}", path=path, text=text), " ".join(each.code for each in mistakes)
        )
