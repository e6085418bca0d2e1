#!/bin/sh
# run.sh PYTHON TEST.py PROGRAM FOLDER: an interop test, skipped (77) where ./do peers hasn't been.
if [ ! -x "$1" ]; then
  echo "skipped: needs $1, which ./do peers makes"
  exit 77
fi
python=$1
shift
exec "$python" -B "$@"
