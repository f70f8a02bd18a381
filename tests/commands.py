"""Commands as a user gives them, within the process of the tests."""

from lcpstep.cli import main


def run(capsys, *arguments):
    """Exit status, what was printed, and what was said of errors."""
    status = main([str(x) for x in arguments])
    return status, *capsys.readouterr()


def run_map(capsys, *arguments):
    """The same of `lcpstep map`."""
    return run(capsys, "map", *arguments)
