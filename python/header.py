"""Reads kiln's C headers and writes what the Python package takes from them.

In: include/kiln/kiln.h, brdf.h, course.h and check.h. Out, by write():
  _header.py  constants, enumerators, structs as ctypes, the types of all functions, and their comments
  brdf.py     the functions of brdf.h whose arguments and results are numbers, on arrays, with types and docstrings
  each.c      a loop over arrays in C for each function of brdf.py

Names, ranges, defaults and comments then stand in the headers alone. The headers keep to a few forms (a function
begins with KILN_API, a comment of a declaration with ///), which is what the regular expressions below rely on;
text between declarations that they do not know ends the run with an error. tests/python/layout.py compares sizes,
offsets and values with those of a C compiler.
SPDX-License-Identifier: MIT
"""

import os
import re
import textwrap
from typing import Dict, List, NamedTuple, Tuple

HEADERS = ("kiln.h", "brdf.h", "course.h", "check.h")

PLAIN = {
    "int": "c_int", "unsigned": "c_uint", "double": "c_double", "float": "c_float", "bool": "c_bool",
    "size_t": "c_size_t", "ptrdiff_t": "c_ssize_t", "uint32_t": "c_uint32", "uchar": "c_ubyte", "uint64_t": "c_uint64",
}


# Comments that belong to the declaration before them.
AFTER = r"((?:\s*/\*\*<[0-9a-f]*\*\*/)+)"


class Member(NamedTuple):
    """A field of a struct, or a parameter of a function."""

    name: str
    base: str  # type without const, for example "double", "kiln_map"
    stars: int  # number of pointers to the base
    dims: Tuple[str, ...]  # dimensions of an array, as written
    function: bool  # a pointer to a function
    constant: bool  # what is pointed to is const
    comment: str


class Function(NamedTuple):
    name: str
    result: Member
    parameters: List[Member]
    comment: str


class Header(NamedTuple):
    constants: Dict[str, str]
    enums: Dict[str, List[Tuple[str, int]]]
    structs: Dict[str, List[Member]]
    functions: Dict[str, Function]
    comments: Dict[str, str]


def _strip(text: str) -> str:
    """Documenting comments become marks of hexadecimal digits that stay with their declarations, /**...**/ for
    /// and /**<...**/ for ///<. Other comments and lines of the preprocessor go."""
    lines = []
    for line in text.split("\n"):
        code, mark, comment = line.partition("///")
        if mark:
            after = "<" if comment.startswith("<") else ""
            line = code + "/**" + after + comment.lstrip("<").strip().encode().hex() + "**/"
        else:
            line = line.split("//")[0]
        if not line.lstrip().startswith("#"):
            lines.append(line)
    return "\n".join(lines)


def _comment(text: str) -> str:
    return " ".join(bytes.fromhex(part).decode() for part in re.findall(r"/\*\*<?([0-9a-f]*)\*\*/", text))


def _code(text: str) -> str:
    text = text.replace("unsigned char", "uchar")  # one word, as all other types
    return " ".join(re.sub(r"/\*\*.*?\*\*/", " ", text).split())


def _member(code: str, comment: str = "") -> Member:
    """Reads one declaration, for example "const double (*directions)[3]"."""
    function = re.match(r"(.*?)\(\*(\w+)\)\s*\((.*)\)$", code)
    if function:
        return Member(function.group(2), "function", 0, (), True, False, comment)
    rows = re.match(r"(const )?(\w+) \(\*(\w+)\)\[(.+)\]$", code)  # a pointer to rows of numbers
    if rows:
        return Member(rows.group(3), rows.group(2), 1, (), False, bool(rows.group(1)), comment)
    match = re.match(r"(const )?(\w+)\s*((?:\*|const|\s)*)(\w*)((?:\[[^\]]*\])*)$", code)
    if not match:
        raise ValueError("kiln's header: cannot read the declaration '%s'" % code)
    return Member(match.group(4), match.group(2), match.group(3).count("*"),
                  tuple(re.findall(r"\[([^\]]*)\]", match.group(5))), False, bool(match.group(1)), comment)


