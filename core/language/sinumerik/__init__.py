"""The SINUMERIK turning dialect as text: words, lines, and what is wrong with them."""

from core.language.sinumerik.sinumerik_lexer import lex_line
from core.language.sinumerik.sinumerik_words import Form, Line, Word

__all__ = ["Form", "Line", "Word", "lex_line"]
