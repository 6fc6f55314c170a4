"""Which strings of the source code the translation catalog takes as templates."""

import ast

from resources.translations.text_extraction import find_marked_texts

CODE = """
Message("a {x}}}", x=1)
DriverError("b {x}}}", "axis", x=1)
Fault("c {x}", "axis", x=1)
DriverError("of a cause", "axis", reason="far")
DriverError(f"d {x}", reason="far")
Other("e {x}", x=1)
"""


def test_driver_error_texts_with_values_are_found_as_templates() -> None:
    assert list(find_marked_texts(ast.parse(CODE))) == ["a {x}}}", "b {x}}}", "c {x}"]
