#!/bin/sh
# Names and texts of hostile files: nothing that a terminal obeys and nothing that is not UTF-8 is printed, on
# either stream, and JSON names files by escapes.
# shellcheck source=lib.sh
. "$(dirname "$0")/lib.sh"

# clean FILE: only tabs, line ends, and shown characters of UTF-8.
clean() {
    checks=$((checks + 1))
    LC_ALL=C tr -d '\11\12\40-\176\200-\377' <"$1" >log/controls
    [ ! -s log/controls ] || die "$1 holds controls: $(od -c log/controls | head -n 3)"
    iconv -f UTF-8 -t UTF-8 <"$1" >log/utf8 2>log/iconv || die "$1 is not UTF-8"
    # U+0080 to U+009F, and marks that turn the direction of text.
    ! LC_ALL=C grep -q "$(printf '\302[\200-\237]')" "$1" || die "$1 holds controls of ISO 6429"
    ! LC_ALL=C grep -q "$(printf '\342\200[\216\217\250-\256]')" "$1" || die "$1 turns text around"
}
# both CODE PATTERN kiln-arguments...: expect, and what it printed is clean.
both() {
    expect "$@"
    clean log/out
    clean log/err
}

escape=$(printf 'a\033[31m\n\302\233b\377\342\200\256\177')
both 0 "" sky -o "$escape.exr" --size 16
grep -q '^a?\[31m??b???.exr: panorama of 32 x 16' log/out || die "another name"
both 0 "" info "$escape.exr"
grep -qx 'a?\[31m??b???.exr' log/out || die "another name"
both 0 "" info --json "$escape.exr"
grep -qF 'a\u001b[31m\n\u009bb'"$(printf '\357\277\275')"'\u202e\u007f.exr' log/out || die "JSON names another file"
both 1 '^kiln: a?\[31m??b???.png: cannot be opened' info "$escape.png"
both 1 '^kiln: a?\[31m??b???.png: ' bake "$escape.png" -o out.ktx2
both 2 'a?\[31m??b???.xyz' bake "$escape.exr" -o "$escape.xyz"
both 0 "" bake "$escape.exr" -o "$escape.ktx2" --size 8 --exposure -8
both 0 "" bake "$escape.exr" -o "$escape.ktx2" --size 8 --exposure -8 --json
both 2 "a?\[31m??b???" "$escape"
both 2 "a?\[31m??b???" bake in.exr -o out.ktx2 --lobe "$escape"
both 2 "a?\[31m??b???" bake in.exr -o out.ktx2 "--$escape"

# The name of the writer inside files, by bytes of the same number.
"$KILN" sky -o plain.exr --size 16 -q
"$KILN" bake plain.exr -o cube.ktx2 --size 8 --exposure -8 -q
hostile=$(printf '\033]0;\377\302\233\r\bx') # ten bytes, as many as "kiln 0.2.0" has
for file in plain.exr cube.ktx2; do
    LC_ALL=C grep -q 'kiln 0\.[0-9.]*' $file || die "$file does not name its writer"
    LC_ALL=C sed "s/kiln 0\.[0-9]\.[0-9]/$hostile/g" $file >changed
    ! cmp -s $file changed || die "$file was not changed"
    both 0 "" info changed
    ! grep -q ']0;' log/out || die "$file: a name that is not plain text is shown"
    both 0 "" info --json changed
    clean log/out
done
# Radiance's lines of text, and names of EXR's attributes and channels.
printf '#?RADIANCE\n# \033[2J\377\nSOFTWARE=\033]0;x\a\nFORMAT=\033[31m\n\n-Y 1 +X 2\n12345678' >bad.hdr
both 1 "bad.hdr" info bad.hdr
printf '#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X \033[31m\n12345678' >bad.hdr
both 1 "bad.hdr" info bad.hdr
for word in channels compression dataWindow; do
    LC_ALL=C sed "s/$word/$(printf '\033[2J')/" plain.exr >bad.exr
    both 1 "bad.exr" info bad.exr
    both 1 "bad.exr" bake bad.exr -o out.ktx2
done
passed
