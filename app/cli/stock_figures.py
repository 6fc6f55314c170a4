"""What became of the stock, as JSON and as a person reads it: inches for OmniTurn, else mm."""

from __future__ import annotations

from typing import TYPE_CHECKING

from app.cli.figures import Json, length_of, volume_of
from core.language.source import Dialect
from core.message import Message

if TYPE_CHECKING:
    from core.part.stock import Stock
    from core.part.turned_part import Profile
    from core.proving.proof_report import PartReport


def stock_json(part: PartReport, dialect: Dialect) -> Json | None:
    """The keys of docs/json.md; null where nobody has said a stock and nothing is cut that would tell it."""
    stock, last = part.stock, part.last
    if stock is None:
        return None
    length, volume = length_of(dialect), volume_of(dialect)
    bore = last.bore if last is not None else None
    return {
        "given": stock.given or None,
        "outside": [[length(z), length(r)] for z, r in stock.outside],
        "volume": volume(part.volume),
        "removed_volume": volume(part.removed),
        "left_volume": volume(part.left),
        "profile": _points(last.outside, dialect) if last is not None else [],
        "bore": _points(bore, dialect) if bore is not None else None,
        "min_wall": length(last.min_wall) if last is not None and last.min_wall is not None else None,
        "milled": part.milled,
        "pieces": [volume(piece.volume) for piece in part.pieces],
        "assumed": list(part.assumed),
        "unchecked": list(part.unchecked),
    }


def stock_lines(part: PartReport, dialect: Dialect) -> str:
    """The stock in the sheet of a proof."""
    if part.stock is None:
        return "".join(f"  {words}\n" for words in part.assumed)
    inch = dialect is Dialect.OMNITURN
    volume, unit = volume_of(dialect), "in³" if inch else "mm³"
    pieces = (
        Message(", pieces parted off: {pieces_count}", pieces_count=len(part.pieces)) if part.pieces else ""
    )
    return (
        f"  stock {_named(part.stock, dialect)}: {volume(part.removed):.4g} {unit}"
        f" of {volume(part.volume):.4g} cut away{pieces}\n"
        + "".join(f"  {words}\n" for words in part.assumed)
        + (f"  not checked: {'; '.join(part.unchecked)}\n" if part.unchecked else "")
    )


def _named(stock: Stock, dialect: Dialect) -> str:
    if stock.given:
        return stock.given
    length, unit = length_of(dialect), "in" if dialect is Dialect.OMNITURN else "mm"
    bore = (
        Message(", bore diameter {bore}", bore=f"{2.0 * length(stock.bore[0][1]):.3f}") if stock.bore else ""
    )
    return Message(
        "a bar of diameter {radius}{bore} {unit}, assumed because no stock was specified",
        radius=f"{2.0 * length(stock.radius):.3f}",
        bore=bore,
        unit=unit,
    )


def _points(profile: Profile, dialect: Dialect) -> list[list[float]]:
    length = length_of(dialect)
    return [[round(length(z), 6), round(length(r), 6)] for z, r in profile]
