"""The proofs of many programs as a person reads them: one line a program, and its first error."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from pathlib import Path

from app.cli.proof_work import Proof
from core.message import Message

_SLOWEST = 3
_HEAD = "verdict     errors  warnings      cycle s       removed  program\n"

Row = tuple[Path, Proof]


def table(rows: Sequence[Row], others: int) -> str:
    """All of it; ``others`` files in the folders are no programs."""
    return _HEAD + "".join(_line(path, proof) for path, proof in rows) + _sum(rows, others) + _slowest(rows)


def verdict(proof: Proof) -> str:
    """One word for what proving has come to."""
    if proof.fault:
        return "not proved"
    return "errors" if proof.count("error") else "proved"


def _line(path: Path, proof: Proof) -> str:
    word = verdict(proof)
    if proof.fault:
        return f"{word:10s}{'':38s}  {path}\n            {proof.fault}\n"
    first = next(proof.findings("error"), None)
    return (
        f"{word:10s}{proof.count('error'):8d}{proof.count('warning'):10d}"
        f"{_number(proof.report['cycle_time_s']):13.2f}{_removed(proof):>14s}  {path}\n"
        + _compared(proof)
        + (f"            line {first['line']}: {first['message']}\n" if first else "")
    )


def _compared(proof: Proof) -> str:
    """What other offsets change, in one line."""
    found = proof.report.get("compare")
    if not isinstance(found, dict):
        return ""
    unit = "in" if proof.report["dialect"] == "omniturn" else "mm"
    here, there = found["cycle_time_s"]
    return (
        f"            with {found['offsets']}: {found['differing']} of {len(found['features'])} diameters and"
        f" shoulders differ, by {found['largest']:.4f} {unit} at most; cycle {there - here:+.2f} s;"
        f" {len(found['added'])} findings new, {len(found['gone'])} gone\n"
    )


def _removed(proof: Proof) -> str:
    stock = proof.report.get("stock")
    if not isinstance(stock, dict):
        return "–"
    unit = "in³" if proof.report["dialect"] == "omniturn" else "mm³"
    return f"{stock['removed_volume']:.4g} {unit}"


def _number(value: object) -> float:
    assert isinstance(value, int | float)
    return float(value)


def _sum(rows: Sequence[Row], others: int) -> str:
    words = Counter(verdict(proof) for _, proof in rows)
    parts = [f"{words['proved']} proved"]
    parts += [Message("{words} with errors", words=words["errors"])] if words["errors"] else []
    parts += [Message("{words} not proved", words=words["not proved"])] if words["not proved"] else []
    parts += (
        [Message("{others} other file{value} skipped", others=others, value="s" * (others > 1))]
        if others
        else []
    )
    return f"{len(rows)} program{'s' * (len(rows) != 1)}: {', '.join(parts)}\n"


def _slowest(rows: Iterable[Row]) -> str:
    proved = sorted((row for row in rows if row[1].seconds), key=lambda row: -row[1].seconds)
    if not proved:
        return ""
    named = ", ".join(f"{path} {proof.seconds:.2f} s" for path, proof in proved[:_SLOWEST])
    return f"slowest to prove: {named}\n"
