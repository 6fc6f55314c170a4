"""Our ``dataclass`` against Python's own, class by class: whoever reads one must be right about the other."""

from __future__ import annotations

import copy
import dataclasses
import math
import pickle
from collections.abc import Callable
from dataclasses import FrozenInstanceError, field, replace
from typing import Any

import pytest

from core.dataclass import dataclass


def both(**options: bool) -> Callable[[type], tuple[Any, Any]]:
    """The same body made by ours and by Python's own."""

    def made(cls: type) -> tuple[Any, Any]:
        body = {name: value for name, value in vars(cls).items() if name not in {"__dict__", "__weakref__"}}
        return tuple(  # type: ignore[return-value]
            make(**options)(type(cls.__name__, cls.__bases__, dict(body)))
            for make in (dataclass, dataclasses.dataclass)
        )

    return made


@both(frozen=True, slots=True)
class Tool:
    """Fields of every kind."""

    number: int
    nose: float = 0.4
    holders: list[str] = field(default_factory=list)
    note: str = field(default="", compare=False)
    text: str = field(default="as read", repr=False, kw_only=True)


@both(slots=True)
class Count:
    """What may be changed, and what it makes itself."""

    parts: int
    scrap: int = 0
    seen: list[int] = field(init=False, default_factory=list)
    rest: int = field(init=False)

    def __post_init__(self) -> None:
        self.rest = self.parts - self.scrap


@dataclass(frozen=True, slots=True)
class Slide:
    """For pickle, which finds classes by name."""

    letter: str
    travel: tuple[float, float] = (0.0, 1.0)


@dataclass(frozen=True, slots=True)
class Cross(Slide):
    """More of the same."""

    radius: bool = True


@pytest.mark.parametrize(
    ("words", "named"),
    [((3,), {}), ((3, 0.8, ["a"]), {"text": "x"}), ((), {"number": 3, "note": "n"})],
)
def test_an_object_shows_compares_and_hashes_as_pythons_own(
    words: tuple[Any, ...], named: dict[str, Any]
) -> None:
    ours, pythons = (made(*words, **named) for made in Tool)
    assert repr(ours).rpartition(".")[2] == repr(pythons).rpartition(".")[2]
    assert dataclasses.astuple(ours) == dataclasses.astuple(pythons)
    assert ours == replace(ours, note="another")
    assert ours != replace(ours, nose=9.0)
    assert ours != pythons
    with pytest.raises(TypeError, match="unhashable type: 'list'"):
        hash(ours)


def test_the_hash_is_that_of_what_is_compared() -> None:
    assert hash(Slide("X")) == hash(("X", (0.0, 1.0)))
    assert {Slide("X"), Slide("X"), Cross("X")} == {Slide("X"), Cross("X")}
    assert len({Slide("X"), Cross("X")}) == 2


def test_a_factory_makes_anew_for_each_object() -> None:
    first, second = Tool[0](1), Tool[0](2)
    first.holders.append("A")
    assert second.holders == []


def test_what_is_not_a_number_is_equal_where_it_is_the_same_as_in_pythons_own() -> None:
    for made in Tool:
        assert made(1, math.nan) == made(1, math.nan)
        assert made(1, math.nan) != made(1, float("nan"))


def test_what_may_be_changed_has_no_hash_and_is_finished_by_its_own_method() -> None:
    for made in Count:
        count = made(5, 2)
        assert (count.rest, count.seen) == (3, [])
        count.scrap = 4
        assert (count.rest, replace(count).rest) == (3, 1)
        assert made.__hash__ is None


def test_fields_and_places_are_told_as_by_pythons_own() -> None:
    for ours, pythons in (Tool, Count):
        assert ours.__match_args__ == pythons.__match_args__
        assert ours.__slots__ == pythons.__slots__
        assert [(f.name, f.init, f.kw_only) for f in dataclasses.fields(ours)] == [
            (f.name, f.init, f.kw_only) for f in dataclasses.fields(pythons)
        ]


@pytest.mark.parametrize("value", [Slide("Z", (1.0, 2.0)), Cross("X", radius=False)])
def test_it_is_copied_and_pickled(value: Slide) -> None:
    for again in (copy.deepcopy(value), pickle.loads(pickle.dumps(value))):
        assert again == value
        assert repr(again) == repr(value)


def test_a_class_keeps_its_own_methods() -> None:
    @dataclass(frozen=True, slots=True)
    class Curve:
        points: list[int]

        def __eq__(self, other: object) -> bool:
            return self is other

        def __hash__(self) -> int:
            return 7

        def __repr__(self) -> str:
            return "a curve"

    curve = Curve([1])
    assert (curve == Curve([1]), hash(curve), repr(curve)) == (False, 7, "a curve")


def test_without_equality_objects_are_themselves() -> None:
    @dataclass(slots=True, eq=False)
    class Page:
        name: str

    page = Page("a")
    assert page != Page("a")
    assert len({page, page, Page("a")}) == 2


@pytest.mark.parametrize("wrong", [{}, {"number": 1, "colour": 2}, {"note": "n"}])
def test_wrong_arguments_are_refused_as_by_pythons_own(wrong: dict[str, Any]) -> None:
    said = []
    for made in Tool:
        with pytest.raises(TypeError) as refused:
            made(**wrong)
        said.append(str(refused.value))
    assert said[0] == said[1]


def test_too_many_are_refused_also_before_and_after_the_first_object() -> None:
    @dataclass(slots=True)
    class Empty:
        pass

    for _ in range(2):
        with pytest.raises(
            TypeError, match=r"Empty\.__init__\(\) takes 1 positional argument but 2 were given"
        ):
            Empty(1)  # type: ignore[call-arg]
    assert Empty() == Empty()
    assert repr(Empty()).endswith("Empty()")


@pytest.mark.parametrize("name", ["letter", "nobody"])
def test_a_frozen_one_refuses_changes(name: str) -> None:
    slide = Cross("X")
    with pytest.raises(FrozenInstanceError, match=f"cannot assign to field '{name}'"):
        setattr(slide, name, "Y")
    with pytest.raises(FrozenInstanceError, match=f"cannot delete field '{name}'"):
        delattr(slide, name)
    assert slide.letter == "X"


def test_a_default_that_all_would_share_is_refused() -> None:
    with pytest.raises(ValueError, match="mutable default"):

        @dataclass(slots=True)
        class Shared:
            names: list[str] = []  # noqa: RUF012


def test_a_field_without_a_default_after_one_is_refused_at_the_first_object() -> None:
    @dataclass(slots=True)
    class Turned:
        first: int = 0
        second: int  # type: ignore[misc]

    with pytest.raises(SyntaxError, match="default"):
        Turned(1, 2)
