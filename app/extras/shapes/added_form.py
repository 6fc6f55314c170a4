"""A form that another optional feature adds to the list of shapes."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from pathlib import Path

from app.desk.pages.sheet import Key
from app.extras.shapes.shape_form import ShapeForm
from core.extras.shapes.shape import Shape
from core.extras.shapes.shape_setting import Setting

Show = Callable[[ShapeForm], str | None]
"""Shows what a form has worked out, and returns the whole text; None when the form is no longer open."""


class AddedForm(ABC):
    """One form of the list, with what it works out beside the screen. ``key`` opens it."""

    key: str
    shape: Shape

    @abstractmethod
    def open_form(self, setting: Setting, before: tuple[str, ...], wanted: Path | None) -> ShapeForm:
        """Return a new form; ``before`` are the lines in front, ``wanted`` is the file to begin with."""

    @abstractmethod
    def makes_of(self, name: str) -> bool:
        """Return whether this form makes a program of a file of this name."""

    @abstractmethod
    def work(self, form: ShapeForm, show: Show, tell: Callable[[str], None]) -> None:
        """Work out what has been typed; ``tell`` is told why that is impossible."""

    @abstractmethod
    def cancel(self, form: ShapeForm) -> None:
        """Stop working."""

    @abstractmethod
    def keys(self, form: ShapeForm, show: Show) -> Mapping[int, Key]:
        """Return the function keys that only this form has."""

    @abstractmethod
    def prompt(self, form: ShapeForm) -> str:
        """Return what the prompt line says."""

    @abstractmethod
    def poll(self) -> None:
        """Take up what the workers have found; called once a frame."""

    @abstractmethod
    def close(self) -> None:
        """End the workers."""