def _split(code: str) -> List[str]:
    """Splits at commas outside of parentheses."""
    parts, depth = [""], 0
    for c in code:
        depth += (c == "(") - (c == ")")
        if c == "," and depth == 0:
            parts.append("")
        else:
            parts[-1] += c
    return [part.strip() for part in parts]


def _fields(body: str) -> List[Member]:
    members = []
    body = re.sub(r";" + AFTER, r"\1;", body)
    for part in body.split(";"):
        code, comment = _code(part), _comment(part)
        if not code:
            continue
        if "(*" in code:
            members.append(_member(code, comment))
            continue
        first, *others = _split(code)
        members.append(_member(first, comment))
        base = re.match(r"(const )?\w+ ", first).group(0)
        members += [_member(base + other, comment) for other in others]
    return members


def _enumerators(body: str) -> Tuple[List[Tuple[str, str]], Dict[str, str]]:
    body = re.sub(r"," + AFTER, r"\1,", body)
    rows, comments, value = [], {}, -1
    for part in body.split(","):
        code = _code(part)
        if not code:
            continue
        name, _, given = (word.strip() for word in code.partition("="))
        value = int(given, 0) if given else value + 1
        rows.append((name, value))
        comments[name] = _comment(part)
    return rows, comments


NOTE = r"(?:/\*\*<?[0-9a-f]*\*\*/\s*)*"
FORMS = re.compile(
    r"(?P<enum_note>" + NOTE + r")(?:typedef )?enum\s*(?P<enum_name>\w*)\s*\{(?P<enum_body>.*?)\}\s*\w*;"
    r"|" + NOTE + r"typedef struct \w+ \w+;"
    r"|(?P<struct_note>" + NOTE + r")(?:typedef )?struct (?P<struct_name>\w+)\s*\{(?P<struct_body>.*?)\n\}\s*\w*;"
    r"|(?P<call_note>" + NOTE + r")KILN_API\s+(?:KILN_CHECKED\s+)?(?P<call_code>[^;]*?);"
    r'|\s+|extern "C" \{|\}|/\*\*<?[0-9a-f]*\*\*/', re.S)


def _function(code: str, comment: str) -> Function:
    match = re.match(r"(.*?)(\w+)\((.*)\)$", " ".join(code.split()))
    parameters = [] if match.group(3) == "void" else [_member(part) for part in _split(match.group(3))]
    return Function(match.group(2), _member(match.group(1).strip()), parameters, comment)


def _read_text(text: str, header: Header) -> None:
    for name, value in re.findall(r"^#define (KILN_\w+) ([0-9][\w.+-]*)$", text, re.M):
        header.constants[name] = value
    text, at = _strip(text), 0
    while at < len(text):
        match = FORMS.match(text, at)
        if not match:
            raise ValueError("kiln's header: cannot read: %s" % text[at:at + 200])
        at = match.end()
        if match.group("enum_body"):
            rows, comments = _enumerators(match.group("enum_body"))
            header.comments.update(comments)
            if match.group("enum_name"):
                header.enums[match.group("enum_name")] = rows
                header.comments[match.group("enum_name")] = _comment(match.group("enum_note"))
            else:
                header.constants.update((name, str(value)) for name, value in rows)
        elif match.group("struct_name"):
            header.structs[match.group("struct_name")] = _fields(match.group("struct_body"))
            header.comments[match.group("struct_name")] = _comment(match.group("struct_note"))
        elif match.group("call_code"):
            function = _function(match.group("call_code"), _comment(match.group("call_note")))
            header.functions[function.name] = function


def read(folder: str) -> Header:
    """Reads the headers of a folder include/kiln."""
    header = Header({}, {}, {}, {}, {})
    for name in HEADERS:
        with open(os.path.join(folder, name), encoding="utf-8") as file:
            _read_text(file.read(), header)
    return header


