"""Reader of the SINUMERIK turning dialect: words, lines and syntax errors."""

from core.language.sinumerik.sinumerik_lexer import lex_line
from core.language.sinumerik.sinumerik_words import Form, Line, Word

__all__ = ["Form", "Line", "Word", "lex_line"]
