#!/bin/sh
# Fails if a source file isn't as clang-format has it. format.sh SOURCE_DIR
cd "$1" || exit 1
command -v clang-format-14 > /dev/null || { echo "needs Debian's clang-format-14"; exit 77; }
find include src tests experiments examples -name '*.h' -o -name '*.cc' | xargs clang-format-14 --dry-run -Werror