# --------------------------------------------------------------------------------------------------- _header.py


def _ctype(header: Header, member: Member, parameter: bool) -> str:
    """The type of a member in ctypes. Arrays are pointers in parameters."""
    stars = member.stars + (1 if parameter and member.dims else 0)
    if member.function:
        return "c_void_p"
    if member.base == "char" and stars == 1 and not member.dims:
        return "c_char_p"
    if stars:
        known = member.base in header.structs and stars == 1 and not member.dims
        kind = "POINTER(%s)" % member.base if known else "c_void_p"
    elif member.base in header.structs:
        kind = member.base
    elif member.base in header.enums:
        kind = "c_int"
    elif member.base == "char":
        kind = "c_char"
    else:
        kind = PLAIN[member.base]
    if not parameter:
        for dim in reversed(member.dims):
            kind = "(%s * (%s))" % (kind, dim)
    return kind


def _header_py(header: Header) -> str:
    out = ['"""Written by header.py from kiln\'s headers: constants, structs, functions and their comments."""',
           "from ctypes import (POINTER, Structure, c_bool, c_char, c_char_p, c_double, c_float, c_int, c_size_t,",
           "                    c_ssize_t, c_ubyte, c_uint, c_uint32, c_uint64, c_void_p)", ""]
    out += ["%s = %s" % pair for pair in header.constants.items()]
    out += ["", "# The word and the number of each enumerator.", "WORDS = {"]
    for name, rows in header.enums.items():
        pairs = zip(words(header, name), rows)
        out.append("    %r: {%s}," % (name, ", ".join("%r: %d" % (word, row[1]) for word, row in pairs)))
    out += ["}"]
    for name, fields in header.structs.items():
        out += ["", "", "class %s(Structure):" % name]
        out.append("    pass")
    out += ["", ""]
    # A struct by value must be complete before the struct that holds it, whatever the headers' order.
    done: List[str] = []

    def complete(name: str) -> None:
        if name in done:
            return
        for field in header.structs[name]:
            if field.base in header.structs and not field.stars:
                complete(field.base)
        done.append(name)
        out.append("%s._fields_ = [" % name)
        out.extend("    (%r, %s)," % (field.name, _ctype(header, field, False)) for field in header.structs[name])
        out.append("]")

    for name in header.structs:
        complete(name)
    out += ["", "# Fields that are enumerators, and fields in which KILN_ZERO stands for 0.",
            "FIELD_ENUMS = {"]
    for name, fields in header.structs.items():
        enums = {f.name: f.base for f in fields if f.base in header.enums and not f.stars and not f.dims}
        out.append("    %r: %r," % (name, enums))
    out += ["}", "ZERO_FIELDS = {"]
    for name, fields in header.structs.items():
        zero = [f.name for f in fields if "KILN_ZERO" in f.comment]
        if zero:
            out.append("    %r: %r," % (name, zero))
    out += ["}", "", "FUNCTIONS = {"]
    for function in header.functions.values():
        nothing = function.result.base == "void" and not function.result.stars
        result = "None" if nothing else _ctype(header, function.result, True)
        out.append("    %r: (%s, [%s])," % (
            function.name, result, ", ".join(_ctype(header, p, True) for p in function.parameters)))
    out += ["}", "", "STRUCTS = [%s]" % ", ".join(header.structs), ""]
    return "\n".join(out)


# ---------------------------------------------------------------------------------------------- brdf.py, each.c


class Loop(NamedTuple):
    """A function of numbers, ready to be called for each element of arrays."""

    function: Function
    name: str  # in Python
    inputs: List[Tuple[str, int]]  # name, numbers per element
    outputs: List[Tuple[str, int]]
    choices: List[Member]  # enumerators, and a kiln_model


