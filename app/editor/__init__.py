"""Page EDITOR (F3): the text, its proof during typing, its files and its versions; model and view."""
