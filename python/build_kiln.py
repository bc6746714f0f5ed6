"""Makes kiln's wheel by the standard library alone.

As a program: build_kiln.py PACKAGE OUT [--licence NAME=FILE ...]. In: the folder `kiln` of a build with its modules
and libkiln.so, and the licences of what is linked into the library. Out: the wheel in the folder OUT, and its name in
OUT/wheel.txt. The same input gives the same bytes: files are sorted and have one date.

As a backend of pyproject.toml: build_wheel configures and builds kiln by CMake, which calls this program.

The name of a wheel says on which systems it can be installed. The library's own ELF headers decide that: the
processor, the newest symbol version of glibc that it needs, and whether it needs any library besides C's.
SPDX-License-Identifier: MIT
"""

import argparse
import ast
import base64
import hashlib
import os
import re
import shutil
import struct
import subprocess
import sys
import zipfile
from typing import Any, Dict, List, NamedTuple, Set

HERE = os.path.dirname(os.path.abspath(__file__))
MACHINES = {62: "x86_64", 183: "aarch64"}  # e_machine
C_LIBRARIES = {"libc.so.6", "libm.so.6", "libpthread.so.0"}
DATE = (1980, 1, 1, 0, 0, 0)  # the earliest of a zip file


class Elf(NamedTuple):
    """What a shared library asks of a system."""

    machine: str
    needed: Set[str]  # other libraries
    versions: Set[str]  # for example "GLIBC_2.17"


def _text(data: bytes, at: int) -> str:
    return data[at:data.index(b"\0", at)].decode()


def _needed(data: bytes, at: int, size: int, strings: int) -> Set[str]:
    entries = (struct.unpack_from("<qQ", data, at + i) for i in range(0, size, 16))
    return {_text(data, strings + value) for tag, value in entries if tag == 1}  # DT_NEEDED


def _versions(data: bytes, at: int, count: int, strings: int) -> Set[str]:
    found = set()
    for _ in range(count):
        _, entries, _, first, following = struct.unpack_from("<HHIII", data, at)  # Elf64_Verneed
        entry = at + first
        for _ in range(entries):
            _, _, _, name, step = struct.unpack_from("<IHHII", data, entry)  # Elf64_Vernaux
            found.add(_text(data, strings + name))
            entry += step
        at += following
    return found


def read_elf(path: str) -> Elf:
    """Reads the dynamic section and the needed versions of a 64-bit little-endian ELF file."""
    with open(path, "rb") as file:
        data = file.read()
    if data[:6] != b"\x7fELF\x02\x01":
        raise ValueError("%s: not a 64-bit little-endian ELF file" % path)
    machine, = struct.unpack_from("<H", data, 18)
    table, = struct.unpack_from("<Q", data, 40)
    size, count = struct.unpack_from("<HH", data, 58)
    sections = [struct.unpack_from("<IIQQQQIIQQ", data, table + i * size) for i in range(count)]
    needed: Set[str] = set()
    versions: Set[str] = set()
    for _, kind, _, _, offset, length, link, info, _, _ in sections:
        if kind == 6:  # SHT_DYNAMIC
            needed = _needed(data, offset, length, sections[link][4])
        if kind == 0x6ffffffe:  # SHT_GNU_verneed
            versions = _versions(data, offset, info, sections[link][4])
    return Elf(MACHINES[machine], needed, versions)


def platforms(elf: Elf) -> List[str]:
    """The names of the systems that can load the library: each glibc from the newest version that it needs on, and
    musl, whose loader takes the C libraries' names for its own and leaves versions aside."""
    if elf.needed - C_LIBRARIES:
        return ["linux_" + elf.machine]
    minor = [int(match.group(1)) for match in (re.match(r"GLIBC_2\.(\d+)", v) for v in elf.versions) if match]
    # 2.17 is the oldest that pip of the last years asks for.
    return ["manylinux_2_%d_%s" % (max(minor + [17]), elf.machine), "musllinux_1_2_" + elf.machine]


def version(package: str) -> str:
    with open(os.path.join(package, "_header.py"), encoding="utf-8") as file:
        found = dict(re.findall(r"^KILN_VERSION_(\w+) = (\d+)$", file.read(), re.M))
    return "%s.%s.%s" % (found["MAJOR"], found["MINOR"], found["PATCH"])


def read_project() -> Dict[str, Any]:
    """The table [project] of pyproject.toml, whose values are strings and lists, as Python writes them too. Python
    reads TOML by itself from 3.11 on only."""
    with open(os.path.join(HERE, "pyproject.toml"), encoding="utf-8") as file:
        table = re.search(r"^\[project\]\n(.*?)(?=^\[|\Z)", file.read(), re.M | re.S).group(1)
    pairs = re.findall(r"^([\w-]+) = (\[.*?\]|\".*?\")(?: #[^\n]*)?$", table, re.M | re.S)
    return {key: ast.literal_eval(value) for key, value in pairs}


