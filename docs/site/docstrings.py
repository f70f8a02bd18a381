"""Docstrings of this project as numpydoc and reStructuredText want them.

Here a parameter stands with its meaning on one line, `name : type   meaning`, and text is plain: a `|q|` is the size
of q and no reference.
"""

import re

SECTION = re.compile(r"^-{3,}$")
DESCRIBED = ("Parameters", "Attributes", "Raises", "Warns")
ENTRY = re.compile(r"^(?P<names>[\w, .*|]+?) : (?P<rest>.+)$")
ERROR = re.compile(r"^(?P<names>[A-Z]\w+(?:, [A-Z]\w+)*)(?: {2,}| : )(?P<rest>.+)$")
SPECIAL = re.compile(r"(?<!\\)([*|])|(?<=\w)_(?=\W|$)")


def setup(app):
    """Called by Sphinx."""
    app.connect("autodoc-process-docstring", rewrite, priority=100)  # before numpydoc
    return {"parallel_read_safe": True}


def rewrite(app, what, name, obj, options, lines):
    """Put the lines of a docstring in the form that is expected."""
    lines[:] = plain(split(lines))


def split(lines):
    """Entries of sections with names in one line and their meaning below; other lines as they are."""
    section = ""
    for k, line in enumerate(lines):
        if k + 1 < len(lines) and SECTION.match(lines[k + 1]):
            section = line.strip()
        entry = ERROR.match(line) if section in ("Raises", "Warns") else ENTRY.match(line)
        if section not in DESCRIBED or entry is None:
            yield line
            continue
        kind, gap, meaning = entry["rest"].partition("   ")
        if section in ("Raises", "Warns"):
            yield from (entry["names"], "    " + entry["rest"].strip())
        elif gap:
            yield from (f"{entry['names']} : {kind}", "    " + meaning.strip())
        else:
            yield from (entry["names"], "    " + entry["rest"])


def plain(lines):
    """Text without meaning for reStructuredText; examples and indented blocks of code as they are."""
    lines = list(lines)
    result, block = [], False
    for k, line in enumerate(lines):
        indented = line.startswith("    ")
        after_blank = k > 0 and not lines[k - 1].strip()
        if indented and after_blank and not block and starts_block(lines, k):
            result += ["::", ""]
            block = True
        elif line.strip() and not indented:
            block = False
        code = block or line.lstrip().startswith((">>>", "..."))
        result.append(line if code else "".join(escaped(x) for x in re.split(r"(``?[^`]*``?)", line)))
    return result


def starts_block(lines, k):
    """Whether an indented line after a blank one is code: the last text before it stands at the margin."""
    before = next((x for x in reversed(lines[:k]) if x.strip()), "")
    return not before.startswith(" ")


def escaped(text):
    """Text outside backquotes with its special characters made harmless."""
    return text if text.startswith("`") else SPECIAL.sub(lambda m: "\\" + m[0], text)
