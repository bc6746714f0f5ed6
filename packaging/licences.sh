#!/bin/sh
# Prints kiln's licence and the licences of what is linked into a program.
#   packaging/licences.sh SOURCES PART...
# SOURCES is the folder that packaging/sources.sh fills. A PART is NAME=SOURCE, the name of a library and its folder
# in SOURCES, or NAME:FILE, the name of a library and a file of it: then the text is the copyright file of the Debian
# package that has the file.
set -eu
sources=$1
shift
cd "$(dirname "$0")/.."

# part NAME VERSION COPYRIGHT
part() {
    [ -s "$3" ] || { echo "licences: $1 has no $3" >&2; exit 1; }
    printf '\n%s\n%s, Debian version %s\n%s\n\n' "$line" "$1" "$2" "$line"
    cat "$3"
}

line=$(printf '%079d' 0 | tr 0 =)
echo "This program is kiln, and the libraries that are named below are linked into it. The licence of kiln comes"
echo "first. The licence of each library is the text that Debian ships with the library."
printf '\n%s\nkiln\n%s\n\n' "$line" "$line"
cat LICENSE
for each; do
    case $each in
    *=*)
        from=$sources/${each#*=}
        part "${each%%=*}" "$(sed -n '1s/.*(\([^)]*\)).*/\1/p' "$from/debian/changelog")" "$from/debian/copyright"
        ;;
    *:*)
        package=$(dpkg-query -S "$(readlink -f "${each#*:}")" | sed -n '1s/:.*//p')
        # shellcheck disable=SC2016 # the format is dpkg-query's
        version=$(dpkg-query -W -f '${Version}\n' "$package" | head -n 1)
        part "${each%%:*}" "$version" "/usr/share/doc/$package/copyright"
        ;;
    esac
done
