#!/bin/sh
# Runs each fuzz target on each of its formats: run.sh BUILD_FOLDER SECONDS JOBS
# What was found earlier is kept in BUILD_FOLDER/corpus and goes on from there. Prints a line for each format; fails
# if there are findings, which BUILD_FOLDER/findings has.
set -eu
build=$1 seconds=$2 jobs=$3
here=$(cd "$(dirname "$0")" && pwd)
mkdir -p "$build/findings"
rm -rf "$build/seeds"
"$build/bin/make_seeds" "$build/seeds" "$here/../../problems"
(cd "$build/seeds" && find . -mindepth 2 -maxdepth 2 -type d) | sed 's|^\./||' | sort |
  xargs -P "$jobs" -I '{}' sh "$here/run_one.sh" "$build" "$seconds" '{}'
