"""The OmniTurn dialect as text: words, lines and what is wrong with them."""

from core.language.omniturn.omniturn_lexer import lex_line
from core.language.omniturn.omniturn_words import Line, Word

__all__ = ["Line", "Word", "lex_line"]
