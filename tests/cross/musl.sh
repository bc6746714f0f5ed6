#!/bin/sh
# The command is one file that needs no other: nothing is loaded with it.
#   musl.sh BUILD_FOLDER
set -eu
kiln=$1/bin/kiln
! ldd "$kiln" >/dev/null 2>&1 || { echo "$kiln needs:"; ldd "$kiln"; exit 1; }
"$kiln" --version
