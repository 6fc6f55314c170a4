"""Editor page (F3) for the program text, with live proof, program files and version history.

The package contains the model and the views.
"""
