"""The wheel: made twice it is the same bytes, its list of files is true, it loads on systems as old as its name says
and on musl, and the programs of both README.md and docs/python.md run with what it installs.

wheel.py ROOT BUILD: ROOT is the source folder, BUILD the folder of the wheel (BUILD/python of a build tree).
"""
import base64
import hashlib
import os
import re
import shutil
import subprocess
import sys
import tempfile
import zipfile

ROOT, BUILD = (os.path.abspath(path) for path in sys.argv[1:])
sys.path.insert(0, os.path.join(ROOT, "python"))

import build_kiln  # noqa: E402

with open(os.path.join(BUILD, "wheel.txt")) as file:
    NAME = file.read().strip()
WHEEL = os.path.join(BUILD, NAME)


def reproduced(work: str) -> None:
    """From a copy with other dates and permissions, in another order of the folder, at another path."""
    copy = os.path.join(work, "copy")
    os.makedirs(copy)
    licences = {}
    with zipfile.ZipFile(WHEEL) as archive:
        names = archive.namelist()
        for name in names:
            match = re.search(r"licenses/(\w+)\.txt$", name)
            if match:
                licences[match.group(1)] = archive.extract(name, os.path.join(work, "licences"))
    assert set(licences) >= {"kiln"}, licences
    package = os.path.join(BUILD, "kiln")
    for name in reversed(sorted(os.listdir(package))):
        if os.path.isfile(os.path.join(package, name)):
            path = shutil.copyfile(os.path.join(package, name), os.path.join(copy, name))
            os.utime(path, (1e9, 1e9))
            os.chmod(path, 0o600)
    assert build_kiln.write(copy, os.path.join(work, "again"), dict(reversed(list(licences.items())))) == NAME
    with open(WHEEL, "rb") as a, open(os.path.join(work, "again", NAME), "rb") as b:
        assert a.read() == b.read(), "the wheel made again differs"


def listed() -> None:
    """RECORD names every file with its hash and size."""
    with zipfile.ZipFile(WHEEL) as archive:
        record, = (name for name in archive.namelist() if name.endswith("/RECORD"))
        rows = [line.split(",") for line in archive.read(record).decode().splitlines()]
        assert sorted(row[0] for row in rows) == sorted(archive.namelist())
        for name, digest, size in rows:
            data = archive.read(name)
            wanted = "sha256=" + base64.urlsafe_b64encode(hashlib.sha256(data).digest()).decode().rstrip("=")
            assert name == record or (digest, size) == (wanted, str(len(data))), name
        tags = re.findall("^Tag: (.*)$", archive.read(record.replace("RECORD", "WHEEL")).decode(), re.M)
        expanded = ["py3-none-" + part for part in NAME[:-len(".whl")].split("-")[-1].split(".")]
        assert tags == expanded, tags


def old_systems(library: str) -> None:
    """What readelf prints is what build_kiln reads, and is old enough for the wheel's name."""
    elf = build_kiln.read_elf(library)
    dynamic = subprocess.check_output(["readelf", "-dW", library], text=True)
    assert elf.needed == set(re.findall(r"NEEDED.*\[(.*)\]", dynamic)), elf.needed
    symbols = subprocess.check_output(["readelf", "--dyn-syms", "-W", library], text=True)
    versions = set(re.findall(r" UND .*@(GLIBC_[\d.]+)", symbols))
    assert versions and versions <= elf.versions, versions
    newest = max(tuple(map(int, v[len("GLIBC_"):].split("."))) for v in versions)
    match = re.search(r"manylinux_(\d+)_(\d+)_", NAME)
    assert match, "%s is for this system only: %s" % (NAME, elf.needed)
    # The wheel promises to run with glibc 2.17, of the year 2012. If this fails, the library calls a function of a
    # newer glibc; python/portable.c must then define that function by older ones.
    assert newest <= (2, 17) and (int(match.group(1)), int(match.group(2))) == (2, 17), versions
    assert elf.needed == {"libc.so.6", "libm.so.6"}, elf.needed
    shown = set(re.findall(r" (?:FUNC|OBJECT) +GLOBAL +DEFAULT +\d+ (\w+)$", symbols, re.M))
    assert shown and all(name.startswith("kiln_") for name in shown), shown