def metadata(number: str) -> str:
    """The file METADATA, from pyproject.toml."""
    project = read_project()
    with open(os.path.join(HERE, project["readme"]), encoding="utf-8") as file:
        readme = file.read()
    lines = ["Metadata-Version: 2.1", "Name: " + project["name"], "Version: " + number,
             "Summary: " + project["description"], "License: " + project["license"],
             "Requires-Python: " + project["requires-python"]]
    lines += ["Requires-Dist: " + name for name in project["dependencies"]]
    lines += ["Classifier: " + name for name in project["classifiers"]]
    return "\n".join(lines + ["Description-Content-Type: text/markdown", "", readme])


def files_of(package: str, tags: List[str], licences: Dict[str, str]) -> Dict[str, bytes]:
    """The files of the wheel by name, without RECORD."""
    files: Dict[str, bytes] = {}
    for name in sorted(os.listdir(package)):
        if name.endswith((".py", ".so")) or name == "py.typed":
            with open(os.path.join(package, name), "rb") as file:
                files["kiln/" + name] = file.read()
    number = version(package)
    info = "kiln_ibl-%s.dist-info/" % number
    for name, path in licences.items():
        with open(path, "rb") as file:
            files[info + "licenses/%s.txt" % name] = file.read()
    files[info + "METADATA"] = metadata(number).encode()
    wheel = "Wheel-Version: 1.0\nGenerator: kiln %s\nRoot-Is-Purelib: false\n" % number
    files[info + "WHEEL"] = (wheel + "".join("Tag: py3-none-%s\n" % tag for tag in tags)).encode()
    return files


def _record(files: Dict[str, bytes], name: str) -> bytes:
    rows = []
    for path, data in sorted(files.items()):
        digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
        rows.append("%s,sha256=%s,%d\n" % (path, digest, len(data)))
    return "".join(rows + ["%s,,\n" % name]).encode()


def write(package: str, out: str, licences: Dict[str, str]) -> str:
    """Writes the wheel of a package into a folder. Returns the wheel's name."""
    tags = platforms(read_elf(os.path.join(package, "libkiln.so")))
    files = files_of(package, tags, licences)
    number = version(package)
    record = "kiln_ibl-%s.dist-info/RECORD" % number
    files[record] = _record(files, record)
    name = "kiln_ibl-%s-py3-none-%s.whl" % (number, ".".join(tags))
    os.makedirs(out, exist_ok=True)
    part = os.path.join(out, name + ".part")
    with zipfile.ZipFile(part, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for path, data in sorted(files.items()):
            entry = zipfile.ZipInfo(path, DATE)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.create_system = 3  # Unix, whose permissions follow
            entry.external_attr = (0o100755 if path.endswith(".so") else 0o100644) << 16
            archive.writestr(entry, data)
    os.replace(part, os.path.join(out, name))
    return name


def get_requires_for_build_wheel(config_settings: object = None) -> List[str]:
    return []


def build_wheel(wheel_directory: str, config_settings: object = None, metadata_directory: object = None) -> str:
    """Called by pip: builds kiln by CMake and puts the wheel into a folder."""
    root = os.path.dirname(HERE)
    build = os.path.join(root, "build", "wheel")
    off = ["-DKILN_%s=OFF" % part for part in ("TESTS", "GOLDEN", "BENCH", "EXAMPLES", "CLI", "VIEWER")]
    subprocess.check_call(["cmake", "-S", root, "-B", build, "-DCMAKE_BUILD_TYPE=Release", "-DKILN_PYTHON=ON"] + off)
    subprocess.check_call(["cmake", "--build", build, "--target", "kiln_wheel", "--parallel", str(os.cpu_count() or 1)])
    with open(os.path.join(build, "python", "wheel.txt"), encoding="utf-8") as file:
        name = file.read().strip()
    shutil.copy(os.path.join(build, "python", name), wheel_directory)
    return name


def main(arguments: List[str]) -> None:
    parser = argparse.ArgumentParser(description="Makes kiln's wheel.")
    parser.add_argument("package", help="the folder kiln of a build")
    parser.add_argument("out", help="the folder for the wheel")
    parser.add_argument("--licence", action="append", default=[], help="NAME=FILE")
    given = parser.parse_args(arguments)
    name = write(given.package, given.out, dict(text.split("=", 1) for text in given.licence))
    with open(os.path.join(given.out, "wheel.txt"), "w", encoding="utf-8") as file:
        file.write(name + "\n")


if __name__ == "__main__":
    main(sys.argv[1:])
