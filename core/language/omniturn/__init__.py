"""Reader of the OmniTurn dialect: words, lines and syntax errors."""

from core.language.omniturn.omniturn_lexer import lex_line
from core.language.omniturn.omniturn_words import Line, Word

__all__ = ["Line", "Word", "lex_line"]
