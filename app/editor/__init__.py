"""Editor page (F3): the program text, its proof while you type, its files and its versions.

The package contains the model and the views.
"""
