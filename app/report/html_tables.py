"""HTML tables, drawings, styles and page head for reports and setup sheets."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from hashlib import sha256
from html import escape

from core.language.source import ProgramSource
from core.message import Message

_PAGE_CSS = """
body{font:14px/1.4 system-ui,"Segoe UI",Helvetica,Arial,sans-serif;color:#1a1d21;background:#fff;
margin:24px auto;max-width:960px;padding:0 16px}
h1{font-size:22px;margin:0}
h2{font-size:19px;margin:28px 0 8px;border-top:3px solid #1a1d21;padding-top:10px}
h3{font-size:15px;margin:20px 0 6px}
p{margin:4px 0}
.made{color:#5b626b}
.verdict{font-size:17px;font-weight:600;padding:6px 10px;border-left:6px solid}
.good{border-color:#2e7d32;background:#eaf5ea}
.doubt{border-color:#b26a00;background:#fff5e3}
.bad{border-color:#b3261e;background:#fdecea}
table{border-collapse:collapse;margin:6px 0}
th,td{text-align:left;padding:3px 12px 3px 0;vertical-align:middle;border-bottom:1px solid #dde1e5;
overflow-wrap:anywhere}
.facts th{font-weight:600;white-space:nowrap;vertical-align:top}
figure{margin:12px 0;break-inside:avoid}
figcaption{color:#5b626b;font-size:13px}
svg{max-width:100%;height:auto;background:#fbfcfd;border:1px solid #dde1e5}
.finding{display:flex;gap:16px;justify-content:space-between;border-left:5px solid #8a929b;
padding:2px 0 2px 12px;margin:10px 0;break-inside:avoid}
.finding.error{border-color:#b3261e}
.finding.warning{border-color:#b26a00}
.finding>div{min-width:0}
.finding svg{flex:none}
pre{background:#f2f4f6;padding:4px 8px;margin:4px 0;white-space:pre-wrap;overflow-wrap:anywhere}
code{color:#5b626b}
.hint{color:#5b626b}
""".replace("\n", "")

DRAWING_STYLE = """
.stock{fill:#e3e7eb;stroke:#9aa3ad;stroke-width:1;stroke-dasharray:5 3}
.part{fill:#a9bccd;stroke:#22384d;stroke-width:1.4}
.faint{fill:#dfe7ee;stroke:#9fb0c0;stroke-width:1}
.chuck{fill:#c9c4bb;stroke:#6f6a61;stroke-width:1}
.axis{fill:none;stroke:#6f7a86;stroke-width:1;stroke-dasharray:14 4 3 4}
.cut{fill:none;stroke:#0b5cad;stroke-width:1.2}
.rapid{fill:none;stroke:#b5651d;stroke-width:1;stroke-dasharray:6 4}
.thread{fill:none;stroke:#6a1b9a;stroke-width:2}
.wrong{fill:none;stroke:#b3261e;stroke-width:2.5}
.wrong-end{fill:#b3261e}
.holder{fill:#d5d8db;fill-opacity:.75;stroke:#5b626b;stroke-width:1}
.insert{fill:#e8b923;fill-opacity:.85;stroke:#7a5d00;stroke-width:1}
.control{fill:#b3261e}
""".replace("\n", "")
"""CSS for the drawings only."""

_PRINT_CSS = """
@media print{body{margin:0}
section{break-before:page}
section:first-of-type{break-before:auto}}
""".replace("\n", "")

PAGE_STYLE = _PAGE_CSS + DRAWING_STYLE + _PRINT_CSS
"""CSS for a page in a browser."""

PAPER_COLORS = """
body{color:#1a1d21;font-size:12px}
h1{font-size:20px;margin-top:0;margin-bottom:2px}
h2{font-size:16px;margin-top:10px;margin-bottom:6px}
h3{font-size:13px;margin-top:14px;margin-bottom:4px}
p{margin-top:2px;margin-bottom:2px}
.made,code,.hint{color:#5b626b}
.verdict{font-size:14px;font-weight:600}
.good{background-color:#eaf5ea}
.doubt{background-color:#fff5e3}
.bad{background-color:#fdecea}
td,th{padding:2px 10px 2px 0px;vertical-align:bottom}
th{text-align:left}
pre{background-color:#f2f4f6}
.error b{color:#b3261e}
.warning b{color:#b26a00}
""".replace("\n", "")
"""CSS for a PDF, limited to the properties that Qt supports in HTML."""


_CONTENT_POLICY = "default-src 'none'; style-src 'unsafe-inline'"
HTML_END = "</body></html>\n"


def make_page_head(title: str, date_text: str, language: str) -> str:
    """Return the HTML of a page from its start to its first section.

    ``language`` is an ISO 639-1 code.
    """
    return (
        f'<!DOCTYPE html>\n<html lang="{language}"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width">'
        f'<meta http-equiv="Content-Security-Policy" content="{_CONTENT_POLICY}">'
        f"<title>{escape(title)}</title><style>{PAGE_STYLE}</style></head><body>"
        f"{make_headline(title, date_text)}\n"
    )


def make_headline(title: str, date_text: str) -> str:
    """Return the title and the date as HTML."""
    return f'<h1>{escape(title)}</h1><p class="made">{escape(date_text)}</p>'


def make_result_line(css_class: str, text: str) -> str:
    """Return a line with the result as HTML, formatted with the given CSS class."""
    return f'<p class="verdict {css_class}">{escape(text)}</p>'


def make_drawing_block(drawing: str, caption: str) -> str:
    """Return a drawing with a caption as HTML."""
    return f"<figure>{drawing}<figcaption>{escape(caption)}</figcaption></figure>"


def make_name_value_table(rows: Iterable[tuple[str, str]]) -> str:
    """Return an HTML table with two columns, names and values.

    Names and values are escaped.
    """
    lines = "".join(f"<tr><th>{escape(name)}</th><td>{escape(value)}</td></tr>" for name, value in rows)
    return f'<table class="facts">{lines}</table>'


def make_table(column_headings: Iterable[str], rows: Iterable[Sequence[str]]) -> str:
    """Return an HTML table.

    The cells must already be HTML.
    """
    top = "".join(f"<th>{escape(each)}</th>" for each in column_headings)
    lines = "".join("<tr>" + "".join(f"<td>{cell}</td>" for cell in row) + "</tr>" for row in rows)
    return f"<table><tr>{top}</tr>{lines}</table>"


def format_duration(seconds: float) -> str:
    """Return a duration as minutes and seconds."""
    minutes, rest = divmod(seconds, 60.0)
    return (
        Message("{minutes} min {rest} s", minutes=f"{minutes:.0f}", rest=f"{rest:04.1f}")
        if minutes
        else f"{rest:.1f} s"
    )


def hash_program_text(source: ProgramSource) -> str:
    """Return the SHA-256 hash of a program text, which identifies the text."""
    return sha256(source.text.encode("utf-8", "surrogatepass")).hexdigest()
