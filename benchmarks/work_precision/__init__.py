"""Error against CPU time of the library's methods and of Siconos' Moreau-Jean scheme."""