def _loop(header: Header, function: Function):
    """The loop for a function of numbers, or None for functions of other kinds."""
    inputs, outputs, choices = [], [], []
    for p in function.parameters:
        if p.base in header.enums and not p.stars or p.base == "kiln_model" and p.constant:
            choices.append(p)
        elif p.base == "double" and not p.stars and not p.dims:
            inputs.append((p.name, 1))
        elif p.base == "double" and p.dims and p.constant:
            inputs.append((p.name, int(p.dims[0])))
        elif p.base == "double" and p.dims:
            outputs.append((p.name, int(p.dims[0])))
        elif p.base == "double" and p.stars == 1 and not p.constant:
            outputs.append((p.name, 1))
        else:
            return None
    if function.result.base == "double":
        outputs.append(("", 1))
    elif function.result.base != "void":
        return None
    name = re.sub(r"^kiln_(brdf_)?", "", function.name)
    return Loop(function, name, inputs, outputs, choices)


def loops(header: Header, folder: str) -> List[Loop]:
    """All functions of numbers in brdf.h."""
    part = Header({}, dict(header.enums), dict(header.structs), {}, {})
    with open(os.path.join(folder, "brdf.h"), encoding="utf-8") as file:
        _read_text(file.read(), part)
    found = [_loop(header, function) for function in part.functions.values()]
    return [loop for loop in found if loop and loop.inputs]


def _each_c(all_loops: List[Loop]) -> str:
    out = ["// Written by header.py: each function of numbers of <kiln/brdf.h>, called for each element of arrays.",
           "// SPDX-License-Identifier: MIT", "#include <kiln/brdf.h>", ""]
    for loop in all_loops:
        f = loop.function
        called, declared = [], ["size_t count"]
        for p in f.parameters:
            width = dict(loop.inputs + loop.outputs).get(p.name)
            if p in loop.choices:
                declared.append("%s%s %s%s" % ("const " if p.constant else "", p.base, "*" * p.stars, p.name))
                called.append(p.name)
            else:
                read_only = p.name in dict(loop.inputs)
                declared.append("%sdouble *%s" % ("const " if read_only else "", p.name))
                at = "i" if width == 1 else "i * %d" % width
                scalar = read_only and not p.dims
                called.append("%s[%s]" % (p.name, at) if scalar else "&%s[%s]" % (p.name, at))
        result = ""
        if f.result.base == "double":
            declared.append("double *result")
            result = "result[i] = "
        signature = "KILN_API void kiln_each_%s(%s)" % (loop.name, ", ".join(declared))
        out += [signature + ";", signature, "{", "    for (size_t i = 0; i < count; i++)",
                "        %s%s(%s);" % (result, f.name, ", ".join(called)), "}", ""]
    return "\n".join(out)


def _choice_arguments(header: Header, loop: Loop) -> List[Tuple[str, str]]:
    """Names and enums of the choices; a kiln_model is two of them."""
    found = []
    for choice in loop.choices:
        if choice.base == "kiln_model":
            found += [(f.name, f.base) for f in header.structs["kiln_model"]]
        else:
            found.append((choice.name, choice.base))
    return found


def _in_python(text: str) -> str:
    """A comment of the header with the names that its functions have in Python."""
    return re.sub(r"\bkiln_(?:brdf_)?(\w+)", r"\1", text)


def _docstring(header: Header, loop: Loop) -> str:
    text = _in_python(loop.function.comment)
    if not text:  # of a sampler and its density only the sampler has a comment
        text = "Returns the density of %s." % loop.name.replace("pdf_", "sample_")
    lines = textwrap.wrap(text, 106) + [""]
    for name, enum in _choice_arguments(header, loop):
        pairs = zip(words(header, enum), header.enums[enum])
        choices = ["%s (%s)" % (word, _in_python(header.comments[row[0]]).rstrip(".")) for word, row in pairs]
        lines += textwrap.wrap("`%s` is a word: %s." % (name, "; ".join(choices)), 106)
    wide = ["`%s` has the shape (..., %d)" % pair for pair in loop.inputs if pair[1] > 1]
    if len(loop.outputs) > 1:
        result = "Returns the arrays %s, float64." % " and ".join(name for name, _ in loop.outputs)
    elif loop.outputs[0][1] > 1:
        result = "Returns %s, float64 with the shape (..., %d)." % loop.outputs[0]
    else:
        result = "Returns float64."
    shape = "Other arguments" if loop.choices else "Arguments"
    shape += " are numbers or arrays that broadcast against each other"
    lines += textwrap.wrap("%s%s. %s" % (shape, "".join("; " + text for text in wide), result), 106)
    return '    """%s\n    """' % "\n".join("    " + line if line else "" for line in lines).lstrip()


