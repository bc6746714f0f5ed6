#!/bin/sh
# Makes the documentation as static web pages: the pages of docs/ and an API reference of the public headers.
#   packaging/docs/make.sh FOLDER
# FOLDER/index.html is README.md, FOLDER/api/files.html the reference. Any web server can serve the folder, and a
# browser shows it from the disk, too. A warning of Doxygen is an error.
set -eu
[ $# = 1 ] || { echo "make.sh FOLDER" >&2; exit 2; }
mkdir -p "$1"
out=$(cd "$1" && pwd)
cd "$(dirname "$0")/../.."

version=$(sed -n 's/^project(kiln VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt)
styles=packaging/docs/api.css
case $(doxygen --version) in
1.[0-8].* | 1.9.[0-4] | 1.9.[0-4]\ *) styles="$styles packaging/docs/api-dark.css" ;;
esac
{
    cat packaging/docs/Doxyfile
    echo "OUTPUT_DIRECTORY = \"$out\""
    echo "PROJECT_NUMBER = $version"
    echo "HTML_EXTRA_STYLESHEET = $styles"
} | doxygen -
python3 packaging/docs/pages.py . "$out"
