"""Editor page (F3): program text, live proof of the text, program files and version history.

The package contains the model and the views.
"""