def _brdf_py(header: Header, all_loops: List[Loop]) -> str:
    out = ['"""How surfaces reflect and transmit light: the functions of numbers in <kiln/brdf.h>, on arrays.',
           "",
           "Cosines nov (n.v), nol (n.l), noh (n.h) and voh (v.h) are in [0, 1], and so is the perceptual roughness,",
           "of which alpha is the square. An argument outside its range is clamped to the range. The functions run",
           "without the interpreter's lock. Written by header.py from the header's comments.", '"""',
           "from typing import Tuple", "", "import numpy as np", "from numpy.typing import ArrayLike", "",
           "from ._each import each", ""]
    out.append("__all__ = [%s]" % ", ".join(repr(loop.name) for loop in all_loops))
    for loop in all_loops:
        choices = _choice_arguments(header, loop)
        arguments = ["%s: ArrayLike" % name for name, _ in loop.inputs]
        if choices:
            arguments.append("*")
            arguments += ['%s: str = "%s"' % (name, words(header, enum)[0]) for name, enum in choices]
        result = "np.ndarray" if len(loop.outputs) == 1 else "Tuple[%s]" % ", ".join(
            "np.ndarray" for _ in loop.outputs)
        order = [p.name for p in loop.function.parameters]
        picks = "[%s]" % ", ".join('("%s", %s)' % (enum, name) for name, enum in choices)
        model = any(choice.base == "kiln_model" for choice in loop.choices)
        out += ["", "", "def %s(%s) -> %s:" % (loop.name, ", ".join(arguments), result),
                _docstring(header, loop),
                "    return each(\"kiln_each_%s\", %s, %s, [%s], %r)" % (
                    loop.name, picks, model,
                    ", ".join('(%s, %d)' % pair for pair in loop.inputs), [width for _, width in loop.outputs])]
        # The choices come before the numbers in every signature, which each() relies on.
        if order[:len(loop.choices)] != [choice.name for choice in loop.choices]:
            raise ValueError("%s: a choice stands after a number" % loop.function.name)
    return "\n".join(out) + "\n"


def words(header: Header, enum: str) -> List[str]:
    """The words for the enumerators: without their common beginning, in lower case with hyphens."""
    names = [name for name, _ in header.enums[enum]]
    common = os.path.commonprefix(names)
    common = common[:common.rfind("_") + 1]
    return [name[len(common):].lower().replace("_", "-") for name in names]


def write(include: str, package: str, each: str) -> None:
    """Writes _header.py and brdf.py into `package`, and each.c to the path `each` ("" for no file)."""
    folder = os.path.join(include, "kiln")
    header = read(folder)
    all_loops = loops(header, folder)
    files = {os.path.join(package, "_header.py"): _header_py(header),
             os.path.join(package, "brdf.py"): _brdf_py(header, all_loops)}
    if each:
        files[each] = _each_c(all_loops)
    for path, text in files.items():
        os.makedirs(os.path.dirname(path) or ".", exist_ok=True)
        with open(path, "w", encoding="utf-8", newline="\n") as file:
            file.write(text)


if __name__ == "__main__":
    import sys

    if len(sys.argv) != 4:
        sys.exit("usage: header.py INCLUDE PACKAGE EACH_C")
    write(*sys.argv[1:])
