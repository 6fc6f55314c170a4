"""User texts made of a template and named values, errors with codes, and a search for similar words."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from functools import lru_cache
from typing import Any, Self

MessageValue = str | int | float
LETTER_CASES: dict[str, Callable[[str], str]] = {
    "upper": str.upper,
    "lower": str.lower,
    "capitalize": str.capitalize,
    "sentence": lambda text: text[:1].upper() + text[1:],
}


class Message(str):
    """An English text that retains its template and its values for translation.

    For code that only reads the text, a message is an ordinary ``str``. ``template`` has fields as for
    ``str.format``, without format specifications. ``values`` are the values of the fields by name; a value
    may be a ``Message``. ``case`` is the change of letter case, one of ``LETTER_CASES``, or empty.
    """

    __slots__ = ("case", "template", "values")

    template: str
    values: dict[str, MessageValue]
    case: str

    def __new__(cls, template: str, /, **values: object) -> Self:
        """Fill the template with the values.

        A value that is neither text nor a number is converted with ``str(value)``.
        """
        named = ((name, values[name]) for name in _names_of(template))
        known = {name: each if isinstance(each, MessageValue) else str(each) for name, each in named}
        made = super().__new__(cls, template.format(**known))
        made.template, made.values, made.case = template, known, ""
        return made

    def __str__(self) -> str:
        """Return the message itself, not a plain string, so that it retains its template and values."""
        return self

    def __reduce__(self) -> tuple[object, ...]:
        """Return the data from which another process recreates the message."""
        return make_message, (self.template, self.values, self.case)

    def upper(self) -> Message:
        """Return the message in capitals, with the same template and values."""
        return self._in_case("upper")

    def lower(self) -> Message:
        """Return the message in lower case, with the same template and values."""
        return self._in_case("lower")

    def capitalize(self) -> Message:
        """Return the message with a capital first letter and all other letters in lower case."""
        return self._in_case("capitalize")

    def capitalize_first_letter(self) -> Message:
        """Return the message with a capital first letter; the other letters remain unchanged."""
        return self._in_case("sentence")

    def _in_case(self, case: str) -> Message:
        made = str.__new__(Message, LETTER_CASES[case](str.__str__(self)))
        made.template, made.values, made.case = self.template, self.values, case
        return made


def fill_template(text: str, values: Mapping[str, object]) -> str:
    """Fill a text with values; floats are formatted with at most six digits.

    A ``Message``, or a text without values, is returned unchanged.
    """
    if not values or isinstance(text, Message):
        return text
    return Message(text, **{name: f"{v:g}" if isinstance(v, float) else v for name, v in values.items()})


@lru_cache(4096)
def _names_of(template: str) -> tuple[str, ...]:
    from string import Formatter  # noqa: PLC0415  the help of the commands has no template

    return tuple(name for _, name, _, _ in Formatter().parse(template) if name)


def make_message(template: str, values: dict[str, MessageValue], case: str = "") -> Message:
    """Return a message with the given template, values and letter case.

    Raises KeyError if a value is missing.
    """
    made = Message(template, **values)
    return made._in_case(case) if case else made


def join_messages(separator: str, parts: Iterable[str]) -> Message:
    """Join the parts with a separator into one message; each part is translated separately."""
    values = {f"part{number}": part for number, part in enumerate(parts)}
    between = separator.replace("{", "{{").replace("}", "}}")
    return Message(between.join(f"{{{name}}}" for name in values), **values)


def collect_values(text: str) -> dict[str, MessageValue]:
    """Return the values of a message and of its nested messages by name, or {} for a plain string.

    If an outer and an inner value have the same name, the outer value is returned.
    """
    if not isinstance(text, Message):
        return {}
    inner = [collect_values(value) for value in text.values.values() if isinstance(value, Message)]
    outer = {name: _plain(value) for name, value in text.values.items()}
    return {name: value for values in (*inner, outer) for name, value in values.items()}


def _plain(value: MessageValue) -> MessageValue:
    return str.__str__(value) if isinstance(value, Message) else value


def pack_message(text: str) -> str:
    """Return the template, values and letter case of a message as JSON for storage.

    The result is an empty string for a plain string.
    """
    import json  # noqa: PLC0415  only what is stored is packed

    return json.dumps(_packed(text), ensure_ascii=False) if isinstance(text, Message) else ""


def unpack_message(packed: str, text: str) -> str:
    """Return the message packed as JSON, or ``text`` if the message cannot be used.

    A packed message cannot be used if it is empty or invalid, or if its text differs from ``text``.
    """
    if not packed:
        return text
    import json  # noqa: PLC0415  only what is stored is packed

    try:
        made = _unpacked(json.loads(packed))
    except (ValueError, LookupError, TypeError, AttributeError):
        return text
    return made if made == text else text


def _packed(value: MessageValue) -> object:
    if not isinstance(value, Message):
        return value
    return {
        "template": value.template,
        "values": {name: _packed(each) for name, each in value.values.items()},
        "case": value.case,
    }


def _unpacked(stored: object) -> Any:
    if not isinstance(stored, dict):
        return stored
    values = {name: _unpacked(each) for name, each in stored["values"].items()}
    return make_message(stored["template"], values, stored["case"])


class CodedError(Exception):
    """An error with a text for users and a code for programs and tests.

    ``code`` identifies the fault in kebab case, such as ``disk-full``, or is empty if no code is needed.
    """

    def __init__(self, text: str = "", code: str = "") -> None:
        super().__init__(text)
        self.code = code


def get_error_code(error: BaseException) -> str:
    """Return the code of an error, or an empty string if the error has no code.

    A caller that raises another error in its place uses the same code.
    """
    return error.code if isinstance(error, CodedError) else ""


def find_similar_word(word: str, known_words: Iterable[str]) -> str:
    """Return the known word most similar to ``word``, or an empty string if no word is similar."""
    from difflib import get_close_matches  # noqa: PLC0415  only who has mistyped waits for it

    return next(iter(get_close_matches(word, list(known_words), n=1)), "")
