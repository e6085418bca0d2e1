#!/bin/sh
# Installs the project, then builds and runs examples/library against it, without what the core doesn't need.
# package.sh CMAKE SOURCE_DIR BINARY_DIR
set -eu
prefix=$3/package_test/prefix
build=$3/package_test/build
rm -rf "$3/package_test"
"$1" --install "$3" --prefix "$prefix" > /dev/null
"$1" -S "$2/examples/library" -B "$build" -G Ninja -DCMAKE_PREFIX_PATH="$prefix" \
  -DCMAKE_DISABLE_FIND_PACKAGE_OpenEXR=ON -DCMAKE_DISABLE_FIND_PACKAGE_PNG=ON \
  -DCMAKE_DISABLE_FIND_PACKAGE_embree=ON -DCMAKE_DISABLE_FIND_PACKAGE_PkgConfig=ON \
  -DCMAKE_DISABLE_FIND_PACKAGE_nlohmann_json=ON > /dev/null
"$1" --build "$build"
"$build/fit_gold" "$build/gold.safetensors"
"$prefix/bin/pbnbrdf" info "$build/gold.safetensors"
# The same by pkg-config.
# shellcheck disable=SC2046
c++ -o "$build/by_pkg_config" "$2/examples/library/fit_gold.cc" \
  $(PKG_CONFIG_PATH=$(dirname "$(find "$prefix" -name pbnbrdf.pc)") pkg-config --cflags --libs pbnbrdf)
"$build/by_pkg_config" "$build/gold.safetensors"
# What the program says of itself, where man and bash look for it.
gzip -cd "$prefix/share/man/man1/pbnbrdf.1.gz" | grep -q '^\.SS fit$'
bash -c 'source "$1"; COMP_WORDS=(pbnbrdf exp); COMP_CWORD=1; _pbnbrdf; [ "${COMPREPLY[*]}" = export ]' - \
  "$prefix/share/bash-completion/completions/pbnbrdf"
# docs/library.md shows this very program.
awk '/^```cpp/ {inside = 1; next} /^```/ {inside = 0} inside' "$2/docs/library.md" > "$build/readme.cc"
diff "$build/readme.cc" "$2/examples/library/fit_gold.cc"
# Every public header stands alone, but the expressions that others include in their own namespaces.
for header in $(cd "$prefix/include" && find pbnbrdf -name '*.h' ! -name '*-inl.h' | sort); do
  echo "#include <$header>"
  echo "#include <$header>" > "$build/header.cc"
  c++ -std=c++20 -fsyntax-only -I"$prefix/include" -isystem /usr/include/eigen3 "$build/header.cc"
done