def names_of_systems() -> None:
    """Libraries and versions decide the name."""
    def name(needed: set, versions: set) -> list:
        return build_kiln.platforms(build_kiln.Elf("x86_64", needed, versions))

    c = {"libc.so.6"}
    assert name(c, {"GLIBC_2.3.4", "GLIBC_2.14"}) == ["manylinux_2_17_x86_64", "musllinux_1_2_x86_64"]
    assert name(c, {"GLIBC_2.34", "GLIBC_2.4"})[0] == "manylinux_2_34_x86_64"
    assert name(c | {"libzstd.so.1"}, {"GLIBC_2.4"}) == ["linux_x86_64"]


def musl(work: str, library: str) -> None:
    program = os.path.join(work, "musl")
    subprocess.check_call(["musl-gcc", "-std=gnu17", "-I", os.path.join(ROOT, "include"),
                           os.path.join(ROOT, "tests/python/musl.c"), "-o", program])
    said = subprocess.check_output([program, library], text=True)
    assert said == "%s 1.0000\n" % NAME.split("-")[1], said


PROGRAM = """
import sys, types, warnings
sys.path.insert(0, sys.argv[1])
import kiln, numpy as np
bake = kiln.bake
def small(*given, **options):  # the same with 16 texels, for time
    if len(given) < 3:
        options.setdefault("size", 16)
    return bake(*given, **options)
kiln.bake = small
with warnings.catch_warnings():
    warnings.simplefilter("error")
    scope = {}
    for at, block in enumerate(sys.argv[2:]):
        exec(compile(block, "block %d" % at, "exec"), scope)
"""


def documents(work: str, installed: str) -> int:
    """Every ```python of the documents runs, with a small panorama as city.exr."""
    sys.path.insert(0, installed)
    import kiln

    here = os.path.join(work, "here")
    os.makedirs(here)
    sky = kiln.sky(32, elevation=40)
    sky.save(os.path.join(here, "city.exr"))
    sky.save(os.path.join(here, "city.hdr"))
    count = 0
    for name in ("README.md", "python/README.md", "docs/python.md"):
        with open(os.path.join(ROOT, name), encoding="utf-8") as file:
            blocks = re.findall(r"^```python\n(.*?)^```", file.read(), re.M | re.S)
        assert blocks, name
        subprocess.check_call([sys.executable, "-I", "-c", PROGRAM, installed, *blocks], cwd=here)
        count += len(blocks)
    example = os.path.join(ROOT, "python", "example.py")
    subprocess.check_call([sys.executable, "-W", "error", example, "city.exr", "pictures"], cwd=here,
                          env=dict(os.environ, PYTHONPATH=installed), stdout=subprocess.DEVNULL)
    sizes = {"panorama": (256, 128), "levels": (256, 512), "ball": (256, 256), "split-sum": (256, 256)}
    for name, size in sizes.items():
        picture = kiln.describe(os.path.join(here, "pictures", name + ".png"))
        assert (picture.width, picture.height) == size, name
    specular = kiln.describe(os.path.join(here, "pictures", "sky_specular.ktx2"))
    assert (specular.layout, specular.width) == ("cube", 128), specular
    return count + 1


with tempfile.TemporaryDirectory() as work:
    installed = os.path.join(work, "installed")
    with zipfile.ZipFile(WHEEL) as archive:
        archive.extractall(installed)
    library = os.path.join(installed, "kiln", "libkiln.so")
    reproduced(work)
    listed()
    names_of_systems()
    old_systems(library)
    musl(work, library)
    print("%s, %d pieces of Python" % (NAME, documents(work, installed)))
