"""Exceptions that name their fault by a code, which stays the same when the text is reworded."""

from __future__ import annotations


class CodedError(Exception):
    """An error with a text for the reader and a code for programs and tests.

    ``code`` names the fault in kebab case, such as ``disk-full``. It is empty where nothing needs to
    distinguish the faults.
    """

    def __init__(self, text: str = "", code: str = "") -> None:
        super().__init__(text)
        self.code = code


def error_code(error: BaseException) -> str:
    """Return the code of an error that another error replaces, or an empty code where it has none."""
    return error.code if isinstance(error, CodedError) else ""
