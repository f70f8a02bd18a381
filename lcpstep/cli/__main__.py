"""`python -m lcpstep.cli`."""

from lcpstep.cli import command

command()
