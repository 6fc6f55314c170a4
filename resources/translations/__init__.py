"""Catalogues of the operator's languages, and the script that collects what they must hold."""
