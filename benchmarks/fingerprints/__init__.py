"""Fingerprints of all motions of the catalogue: what a change of code alone must leave as it is."""
