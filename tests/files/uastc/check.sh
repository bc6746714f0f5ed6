#!/bin/sh
# Writes UASTC HDR blocks and compares how others decode them: check.sh UASTC_WRITE TRANSCODER FOLDER
set -eu
if ! command -v node >/dev/null || [ ! -f "$2/basis_transcoder.js" ]; then
    echo "node or the transcoder of npm three is missing; ./do test installs them" >&2
    exit 1
fi
mkdir -p "$3"
"$1" "$3"
node "$(dirname "$0")/check.mjs" "$2" "$3"
