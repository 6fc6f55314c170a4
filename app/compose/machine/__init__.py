"""Machine files and what is made of them: circumstances of a program, setups, pages of the manual."""
