"""Docstrings of this project as numpydoc and reStructuredText want them.

Here a parameter stands with its meaning on one line, `name : type   meaning`, values are listed as `"name"  meaning`,
and text is plain: a `|q|` is the size of q and no reference.
"""

import re

SECTION = re.compile(r"^-{3,}$")
DESCRIBED = ("Parameters", "Attributes", "Raises", "Warns")
ENTRY = re.compile(r"^(?P<names>[\w, .*|]+?) : (?P<rest>.+)$")
ERROR = re.compile(r"^(?P<names>[A-Z]\w+(?:, [A-Z]\w+)*)(?: {2,}| : )(?P<rest>.+)$")
VALUE = re.compile(r'^    "[^"]+"  +\S')
SPECIAL = re.compile(r"(?<!\\)([*|])|(?<=\w)_(?=\W|$)")
CODE = re.compile(r"(``?[^`]*``?)")


def setup(app):
    """Called by Sphinx."""
    app.connect("autodoc-process-docstring", rewrite, priority=100)  # before numpydoc
    return {"parallel_read_safe": True}


def rewrite(app, what, name, obj, options, lines):
    """Put the lines of a docstring in the form that is expected."""
    lines[:] = listed(plain(split(joined(lines))))


def joined(lines):
    """What is returned in one line, however long: the lines below it go on with it."""
    result, section = [], ""
    for k, line in enumerate(lines):
        if k + 1 < len(lines) and SECTION.match(lines[k + 1]):
            section = line.strip()
        goes_on = section == "Returns" and line.startswith("    ") and result[-1].strip()
        if goes_on:
            result[-1] += " " + line.strip()
        else:
            result.append(line)
    return result


def split(lines):
    """Entries of sections with names in one line and their meaning below; other lines as they are."""
    section = ""
    for k, line in enumerate(lines):
        if k + 1 < len(lines) and SECTION.match(lines[k + 1]):
            section = line.strip()
        errors = section in ("Raises", "Warns")
        entry = ERROR.match(line) if errors else ENTRY.match(line)
        if section not in DESCRIBED or entry is None:
            yield line
            continue
        kind, gap, meaning = entry["rest"].partition("   ")
        if gap and not errors:
            yield from (f"{entry['names']} : {kind}", "    " + meaning.strip())
        else:
            yield from (entry["names"], "    " + entry["rest"].strip())


def plain(lines):
    """Text without meaning for reStructuredText; examples and indented blocks of code as they are."""
    lines = list(lines)
    block = False
    for k, line in enumerate(lines):
        indented = line.startswith("    ")
        if indented and not block and k > 0 and not lines[k - 1].strip() and starts_code(lines, k):
            yield from ("::", "")
            block = True
        elif line.strip() and not indented:
            block = False
        code = block or line.lstrip().startswith((">>>", "..."))
        yield line if code else "".join(map(escaped, CODE.split(line)))


def listed(lines):
    """Lists of values within an entry as line blocks, so that each keeps its line."""
    within = False
    for line in lines:
        if VALUE.match(line) and not within:
            within = True
            yield ""
        elif not line.startswith("    "):
            within = False
        yield f"    | {line[4:]}" if within else line


def starts_code(lines, k):
    """Whether an indented line after a blank one is code: the last text before it stands at the margin."""
    before = next((x for x in reversed(lines[:k]) if x.strip()), "")
    return not before.startswith(" ")


def escaped(text):
    """Text outside backquotes with its special characters made harmless."""
    return text if text.startswith("`") else SPECIAL.sub(lambda m: "\\" + m[0], text)
