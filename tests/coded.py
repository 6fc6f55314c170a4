"""Expectations on errors by their code: wording may change, the kind of fault may not."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import pytest

from app.desk import command_errors
from core.message import CodedError


@contextmanager
def raises_code(kind: type[Exception], code: str, *values: object) -> Iterator[pytest.ExceptionInfo[Any]]:
    """Expect an error of this kind and code whose text names each of ``values``."""
    with pytest.raises(kind) as raised:
        yield raised
    error: Any = raised.value
    assert error.code == code, f"{error.code}: {error}"
    for value in values:
        assert str(value) in str(error)


def recorded_refusals(monkeypatch: pytest.MonkeyPatch) -> list[CodedError]:
    """Return a list that receives every error that ends a command of this process from now on."""
    refusals = list[CodedError]()
    report = command_errors.report_command_error

    def record(error: CodedError) -> int:
        refusals.append(error)
        return report(error)

    monkeypatch.setattr(command_errors, "report_command_error", record)
    return refusals
