"""What stands in a PDF that Qt has written: words of each page without blanks, paper, pictures."""

from __future__ import annotations

import re
import zlib
from pathlib import Path

_POINTS = 72.0 / 25.4  # a mm


class Pdf:
    """A PDF file, read by its objects."""

    def __init__(self, path: Path) -> None:
        data = path.read_bytes()
        assert data.startswith(b"%PDF-")
        assert data.rstrip().endswith(b"%%EOF")
        self._objects = {int(m[1]): m[2] for m in re.finditer(rb"\n(\d+) 0 obj(.*?)endobj", data, re.DOTALL)}
        self._fonts = {n: self._font(n) for n, each in self._objects.items() if b"/ToUnicode" in each}
        pages = [each for each in self._objects.values() if b"/Type /Page\n" in each]
        self._contents = [self._stream(int(self._of(rb"/Contents (\d+) 0 R", each))) for each in pages]
        self.papers = {
            tuple(
                round(float(figure) / _POINTS)
                for figure in self._of(rb"/MediaBox \[0 0 (.*?)\]", each).split()
            )
            for each in pages
        }  # mm

    @property
    def pages(self) -> list[str]:
        """The words of each page, without blanks."""
        return [self._words(each) for each in self._contents]

    @property
    def photographs(self) -> int:
        """Pictures that are made of pixels."""
        return sum(b"/Subtype /Image" in each for each in self._objects.values())

    def lines(self, page: int) -> int:
        """How many ends of lines are drawn on a page."""
        return len(re.findall(rb" l\n", self._contents[page]))

    @staticmethod
    def _of(pattern: bytes, text: bytes) -> str:
        found = re.search(pattern, text)
        assert found is not None
        return found[1].decode()

    def _stream(self, number: int) -> bytes:
        packed = self._objects[number].split(b"stream\n", 1)[1].rsplit(b"\nendstream", 1)[0]
        return zlib.decompress(packed) if b"/FlateDecode" in self._objects[number] else packed

    def _font(self, number: int) -> dict[str, str]:
        """The letters of a font by their glyphs."""
        named = self._stream(int(self._of(rb"/ToUnicode (\d+) 0 R", self._objects[number]))).decode("latin-1")
        letters: dict[str, str] = {}
        for block in re.findall(r"beginbfrange(.*?)endbfrange", named, re.DOTALL):
            for first, _last, row in re.findall(r"<(\w+)> <(\w+)> \[(.*?)\]", block, re.DOTALL):
                for off, letter in enumerate(re.findall(r"<(\w+)>", row)):
                    letters[f"{int(first, 16) + off:04x}"] = bytes.fromhex(letter).decode("utf-16-be")
            ranges = re.sub(r"\[.*?\]", "", block, flags=re.DOTALL)
            for first, last, letter in re.findall(r"<(\w+)> <(\w+)> <(\w+)>", ranges):
                for off in range(int(last, 16) - int(first, 16) + 1):
                    letters[f"{int(first, 16) + off:04x}"] = chr(int(letter, 16) + off)
        return letters

    def _words(self, content: bytes) -> str:
        font: dict[str, str] = {}
        words = ""
        for number, glyphs in re.findall(r"/F(\d+) \S+ Tf|<([0-9a-fA-F]+)> Tj", content.decode("latin-1")):
            if number:
                font = self._fonts[int(number)]
            else:
                words += "".join(font[glyphs[k : k + 4].lower()] for k in range(0, len(glyphs), 4))
        return re.sub(r"\s", "", words)
