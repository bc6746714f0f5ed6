#!/bin/sh
# ./do dist makes the same bytes again: from a clone in a folder with another path, of files with other dates and
# permissions, in another time zone and locale. Needs build/dist of the same commit.
#   twice.sh SOURCE
set -eu
source=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
clone=$work/a-much-longer-path/of-another-name

printf '[safe]\n\tdirectory = *\n' >"$work/gitconfig"
(umask 077 && GIT_CONFIG_GLOBAL=$work/gitconfig git clone -q "$source" "$clone")
# A path that the compilers' settings cannot hold is refused.
mkdir "$work/a space"
cp -R "$clone/packaging" "$work/a space/"
if "$work/a space/packaging/dist.sh" >"$work/log" 2>&1; then exit 1; fi
grep -q "a space' has a character" "$work/log" || { cat "$work/log"; exit 1; }
[ "$(git -C "$clone" rev-parse HEAD)" = "$(git -C "$source" rev-parse HEAD)" ]
find "$clone" -exec touch -h -d 2001-02-03 {} +
mkdir "$clone/build"
cp -R "$source/build/sources" "$clone/build/" # downloaded already
(cd "$clone" && umask 077 && TZ=Asia/Tokyo LC_ALL=C.UTF-8 packaging/dist.sh) >"$work/log" 2>&1 ||
    { tail -n 60 "$work/log"; exit 1; }
diff "$source/build/dist/SHA256SUMS" "$clone/build/dist/SHA256SUMS"
echo "twice the same $(wc -l <"$clone/build/dist/SHA256SUMS") files"
