"""Interpreter of OmniTurn programs, with one module for each family of G and M codes."""
