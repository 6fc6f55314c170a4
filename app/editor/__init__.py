"""The page EDITOR (F3): the text, its proof while it is typed, its files and its versions; model and view."""
