"""Conversion of turning programs of other controls to OmniTurn."""
