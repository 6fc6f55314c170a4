"""How a user says the stock; alone here, because the command line shows it before it loads anything."""

FORMS = (
    "bar:D, bar:D:LENGTH, tube:D:BORE, tube:D:BORE:LENGTH, profile:FILE.csv or after:FILE.nc, then +ALLOWANCE"
)
