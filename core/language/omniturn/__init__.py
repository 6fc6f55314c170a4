"""The OmniTurn dialect as text: words, lines and what is wrong with them."""

from core.language.omniturn.lexer import lex_line
from core.language.omniturn.words import Line, Word

__all__ = ["Line", "Word", "lex_line"]
