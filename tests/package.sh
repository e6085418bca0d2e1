#!/bin/sh
# Installs the project, then builds and runs examples/library against it.
# package.sh CMAKE SOURCE_DIR BINARY_DIR
set -eu
prefix=$3/package_test/prefix
build=$3/package_test/build
rm -rf "$3/package_test"
"$1" --install "$3" --prefix "$prefix" > /dev/null
"$1" -S "$2/examples/library" -B "$build" -G Ninja -DCMAKE_PREFIX_PATH="$prefix" > /dev/null
"$1" --build "$build"
"$build/fit_gold" "$build/gold.safetensors"
"$prefix/bin/pbnbrdf" info "$build/gold.safetensors"
# The README shows this very program.
awk '/^```cpp/ {inside = 1; next} /^```/ {inside = 0} inside' "$2/README.md" > "$build/readme.cc"
diff "$build/readme.cc" "$2/examples/library/fit_gold.cc"
