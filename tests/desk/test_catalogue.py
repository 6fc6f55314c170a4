"""Texts with values, values that are texts, texts of the user; and texts that the catalog does not have."""

from __future__ import annotations

import pickle

import pytest

from app.desk.translation import mark_untranslated, set_translator, tr
from core.language.sinumerik.sinumerik_alarms import make_alarm_diagnostic
from core.message import Message, collect_values, join_messages

KNOWN = {
    "READY": "LISTO",
    "STEP": "PASO",
    "rapid": "rápido",
    "following error": "error de seguimiento",
    "REFUSED: {why}": "RECHAZADO: {why}",
    "{axis} is {distance} off": "{axis} está a {distance}",
    "{made} OF {target} PARTS": "DE {target} PIEZAS, {made}",
    "{name} SAVED": "{name} GUARDADO",
    "{word} is not defined.": "{word} no está definido.",
    "CONTROL IN {mode}": "CONTROL EN {mode}",
    "{{{key}}} IS MISSING": "FALTA {{{key}}}",
}


@pytest.fixture
def spanish() -> object:
    set_translator(lambda text: KNOWN.get(text, ""), "es")
    yield
    set_translator(None)


OFF = Message("{axis} is {distance} off", axis="Z", distance=2.1)


@pytest.mark.usefixtures("spanish")
@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("READY", "LISTO"),
        ("FOLLOWING ERROR", "ERROR DE SEGUIMIENTO"),
        (OFF, "Z está a 2.1"),
        (OFF.upper(), "Z ESTÁ A 2.1"),
        (Message("REFUSED: {why}", why=OFF), "RECHAZADO: Z está a 2.1"),
        (Message("REFUSED: {why}", why=ValueError(OFF)), "RECHAZADO: Z está a 2.1"),
        (Message("{made} OF {target} PARTS", made=3, target=9), "DE 9 PIEZAS, 3"),
        (Message("{what} · {more}", what="READY", more=OFF), "LISTO · Z está a 2.1"),
        (join_messages("  ·  ", ["READY", "X", OFF]), "LISTO  ·  X  ·  Z está a 2.1"),
        (join_messages(" {} ", ["READY", "X"]), "LISTO {} X"),
        (Message("{{{key}}} IS MISSING", key="a"), "FALTA {a}"),
        (Message("{word} is not defined.", word="STEP"), "STEP no está definido."),  # a word of the program
        (Message("{name} SAVED", name="STEP"), "STEP GUARDADO"),  # a program of that name
        (Message("CONTROL IN {mode}", mode="STEP"), "CONTROL EN PASO"),  # the screen's own word
        (Message("CONTROL IN {mode}", mode=mark_untranslated("STEP")), "CONTROL EN STEP"),
        (mark_untranslated("STEP"), "STEP"),
        ("−0.12345", "−0.12345"),
        ("bushing.nc", "bushing.nc"),
        ("", ""),
        ("LISTO", "LISTO"),
        ("the catalog has no such sentence", "the catalog has no such sentence"),
        (Message("NO SUCH {what}", what="READY"), "NO SUCH LISTO"),
    ],
)
def test_a_text_is_shown_in_spanish(text: str, shown: str) -> None:
    assert tr(text) == shown


@pytest.mark.usefixtures("spanish")
def test_message_used_as_a_name_value_is_translated() -> None:
    assert tr(Message("{name} SAVED", name=OFF)) == "Z está a 2.1 GUARDADO"
    assert tr(Message("{name} SAVED", name="READY")) == "READY GUARDADO"


@pytest.mark.usefixtures("spanish")
@pytest.mark.parametrize("code", [14011, "following"])
def test_sinumerik_alarm_text_is_translated(code: int | str) -> None:
    found = make_alarm_diagnostic(1, 1, code, "N10", "following error", "")
    assert tr(found.message).endswith("block N10: error de seguimiento")


def test_texts_are_english_without_a_translation_catalog() -> None:
    assert tr(OFF) == "Z is 2.1 off"
    assert tr(mark_untranslated("STEP")) == "STEP"
    assert type(tr(OFF)) is str


def test_pickled_message_retains_template_and_values() -> None:
    made = pickle.loads(pickle.dumps(Message("REFUSED: {why}", why=OFF).upper()))
    assert (made, made.template) == ("REFUSED: Z IS 2.1 OFF", "REFUSED: {why}")
    assert made.values["why"].values == {"axis": "Z", "distance": 2.1}


def test_message_with_a_missing_value_is_rejected() -> None:
    with pytest.raises(KeyError, match="distance"):
        Message("{axis} is {distance} off", axis="Z")


def test_values_of_nested_messages_are_collected() -> None:
    nested = Message("REFUSED: {why}", why=Message("{axis}: {why}", axis="X", why=OFF))
    values = collect_values(nested)
    assert values == {"axis": "X", "distance": 2.1, "why": "X: Z is 2.1 off"}
    assert all(type(value) in {str, float} for value in values.values())
    assert collect_values("plain") == {}
