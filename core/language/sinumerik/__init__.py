"""Syntax of the SINUMERIK turning dialect: parsing of lines into words, and syntax errors."""

from core.language.sinumerik.sinumerik_lexer import lex_line
from core.language.sinumerik.sinumerik_words import LexedBlock, PositionMode, Word

__all__ = ["LexedBlock", "PositionMode", "Word", "lex_line"]
