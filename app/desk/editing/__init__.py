"""The F3 editor without Qt: the text on the desk, its proof while it is typed, its files and its versions."""
