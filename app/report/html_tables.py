"""Tables, figures and the frame of the pages of reports and setup sheets, as HTML."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from hashlib import sha256
from html import escape

from app.report.page_style import STYLE
from core.language.source import Source
from core.message import Message

_NOTHING_LOADED = "default-src 'none'; style-src 'unsafe-inline'"
PAGE_END = "</body></html>\n"


def page_head(title: str, made: str, language: str) -> str:
    """What stands before the first section; ``made`` is the date, ``language`` as ISO 639-1 has it."""
    return (
        f'<!DOCTYPE html>\n<html lang="{language}"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width">'
        f'<meta http-equiv="Content-Security-Policy" content="{_NOTHING_LOADED}">'
        f"<title>{escape(title)}</title><style>{STYLE}</style></head><body>{headline(title, made)}\n"
    )


def headline(title: str, made: str) -> str:
    """What it is, and its date."""
    return f'<h1>{escape(title)}</h1><p class="made">{escape(made)}</p>'


def verdict(look: str, words: str) -> str:
    """What has come of it: ``good``, ``doubt`` or ``bad``."""
    return f'<p class="verdict {look}">{escape(words)}</p>'


def figure(drawing: str, caption: str) -> str:
    """A drawing and what stands under it."""
    return f"<figure>{drawing}<figcaption>{escape(caption)}</figcaption></figure>"


def pairs(rows: Iterable[tuple[str, str]]) -> str:
    """Names and their values; both are escaped."""
    lines = "".join(f"<tr><th>{escape(name)}</th><td>{escape(value)}</td></tr>" for name, value in rows)
    return f'<table class="facts">{lines}</table>'


def table(head: Iterable[str], rows: Iterable[Sequence[str]]) -> str:
    """A table; the cells are HTML already."""
    top = "".join(f"<th>{escape(each)}</th>" for each in head)
    lines = "".join("<tr>" + "".join(f"<td>{cell}</td>" for cell in row) + "</tr>" for row in rows)
    return f"<table><tr>{top}</tr>{lines}</table>"


def clock(seconds: float) -> str:
    """Minutes and seconds."""
    minutes, rest = divmod(seconds, 60.0)
    return (
        Message("{minutes} min {rest} s", minutes=f"{minutes:.0f}", rest=f"{rest:04.1f}")
        if minutes
        else f"{rest:.1f} s"
    )


def text_hash(source: Source) -> str:
    """By which the text of a program is known again."""
    return sha256(source.text.encode("utf-8", "surrogatepass")).hexdigest()
