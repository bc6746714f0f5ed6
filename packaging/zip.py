"""Makes a zip file of a folder whose bytes follow from the files alone: sorted, with one date.

zip.py FOLDER OUT SECONDS: the names in OUT begin with the folder's name, and SECONDS since 1970 is the files' date.
SPDX-License-Identifier: MIT
"""
import os
import sys
import time
import zipfile

folder, out, seconds = sys.argv[1:]
date = time.gmtime(int(seconds))[:6]
paths = sorted(os.path.join(place, name) for place, _, names in os.walk(folder) for name in names)
with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
    for path in paths:
        entry = zipfile.ZipInfo(os.path.relpath(path, os.path.dirname(os.path.abspath(folder))), date)
        entry.compress_type = zipfile.ZIP_DEFLATED
        entry.create_system = 3  # Unix, whose permissions follow
        entry.external_attr = (0o100755 if os.access(path, os.X_OK) else 0o100644) << 16
        with open(path, "rb") as file:
            archive.writestr(entry, file.read())
