"""Parser of the OmniTurn dialect, with words, lines and syntax errors."""

from core.language.omniturn.omniturn_lexer import lex_line
from core.language.omniturn.omniturn_words import LexedLine, Word

__all__ = ["LexedLine", "Word", "lex_line"]
