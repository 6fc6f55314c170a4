"""Reading of TOML files that users write, with one error that reports all mistakes of a file."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from pathlib import Path

from app.desk.command_errors import CommandError
from app.desk.standard_input import STDIN_ARGUMENT, read_standard_input
from core.input_file import TooLargeError, parse_toml, read_input_bytes
from core.message import CodedError, Message, find_similar_word

_MOST_BYTES = 16 * 1024 * 1024
# Strings and comments are not changed. A number after =, [ or a comma may begin with its point.
_LEADING_POINT = re.compile(r"""(?:"(?:\\.|[^"\\\n])*"|'[^'\n]*'|\#.*)|([=\[,]\s*[-+]?)(?=\.\d)""")


def read_toml(path: Path) -> dict[str, object]:
    """Return the tables of a TOML file. Raises CommandError if the file cannot be read or is invalid.

    Numbers such as ``.25`` are common in shops but not valid TOML. This function reads ``.25`` as 0.25.
    """
    try:
        text = _read_bytes(path).decode("utf-8").replace("\r\n", "\n")
        return parse_toml(_LEADING_POINT.sub(_with_nought, text))
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


def _read_bytes(path: Path) -> bytes:
    """Return the bytes of a file, or of standard input for ``-``.

    If the input is too large, raises TooLargeError for a file and CommandError for standard input.
    CommandError is also raised if standard input is closed or already in use. Raises OSError if reading
    fails.
    """
    if str(path) == STDIN_ARGUMENT:
        data = read_standard_input("TOML")
    else:
        return read_input_bytes(path, _MOST_BYTES)
    if len(data) > _MOST_BYTES:
        raise _too_large(path)
    return data


def _too_large(path: Path) -> CommandError:
    text = Message(
        "{path} is larger than 16 MB, so it cannot be a file of this type; check the name", path=path
    )
    return CommandError(text, "too-large")


def describe_unknown_key(key: str, known_keys: Iterable[str]) -> str:
    """Return the error text for an unknown key. The text names the most similar known key."""
    names = list(known_keys)
    near = find_similar_word(key, names)
    return Message(
        "{key} is unknown; {nearest}",
        key=key,
        nearest=f"did you mean {near}?" if near else f"known here: {', '.join(names)}",
    )


def make_unknown_key_error(key: str, known_keys: Iterable[str], table_name: str = "") -> CodedError:
    """Return the error for an unknown key. The error names the table that contains the key."""
    return CodedError(
        Message("[{table}] {key}", table=table_name, key=describe_unknown_key(key, known_keys))
        if table_name
        else describe_unknown_key(key, known_keys),
        "unknown-key",
    )


def raise_mistakes(path: Path, mistakes: Sequence[CodedError]) -> None:
    """Raise CommandError with the texts and codes of all mistakes, or return if there are no mistakes."""
    if mistakes:
        text = "; ".join(str(each) for each in mistakes)
        raise CommandError(
            Message("{path}: {text}", path=path, text=text), " ".join(each.code for each in mistakes)
        )
