"""The three ways of input: one story is told by keys alone, by the mouse alone, by one finger alone."""

from __future__ import annotations

from dataclasses import dataclass

from tests.stories.operator import Operator

WAYS = ("keys", "mouse", "finger")
PANEL = (1024, 600)  # the smallest screen, where fingers have least room


@dataclass
class Hand:
    """Does what a story asks in one of the ways, and in no other."""

    operator: Operator
    way: str

    @property
    def by_keys(self) -> bool:
        """Whether nothing is touched."""
        return self.way == "keys"

    def press(self, text: str, on: str = "") -> None:
        """What stands on the screen, by the pointer or the finger."""
        (self.operator.clicks if self.way == "mouse" else self.operator.taps)(text, on)

    def function(self, key: str, label: str) -> None:
        """A function key, or its label; it has to be there."""
        self.operator.until(lambda: self._labelled(label), f"{key} {label}")
        if self.by_keys:
            self.operator.key(key)
        else:
            self.press(label, "FunctionKeyBar")

    def _labelled(self, label: str) -> bool:
        texts = self.operator.screen.get("texts", ())
        return any(text == label and kind == "FunctionKeyBar" for text, _x, _y, kind in texts)

    def types(self, text: str, on: str) -> None:
        """Where the keyboard is, or on drawn keys of this kind."""
        if self.by_keys:
            self.operator.writes(text)
            return
        for each in text:
            self.press({"-": "−"}.get(each, each), on)

    def fill(self, label: str, figure: str) -> None:
        """A field of a form: by keys the one that is marked, for Return leads from one to the next."""
        if self.by_keys:
            self.operator.enters(figure)
            return
        self.press(label, "ShapeRowsPanel")
        self.types(figure, "NumberPad")
        self.press("ENTER", "NumberPad")

    def row(self, text: str, marked: str, letter: str) -> None:
        """A row of the list is opened: by its letter, or by a touch that marks it and one more.

        ``marked`` is said of it then.
        """
        if self.by_keys:
            self.operator.key(letter)
        else:
            if not self.operator.shows(marked):
                self.press(text, "ShapeRowsPanel")
                self.operator.sees(marked)
            self.press(text, "ShapeRowsPanel")
        self.operator.until(lambda: not self.operator.shows(text), f"{text} opened")
