"""Page of the Python package, from the signatures and numpy docstrings of its public names, as Doxygen's Markdown."""
import importlib
import inspect
import re
import sys

SECTION = re.compile(r"^(\w[\w ]*)\n-{3,}\n", re.MULTILINE)
MODULES = ("latcon", "latcon.fit")
WIDEST = 90  # characters of a line of code


class Raw(str):
    """Annotation that a signature shows without quotes."""

    __repr__ = str.__str__


def public(module):
    """(name, object) of the public names of a module: functions in the order of their sources, then classes, then errors."""
    names = [*module.__all__, *["open"] * hasattr(module, "open")]
    things = [(name, getattr(module, name)) for name in names]

    def rank(item):
        thing = item[1]
        is_error = inspect.isclass(thing) and issubclass(thing, BaseException)
        return (inspect.isclass(thing) + is_error, item[0].lower())
    return sorted(things, key=rank)


def members(thing):
    """(name, function, whether it is called) of the public members of a class that have a docstring."""
    for name, value in vars(thing).items():
        function = getattr(value, "func", getattr(value, "fget", value))  # of properties
        if not name.startswith("_") and inspect.isfunction(function) and inspect.getdoc(function):
            yield name, function, function is value


def signature(name, function):
    """Call of a function, with the annotations of the sources; a long one has a line per parameter."""
    found = inspect.signature(function)
    parameters = [parameter.replace(annotation=Raw(parameter.annotation) if parameter.annotation is not parameter.empty
                                    else parameter.empty)
                  for key, parameter in found.parameters.items() if key != "self"]
    result = found.return_annotation
    bare = found.replace(parameters=parameters, return_annotation=found.empty)
    arrow = "" if result in (found.empty, None, "None") else f" -> {result}"
    call = f"{name}{bare}{arrow}"
    if len(call) <= WIDEST:
        return call
    words = [str(parameter) for parameter in parameters]
    first = next((i for i, parameter in enumerate(parameters) if parameter.kind is parameter.KEYWORD_ONLY), None)
    if first is not None and not any(parameter.kind is parameter.VAR_POSITIONAL for parameter in parameters):
        words.insert(first, "*")
    return f"{name}(\n    " + ",\n    ".join(words) + f"){arrow}"


def inline(text):
    """Text with reStructuredText's roles as Markdown."""
    text = re.sub(r":math:`([^`]+)`", r"\\f$\1\\f$", text)
    text = re.sub(r":\w+:`~?([^`]+)`", r"`\1`", text)
    text = text.replace("``", "`")
    # Outside code, Doxygen interprets <, # and @.
    pieces = re.split(r"(`[^`]*`|\\f\$.*?\\f\$)", text)
    return "".join(piece if i % 2 else re.sub(r"([<>#@*])", r"\\\1", piece) for i, piece in enumerate(pieces))


def listed(text):
    """Entries of a section, "name : type" and an indented text each, as a list."""
    lines = []
    for line in text.strip("\n").split("\n"):
        if line and not line.startswith(" "):
            name, _, kind = line.partition(" : ")
            names = ", ".join(f"`{word}`" for word in name.replace("*", "").split(", "))
            lines.append(f"- {names}" + (f" (`{kind}`)" if kind else "") + ":")
        else:
            lines.append("  " + inline(line.strip()) if line.strip() else "")
    return "\n".join(lines)


def described(text):
    """A docstring as Markdown: paragraphs, lists of parameters, attributes, results and errors, examples."""
    pieces = SECTION.split(text)
    done = [inline(pieces[0].strip())]
    for title, body in zip(pieces[1::2], pieces[2::2]):
        done.append(f"<b>{title}</b>")
        done.append(f"~~~~{{.py}}\n{body.strip()}\n~~~~" if title == "Examples" else listed(body))
    return "\n\n".join(part for part in done if part)


def entry(level, name, thing, call=None):
    anchor = "python-" + re.sub(r"\W+", "-", name)
    code = f"~~~~{{.py}}\n{call}\n~~~~\n\n" if call else ""
    return f"{'#' * level} {name} {{#{anchor}}}\n\n{code}{described(inspect.getdoc(thing))}\n"


def describe(module):
    done = []
    for name, thing in public(module):
        full = f"{module.__name__}.{name}"
        if not inspect.isclass(thing):
            done.append(entry(2, full, thing, signature(full, thing)))
            continue
        is_called = "__init__" in vars(thing) and not issubclass(thing, BaseException)
        done.append(entry(2, full, thing, signature(full, thing) if is_called else None))
        done += [entry(3, f"{name}.{member}", function, signature(f"{name}.{member}", function) if is_method else None)
                 for member, function, is_method in members(thing)]
    return "\n".join(done)


def page(root):
    """Sections of the page, a section per module.

    root: folder of the project, whose package is described.
    """
    sys.path.insert(0, str(root / "python"))
    sys.dont_write_bytecode = True
    done = []
    for name in MODULES:
        module = importlib.import_module(name)
        done.append(f"# {name} {{#python-module-{name.replace('.', '-')}}}\n\n{describe(module)}")
    return "\n\n".join(done)
