"""What the reference names, given what it cannot take as its first argument: refused by the argument's name."""

import importlib
import inspect
import re
from pathlib import Path

import pytest

API = Path(__file__).resolve().parent.parent / "docs" / "api"
PAGES = ("simulating", "analysis", "pictures")
NAMED = [
    name
    for page in PAGES
    for name in re.findall(r"\.\. auto(?:class|function):: (lcpstep[\w.]+)", (API / f"{page}.md").read_text())
]
RESULTS = {  # classes that are made by the library, not by its users
    name for name in NAMED if name.rpartition(".")[2][0].isupper()
} - {
    "lcpstep.accuracy.errors.Difference",
    "lcpstep.maps.EventMap",
    "lcpstep.maps.ImpactMap",
    "lcpstep.maps.StroboscopicMap",
    "lcpstep.maps.SwitchMap",
}  # fmt: skip


@pytest.mark.parametrize("wrong", [5, None, {}, [1]], ids=repr)
@pytest.mark.parametrize("name", sorted(set(NAMED) - RESULTS))
def test_a_first_argument_of_the_wrong_kind_is_named(name, wrong):
    module, _, own = name.rpartition(".")
    public = getattr(importlib.import_module(module), own)
    required = [x for x in inspect.signature(public).parameters.values() if x.default is x.empty]
    given = {x.name: wrong for x in required}
    expected = rf"^({'|'.join(given)}): expected "
    with pytest.raises((TypeError, ValueError), match=expected):
        public(**given)
