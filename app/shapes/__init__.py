"""The page of shapes in the editor: a form, its drawing, and the lines that it writes."""
