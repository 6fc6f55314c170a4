"""Catalogs of the operator's languages, and the script that collects their texts."""
