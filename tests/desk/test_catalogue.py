"""Sentences, sentences with values, values that are sentences; and texts that are nobody's."""

from __future__ import annotations

import pytest

from app.desk.translation import Catalogue, data, speak, tr

KNOWN = {
    "READY": "LISTO",
    "following error": "error de seguimiento",
    "REFUSED: %1": "RECHAZADO: %1",
    "%1 is %2 off": "%1 está a %2",
    "{made} OF {target} PARTS": "DE {target} PIEZAS, {made}",
    "the entry is longer than %1 characters": "la entrada pasa de %1 caracteres",
    "LINE %1: ": "LÍNEA %1: ",
    "WILL NOT RUN: %1%2": "NO CORRERÁ: %1%2",
    "SPINDLE %1": "HUSILLO %1",
    "spindle has stopped": "el husillo se detuvo",
    "LINE %1": "LÍNEA %1",
    "in": "pulg",
    "in/min": "pulg/min",
    "{number} OF {count}": "{number} DE {count}",
}


@pytest.fixture
def spanish() -> Catalogue:
    return Catalogue(lambda text: KNOWN.get(text, ""), [text for text in KNOWN if "%" in text or "{" in text])


@pytest.mark.parametrize(
    ("english", "told"),
    [
        ("READY", "LISTO"),
        ("FOLLOWING ERROR", "ERROR DE SEGUIMIENTO"),
        ("REFUSED: Z is 2.1 off", "RECHAZADO: Z está a 2.1"),
        ("3 OF 9 PARTS", "DE 9 PIEZAS, 3"),
        ("REFUSED: the entry is longer than 80 characters", "RECHAZADO: la entrada pasa de 80 caracteres"),
        ("READY  ·  X  ·  READY", "LISTO  ·  X  ·  LISTO"),
        ("SPINDLE HAS STOPPED · READY", "EL HUSILLO SE DETUVO · LISTO"),
        ("LINE 4: X · 3 OF 9 PARTS · READY", "LÍNEA 4: X · DE 9 PIEZAS, 3 · LISTO"),
        ("300.00 in/min", "300.00 pulg/min"),
        ("0.00800 in … 0.08000 in", "0.00800 pulg … 0.08000 pulg"),
        ("4 in line", "4 in line"),
        ("−0.12345", "−0.12345"),
        ("bushing.nc", "bushing.nc"),
        ("", ""),
        ("LISTO", "LISTO"),
        ("nobody knows this sentence", "nobody knows this sentence"),
    ],
)
def test_what_is_known_is_told(spanish: Catalogue, english: str, told: str) -> None:
    assert spanish.translate(english) == told


def test_the_more_exact_sentence_wins() -> None:
    known = {"%1 FIRST": "PRIMERO %1", "PRESS %1 FIRST": "PULSE PRIMERO %1"}
    catalogue = Catalogue(lambda text: known.get(text, ""), known)
    assert catalogue.translate("PRESS R FIRST") == "PULSE PRIMERO R"
    assert catalogue.translate("STOP FIRST") == "PRIMERO STOP"


def test_signs_of_patterns_are_only_signs() -> None:
    known = {"(%1) [word+ *%2": "(%2) [otra+ *%1"}
    catalogue = Catalogue(lambda text: known.get(text, ""), known)
    assert catalogue.translate("(a) [word+ *b") == "(b) [otra+ *a"


def test_tr_is_english_until_somebody_translates() -> None:
    assert tr("READY") == "READY"
    speak(lambda text: {"READY": "LISTO"}.get(text, ""))
    try:
        assert tr("READY") == "LISTO"
        assert tr("ALARM") == "ALARM"
    finally:
        speak(None)


def test_a_hole_does_not_reach_into_the_next_part(spanish: Catalogue) -> None:
    assert spanish.translate("SPINDLE HAS STOPPED  ·  LINE 4") == "EL HUSILLO SE DETUVO  ·  LÍNEA 4"


def test_two_holes_and_a_preposition_are_not_found_in_a_name(spanish: Catalogue) -> None:
    assert spanish.translate("BUSH OF BRASS") == "BUSH OF BRASS"
    assert spanish.translate("{number} OF {count}") == "{number} DE {count}"


def test_what_a_program_says_is_never_translated() -> None:
    known = {
        "STEP": "PASO",
        "WILL NOT RUN: %1": "NO CORRERÁ: %1",
        "%1 is not defined.": "%1 no está definido.",
        "CONTROL IN %1": "CONTROL EN %1",
        "{name} SAVED": "{name} GUARDADO",
    }
    spanish = Catalogue(lambda text: known.get(text, ""), [t for t in known if "%" in t or "{" in t])
    assert spanish.translate("STEP is not defined.") == "STEP no está definido."
    assert spanish.translate("WILL NOT RUN: STEP is not defined.") == "NO CORRERÁ: STEP no está definido."
    assert spanish.translate("STEP SAVED") == "STEP GUARDADO"  # a program of that name
    assert spanish.translate("CONTROL IN STEP") == "CONTROL EN PASO"  # the screen's own word
    speak(spanish.translate, "es")
    try:
        assert tr("STEP") == "PASO"
        assert tr(f"CONTROL IN {data('STEP')}") == "CONTROL EN STEP"
        assert tr(data("STEP")) == "STEP"
    finally:
        speak(None)
    assert tr(data("STEP")) == "STEP"
