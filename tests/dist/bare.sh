#!/bin/sh
# What is handed out does README's first bake, and others, in a place that has nothing else, with the same bytes as
# the command of this build.
#   bare.sh SOURCE KILN WORK SYSTEM
# SYSTEM is one of
#   linux     the program for x86-64 as the only file of a file system (chroot);
#   aarch64   the program for ARM by QEMU, in an empty folder, without any file of an ARM system;
#   windows   the program for Windows by Wine, in an empty folder;
#   wheel     the Python wheel, unpacked in an empty folder;
#   deb       the Debian package on a bare Debian by debootstrap, which only root can make.
set -eu
source=$1
kiln=$2
system=$4
dist=$source/build/dist
die() { echo "FAILED: $*"; exit 1; }
fail() { die "$@"; }

if [ "$system" = deb ]; then
    # In namespaces, so that nothing stays mounted and no process is left. Afterwards the root can be removed.
    [ "$(id -u)" = 0 ] || die "only root can make a bare Debian: sudo -E ./do test-dist"
    trap 'rm -rf --one-file-system "$3/deb"' EXIT
    trap 'exit 130' INT TERM HUP
    unshare --mount --propagation private --pid --fork --kill-child sh "$0" "$1" "$2" "$3/deb" deb-inside
    exit
fi
mkdir -p "$3"
build=$(cd "$3" && pwd)
work=$(mktemp -d "$build/bare.XXXXXX")
[ "$system" = deb-inside ] || trap 'rm -rf --one-file-system "$work"' EXIT
trap 'exit 130' INT TERM HUP

# The bakes: README's first one, then each format that a library is linked for.
cat >"$work/commands" <<'COMMANDS'
sky -q -o sky.exr --elevation 12
bake -q sky.exr --for three -o three.ktx2
bake -q sky.exr -o packed.ktx2 --size 64 --zstd
bake -q packed.ktx2 -o unpacked.ktx2 --size 16
bake -q sky.exr -o picture.png --shape panorama --size 64 --levels 1 --exposure -6
bake -q picture.png -o png.ktx2 --size 16
bake -q photo.jpg -o jpeg.ktx2 --size 32
COMMANDS
[ "$system" != aarch64 ] || sed -i 's/--for three/& --size 32 --tune none/' "$work/commands" # QEMU is slow
oiiotool "$source/docs/images/balls.png" --ch R,G,B --resize 256x128 -o "$work/photo.jpg" >/dev/null

# bakes FOLDER PROGRAM...: every command by the program, in the folder.
bakes() {
    folder=$1
    shift
    mkdir -p "$folder"
    cp "$work/photo.jpg" "$folder/"
    while read -r command; do
        # shellcheck disable=SC2086 # a command line
        (cd "$folder" && "$@" $command </dev/null) || die "$system: kiln $command"
    done <"$work/commands"
}

# same FOLDER: the files that all commands write are those of this build's command, and nothing of another name is left.
same() {
    for file in sky.exr three.ktx2 packed.ktx2 unpacked.ktx2 picture.png png.ktx2 jpeg.ktx2; do
        cmp "$work/native/$file" "$1/$file"
    done
    [ -z "$(find "$1" -name '*.tmp')" ] || die "$system: temporary files are left"
    echo "$system: the same bytes in seven files"
}
bakes "$work/native" "$kiln"
version=$("$kiln" --version | sed 's/^kiln //')

case $system in
linux)
    mkdir "$work/root"
    tar -x -z -f "$dist/kiln-$version-linux-x86_64.tar.gz" -C "$work/root" --strip-components=1
    rm "$work/root/LICENSES.txt"
    [ "$(ls "$work/root")" = kiln ]
    if [ "$(id -u)" = 0 ]; then
        bakes "$work/root" chroot "$work/root" /kiln
    else
        bakes "$work/root" unshare --map-root-user chroot "$work/root" /kiln
    fi
    same "$work/root"
    ;;
aarch64)
    mkdir "$work/arm"
    tar -x -z -f "$dist/kiln-$version-linux-aarch64.tar.gz" -C "$work/arm" --strip-components=1
    bakes "$work/arm" qemu-aarch64 -L "$work/none" ./kiln
    same "$work/arm"
    ;;
windows)
    mkdir "$work/windows"
    (cd "$work" && python3 -m zipfile -e "$dist/kiln-$version-windows-x86_64.zip" .)
    cp "$work/kiln-$version-windows-x86_64/kiln.exe" "$work/windows/"
    export WINEPREFIX="$work/wine" WINEDEBUG=-all LC_ALL=C.UTF-8
    trap '"$(command -v wineserver64 || command -v wineserver || echo /usr/lib/wine/wineserver64)" -k 2>/dev/null || true
        rm -rf --one-file-system "$work"' EXIT
    bakes "$work/windows" "$(command -v wine64 || echo /usr/lib/wine/wine64)" ./kiln.exe
    same "$work/windows"
    ;;
wheel)
    mkdir "$work/wheel"
    python=$(for each in /usr/bin/python3 python3; do "$each" -c 'import numpy' 2>/dev/null && echo "$each" && break; done)
    (cd "$work/wheel" && python3 -m zipfile -e "$dist"/kiln_ibl-*.whl .)
    (cd "$work/wheel" && cp "$work/photo.jpg" "$work/native/sky.exr" . && "$python" -I - <<'PYTHON'
import sys
sys.path.insert(0, ".")
import kiln
kiln.bake("sky.exr", "three").save("three.ktx2")
kiln.bake("sky.exr", size=64).save("packed.ktx2", zstd=3)
kiln.bake("packed.ktx2", size=16).save("unpacked.ktx2")
kiln.bake("photo.jpg", size=32).save("jpeg.ktx2")
PYTHON
    )
    for file in three.ktx2 packed.ktx2 unpacked.ktx2 jpeg.ktx2; do
        cmp "$work/native/$file" "$work/wheel/$file"
    done
    echo "wheel: the same bytes in four files"
    ;;
deb-inside)
    suite=$(. /etc/os-release && echo "$VERSION_CODENAME")
    place=$work/$suite
    cd "$source"
    # shellcheck source=scripts/bare.sh
    . scripts/bare.sh
    make_root
    mount_root
    cp "$dist/kiln_${version}_"*.deb "$place/root/"
    enter ". $host/environment && cd /root && ! command -v cc gcc && apt-get -q update &&
        DEBIAN_FRONTEND=noninteractive apt-get -q -y --no-install-recommends install ./kiln_*.deb" >"$work/log" 2>&1 ||
        { tail -n 40 "$work/log"; die "the package cannot be installed"; }
    mkdir "$place/root/bakes"
    bakes "$place/root/bakes" chroot "$place" sh -c 'cd /root/bakes && exec kiln "$@"' kiln
    same "$place/root/bakes"
    enter "apt-get -q -y purge kiln && ! command -v kiln" >"$work/log" 2>&1 ||
        { tail -n 40 "$work/log"; die "the package cannot be removed"; }
    ;;
*) die "'$system' is no system of this test" ;;
esac
