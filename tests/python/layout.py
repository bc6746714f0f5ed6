"""The structs, enumerators and constants that header.py reads are those of a C compiler.

layout.py CC INCLUDE PACKAGE: compiles a program that prints the size of every struct, the offset and size of every
field, every enumerator and every constant, and compares each with the package's.
"""
import ctypes
import importlib.util
import os
import re
import subprocess
import sys
import tempfile


def expected(c) -> list:
    """What the package says, line by line, and the C expression that must print the same."""
    rows = []
    for struct in c.STRUCTS:
        rows.append(("sizeof(%s)" % struct.__name__, ctypes.sizeof(struct)))
        for name, _ in struct._fields_:
            field = getattr(struct, name)
            rows.append(("offsetof(%s, %s)" % (struct.__name__, name), field.offset))
            rows.append(("sizeof(((%s *)0)->%s)" % (struct.__name__, name), field.size))
    for name in dir(c):
        if name.startswith("KILN_") and name != "KILN_ZERO":
            rows.append((name, getattr(c, name)))
    return rows


def enumerators(include: str, c) -> list:
    """Each enumerator of the headers by its own name: words() cuts the common beginning off."""
    text = ""
    for name in ("kiln.h", "brdf.h", "course.h", "check.h"):
        with open(os.path.join(include, "kiln", name), encoding="utf-8") as file:
            text += re.sub("//.*", "", file.read())
    rows = []
    for enum, words in c.WORDS.items():
        body = text[text.index("typedef enum %s {" % enum):]
        body = body[:body.index("}")]
        for word, value in words.items():
            end = word.upper().replace("-", "_")
            names = {n.strip("(),=;") for n in body.split() if n.startswith("KILN_")}
            found = [n for n in names if n.endswith("_" + end)]
            # The shortest is meant: KILN_TABLE_E, not KILN_TABLE_XYZ_E.
            rows.append((min(found, key=len), value))
    return rows


def program(rows: list) -> str:
    lines = ["#include <kiln/check.h>", "#include <kiln/course.h>", "#include <stdio.h>", "int main(void)", "{"]
    lines += ['    printf("%%lld\\n", (long long)(%s));' % expression for expression, _ in rows]
    lines += ['    printf("%.17g\\n", KILN_ZERO);', "    return 0;", "}", ""]
    return "\n".join(lines)


def main(cc: str, include: str, package: str) -> None:
    spec = importlib.util.spec_from_file_location("_header", os.path.join(package, "_header.py"))
    c = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(c)
    rows = expected(c) + enumerators(include, c)
    with tempfile.TemporaryDirectory() as work:
        source, binary = os.path.join(work, "layout.c"), os.path.join(work, "layout")
        with open(source, "w") as file:
            file.write(program(rows))
        subprocess.check_call([cc, "-std=c17", "-O0", "-I", include, source, "-o", binary])
        printed = subprocess.check_output([binary], text=True).split()
    assert len(printed) == len(rows) + 1
    wrong = [(e, v, p) for (e, v), p in zip(rows, printed) if int(p) != v]
    for expression, value, in_c in wrong:
        print("%s is %s in C, %d in Python" % (expression, in_c, value))
    assert float(printed[-1]) == c.KILN_ZERO
    assert len(c.STRUCTS) >= 40 and len(rows) > 600, "%d structs, %d rows" % (len(c.STRUCTS), len(rows))
    sys.exit(1 if wrong else print("%d structs, %d numbers" % (len(c.STRUCTS), len(rows))))


main(*sys.argv[1:])
