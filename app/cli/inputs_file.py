"""The inputs file: [inputs] with ``10 = true`` for PLC input 10, ``"TB2-5" = false`` for a terminal.

M95 asks what the control calls input 7: terminal TB2-9. ``7`` stands for it too where the file does not name
TB2-9.
"""

from __future__ import annotations

from collections.abc import Collection
from pathlib import Path

from app.desk.toml_file import read_toml, refuse, unknown_key
from core.message import CodedError, Message


def read_inputs(path: Path, known: Collection[str] = ()) -> dict[str, bool]:
    """Input states by name. With ``known`` only these names are taken.

    Raises CommandError naming every mistake.
    """
    data = read_toml(path)
    mistakes = [unknown_key(key, ("inputs",)) for key in data if key != "inputs"]
    table = data.get("inputs")
    if not isinstance(table, dict):
        refuse(path, [*mistakes, CodedError("the table [inputs] is missing", "no-table")])
        return {}
    mistakes += [
        CodedError(Message("inputs.{name} must be true (closed) or false (open)", name=name), "wrong-type")
        for name, state in table.items()
        if not isinstance(state, bool)
    ]
    mistakes += [unknown_key(name, known, "inputs") for name in table if known and name not in known]
    refuse(path, mistakes)
    also = "7" in table and (not known or "TB2-9" in known)
    return {"TB2-9": table["7"], **table} if also else dict(table)
