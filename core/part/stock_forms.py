"""The permitted forms of a stock specification, for messages and the command-line help.

This module has no imports, because the command line shows the forms before it loads other modules.
"""

SPECIFICATION_FORMS = (
    "bar:D, bar:D:LENGTH, tube:D:BORE, tube:D:BORE:LENGTH, profile:FILE.csv or after:FILE.nc, then +ALLOWANCE"
)
